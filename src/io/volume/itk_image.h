// SPDX-License-Identifier: MIT
#pragma once

#include "io/volume/volume_container.h"
#include "voxtact/data.h"

#include <itkImageIOBase.h>

#include <filesystem>
#include <string>
#include <vector>

namespace voxtact::io {

using ImageIo = itk::ImageIOBase::Pointer;

/// A new reader and writer.
[[nodiscard]] ImageIo makeImageIo(VolumeFormat format);

/// What ITK's exceptions say, without its source files and addresses.
[[nodiscard]] std::string itkReason(const itk::ExceptionObject& problem);

/// An image as ITK delivers it.
struct ItkImage {
    Grid grid;
    itk::IOComponentEnum component = itk::IOComponentEnum::UNKNOWNCOMPONENTTYPE;
    std::vector<std::byte> voxels;
};

/// Asks ITK for the geometry; refuses what is not one 3D image of scalars.
[[nodiscard]] Result<ItkImage> readInformation(itk::ImageIOBase& io, const std::filesystem::path& path);
/// Appends the voxels of the image that `readInformation` was called for.
void readVoxels(itk::ImageIOBase& io, std::vector<std::byte>& voxels);

} // namespace voxtact::io
