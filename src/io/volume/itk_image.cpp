// SPDX-License-Identifier: MIT
#include "io/volume/itk_image.h"

#include "io/errors.h"

#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

namespace voxtact::io {

ImageIo makeImageIo(VolumeFormat format) {
    switch (format) {
    case VolumeFormat::Nifti:
        return itk::NiftiImageIO::New().GetPointer();
    case VolumeFormat::Nrrd:
        return itk::NrrdImageIO::New().GetPointer();
    case VolumeFormat::Meta:
        break;
    }
    return itk::MetaImageIO::New().GetPointer();
}

std::string itkReason(const itk::ExceptionObject& problem) {
    // "ITK ERROR: NiftiImageIO(0x55...): what it means"
    const std::string text = oneLine(problem.GetDescription());
    const std::size_t address = text.find("(0x");
    const std::size_t end = address == std::string::npos ? address : text.find("): ", address);
    return end == std::string::npos ? text : text.substr(end + 3);
}

Result<ItkImage> readInformation(itk::ImageIOBase& io, const std::filesystem::path& path) {
    if (!io.CanReadFile(path.c_str())) {
        return cannotRead(path, "ITK does not take it for an image of this format; is its ending right?");
    }
    io.SetFileName(path.string());
    io.ReadImageInformation();
    if (io.GetNumberOfComponents() != 1 || io.GetPixelType() != itk::IOPixelEnum::SCALAR) {
        return cannotRead(path, "its voxels are not single numbers (" +
                                    itk::ImageIOBase::GetPixelTypeAsString(io.GetPixelType()) + ", " +
                                    std::to_string(io.GetNumberOfComponents()) +
                                    " components); convert it to integers or floats");
    }
    const unsigned dimensions = io.GetNumberOfDimensions();
    std::vector<std::int64_t> sizes;
    itk::ImageIORegion region(dimensions);
    for (unsigned axis = 0; axis < dimensions; ++axis) {
        sizes.push_back(static_cast<std::int64_t>(io.GetDimensions(axis)));
        region.SetIndex(axis, 0);
        region.SetSize(axis, io.GetDimensions(axis));
    }
    if (const Result<std::uint64_t> bytes = imageBytes(path, sizes, io.GetComponentSize()); !bytes.ok()) {
        return bytes.error();
    }
    io.SetIORegion(region);
    ItkImage image;
    image.component = io.GetComponentType();
    for (unsigned axis = 0; axis < 3; ++axis) {
        image.grid.size[axis] = static_cast<std::uint32_t>(io.GetDimensions(axis));
        image.grid.spacing[axis] = io.GetSpacing(axis);
        image.grid.origin[axis] = io.GetOrigin(axis);
        const std::vector<double> direction = io.GetDirection(axis);
        for (unsigned row = 0; row < 3; ++row) {
            image.grid.direction[3 * axis + row] = direction[row];
        }
    }
    if (const Result<void> grid = checkGrid(image.grid); !grid.ok()) {
        return cannotRead(path, grid.error().text);
    }
    return image;
}

void readVoxels(itk::ImageIOBase& io, std::vector<std::byte>& voxels) {
    const std::size_t begin = voxels.size();
    voxels.resize(begin + static_cast<std::size_t>(io.GetImageSizeInBytes()));
    io.Read(voxels.data() + begin);
}

Result<VolumeData> toScalars(ItkImage image, const std::filesystem::path& path) {
    using itk::IOComponentEnum;
    const auto stored = [&](StoredType type) {
        return toScalars(StoredImage{image.grid, type, std::nullopt, std::move(image.voxels)}, path);
    };
    switch (image.component) {
    case IOComponentEnum::CHAR:
        return stored(StoredType::Int8);
    case IOComponentEnum::UCHAR:
        return stored(StoredType::UInt8);
    case IOComponentEnum::SHORT:
        return stored(StoredType::Int16);
    case IOComponentEnum::USHORT:
        return stored(StoredType::UInt16);
    case IOComponentEnum::INT:
        return stored(StoredType::Int32);
    case IOComponentEnum::UINT:
        return stored(StoredType::UInt32);
    case IOComponentEnum::LONG:
    case IOComponentEnum::LONGLONG:
        return stored(StoredType::Int64);
    case IOComponentEnum::ULONG:
    case IOComponentEnum::ULONGLONG:
        return stored(StoredType::UInt64);
    case IOComponentEnum::FLOAT:
        return stored(StoredType::Float32);
    case IOComponentEnum::DOUBLE:
        return stored(StoredType::Float64);
    default:
        break;
    }
    return cannotRead(path, "its voxels are of a type that is not supported; convert it to integers or floats");
}

} // namespace voxtact::io
