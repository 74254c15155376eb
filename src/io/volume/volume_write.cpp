// SPDX-License-Identifier: MIT
#include "core/guard.h"
#include "io/errors.h"
#include "io/volume/itk_image.h"
#include "io/volume/itk_session.h"
#include "io/volume/volume_container.h"
#include "voxtact/io.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <fstream>
#include <system_error>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

itk::IOComponentEnum componentOf(ScalarType type) {
    switch (type) {
    case ScalarType::UInt8:
        return itk::IOComponentEnum::UCHAR;
    case ScalarType::Int16:
        return itk::IOComponentEnum::SHORT;
    case ScalarType::UInt16:
        return itk::IOComponentEnum::USHORT;
    case ScalarType::Float32:
        break;
    }
    return itk::IOComponentEnum::FLOAT;
}

void writeImage(itk::ImageIOBase& io, const fs::path& path, const VolumeView& volume) {
    io.SetFileName(path.string());
    io.SetNumberOfDimensions(3);
    itk::ImageIORegion region(3);
    for (unsigned axis = 0; axis < 3; ++axis) {
        io.SetDimensions(axis, volume.grid.size[axis]);
        io.SetSpacing(axis, volume.grid.spacing[axis]);
        io.SetOrigin(axis, volume.grid.origin[axis]);
        const double* column = volume.grid.direction.data() + std::size_t{3} * axis;
        io.SetDirection(axis, std::vector<double>(column, column + 3));
        region.SetIndex(axis, 0);
        region.SetSize(axis, volume.grid.size[axis]);
    }
    io.SetIORegion(region);
    io.SetPixelType(itk::IOPixelEnum::SCALAR);
    io.SetNumberOfComponents(1);
    io.SetComponentType(componentOf(volume.type));
    io.Write(volume.voxels.data());
}

/// Why the file system takes no more; empty where it does.
std::string whyNotMore(const fs::path& file) {
    // More than a disk keeps back for rounding.
    const std::vector<char> some(std::size_t{1} << 20U);
    errno = 0;
    std::ofstream stream(file, std::ios::binary | std::ios::app);
    stream.write(some.data(), static_cast<std::streamsize>(some.size()));
    stream.close();
    return !stream && errno != 0 ? std::generic_category().message(errno) : "";
}

/// ITK does not say when a write fails: on a full disk there would be half a file.
Result<void> checkVoxels(const fs::path& temporary, const fs::path& path, VolumeFormat format,
                         const VolumeView& volume) {
    std::vector<std::byte> voxels;
    try {
        const ImageIo io = makeImageIo(format);
        if (readInformation(*io, temporary).ok()) {
            readVoxels(*io, voxels);
        }
    } catch (const itk::ExceptionObject&) {
        voxels.clear();
    }
    if (std::ranges::equal(voxels, volume.voxels)) {
        return {};
    }
    const std::string full = whyNotMore(temporary);
    return cannotWrite(path, full.empty() ? "what was written is not in the file" : full);
}

/// NIfTI holds single precision, and only directions at right angles; ITK squares others without a word.
Result<void> checkPlace(const fs::path& temporary, const fs::path& path, VolumeFormat format, const Grid& grid) {
    const ImageIo io = makeImageIo(format);
    const Result<ItkImage> written = readInformation(*io, temporary);
    constexpr double kShare = 0.01;
    const double tolerance = kShare * *std::min_element(grid.spacing.begin(), grid.spacing.end());
    if (!written.ok() || written->grid.size != grid.size || !(cornersApart(written->grid, grid) <= tolerance)) {
        return cannotWrite(path, "this format cannot hold the image's size, place or direction; write a .nrrd file",
                           ErrorCode::Format);
    }
    return {};
}

} // namespace

Result<void> writeVolume(const fs::path& path, const VolumeView& volume) {
    return guard([&]() -> Result<void> {
        const std::string ending = lowerEnding(path);
        if (ending != ".nii" && ending != ".nii.gz" && ending != ".nrrd" && ending != ".mha") {
            return cannotWrite(path, "the ending of a volume is .nii, .nii.gz, .nrrd or .mha",
                               ErrorCode::InvalidArgument);
        }
        if (const Result<ValueRange> range = checkVolume(volume); !range.ok()) {
            return cannotWrite(path, range.error().text, range.error().code);
        }
        const VolumeFormat format = volumeFormat(path).value_or(VolumeFormat::Nrrd);
        return writeFileAt(path, [&](const fs::path& temporary) -> Result<void> {
            const ItkSession session;
            try {
                writeImage(*makeImageIo(format), temporary, volume);
                Result<void> written = checkVoxels(temporary, path, format, volume);
                return written.ok() ? checkPlace(temporary, path, format, volume.grid) : written;
            } catch (const itk::ExceptionObject& problem) {
                const std::string full = whyNotMore(temporary);
                return cannotWrite(path, full.empty() ? itkReason(problem) : full);
            }
        });
    });
}

} // namespace voxtact::io
