// SPDX-License-Identifier: MIT
#include "core/guard.h"
#include "io/errors.h"
#include "io/volume/dicom_folder.h"
#include "io/volume/itk_image.h"
#include "io/volume/itk_session.h"
#include "voxtact/io.h"

namespace voxtact::io {

namespace {

Result<ItkImage> readFile(const std::filesystem::path& path, std::vector<std::string>& notes) {
    const Result<ContainerFacts> container = checkContainer(path);
    if (!container.ok()) {
        return container.error();
    }
    notes = container->notes;
    const ItkSession session;
    const ImageIo io = makeImageIo(container->format);
    Result<ItkImage> image = readInformation(*io, container->header);
    if (image.ok()) {
        readVoxels(*io, image->voxels);
    }
    return image;
}

Result<ItkImage> fromStored(Result<StoredImage> stored) {
    if (!stored.ok()) {
        return stored.error();
    }
    ItkImage image;
    image.grid = stored->grid;
    image.voxels = std::move(stored->voxels);
    switch (stored->type) {
    case StoredType::UInt8:
        image.component = itk::IOComponentEnum::UCHAR;
        break;
    case StoredType::Int16:
        image.component = itk::IOComponentEnum::SHORT;
        break;
    case StoredType::UInt16:
        image.component = itk::IOComponentEnum::USHORT;
        break;
    case StoredType::Int32:
        image.component = itk::IOComponentEnum::INT;
        break;
    case StoredType::UInt32:
        image.component = itk::IOComponentEnum::UINT;
        break;
    default:
        image.component = itk::IOComponentEnum::FLOAT;
        break;
    }
    return image;
}

Result<ItkImage> readAny(const std::filesystem::path& path, std::vector<std::string>& notes) {
    std::error_code ignored;
    try {
        if (std::filesystem::is_directory(path, ignored)) {
            return fromStored(readDicomFolder(path, notes));
        }
        return readFile(path, notes);
    } catch (const itk::ExceptionObject& problem) {
        return cannotRead(path, itkReason(problem));
    }
}

std::string nameOf(const std::filesystem::path& path) {
    return path.has_filename() ? path.filename().string() : path.parent_path().filename().string();
}

} // namespace

Result<VolumeData> readVolume(const std::filesystem::path& path) {
    return guard([&]() -> Result<VolumeData> {
        std::vector<std::string> notes;
        Result<ItkImage> image = readAny(path, notes);
        if (!image.ok()) {
            return image.error();
        }
        Result<VolumeData> volume = toScalars(std::move(*image), path);
        if (!volume.ok()) {
            return volume;
        }
        if (const Result<ValueRange> range = checkVolume(volume->view()); !range.ok()) {
            return cannotRead(path, range.error().text);
        }
        volume->name = nameOf(path);
        volume->notes.insert(volume->notes.begin(), notes.begin(), notes.end());
        return volume;
    });
}

} // namespace voxtact::io
