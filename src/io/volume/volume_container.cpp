// SPDX-License-Identifier: MIT
#include "io/volume/volume_container.h"

#include "io/byte_source.h"
#include "io/errors.h"

namespace voxtact::io {

std::optional<VolumeFormat> volumeFormat(const std::filesystem::path& path) {
    const std::string ending = lowerEnding(path);
    for (const char* nifti : {".nii", ".nii.gz", ".hdr", ".hdr.gz", ".img", ".img.gz"}) {
        if (ending == nifti) {
            return VolumeFormat::Nifti;
        }
    }
    if (ending == ".nrrd" || ending == ".nhdr") {
        return VolumeFormat::Nrrd;
    }
    if (ending == ".mha" || ending == ".mhd") {
        return VolumeFormat::Meta;
    }
    return std::nullopt;
}

Result<ContainerFacts> checkContainer(const std::filesystem::path& path) {
    const Result<std::uint64_t> size = readableFile(path);
    if (!size.ok()) {
        return size.error();
    }
    if (*size == 0) {
        return cannotRead(path, "the file is empty");
    }
    const std::optional<VolumeFormat> format = volumeFormat(path);
    if (!format) {
        const Result<std::string> head = contentHead(path, 132);
        if (head.ok() && head->size() == 132 && head->substr(128) == "DICM") {
            return cannotRead(path, "it is one DICOM file; give the folder that holds the series");
        }
        return cannotRead(path,
                          "its ending is none of .nii, .nii.gz, .hdr, .img, .nrrd, .nhdr, .mha and .mhd; convert it");
    }
    switch (*format) {
    case VolumeFormat::Nifti:
        return checkNifti(path);
    case VolumeFormat::Nrrd:
        return checkNrrd(path);
    case VolumeFormat::Meta:
        break;
    }
    return checkMeta(path);
}

Result<std::uint64_t> imageBytes(const std::filesystem::path& path, std::span<const std::int64_t> sizes,
                                 std::uint64_t bytesPerVoxel) {
    // Far above what memory holds, and far below overflow.
    constexpr std::uint64_t kMost = std::uint64_t{1} << 50;
    if (sizes.size() < 3) {
        return cannotRead(path, "it is " + std::to_string(sizes.size()) + "D; a 3D image is needed");
    }
    std::uint64_t bytes = bytesPerVoxel;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        if (sizes[i] <= 0) {
            return cannotRead(path, "it has no voxels (its size along axis " + std::to_string(i) + " is " +
                                        std::to_string(sizes[i]) + ")");
        }
        if (i >= 3 && sizes[i] > 1) {
            return cannotRead(path, "it is " + std::to_string(i + 1) + "D and holds " + std::to_string(sizes[i]) +
                                        " images or components; extract one 3D image");
        }
        if (bytes > kMost / static_cast<std::uint64_t>(sizes[i])) {
            return cannotRead(path, "its header asks for more voxels than memory can hold");
        }
        bytes *= static_cast<std::uint64_t>(sizes[i]);
    }
    return bytes;
}

Result<void> checkLength(const std::filesystem::path& path, std::uint64_t needed, std::uint64_t present) {
    if (present < needed) {
        return cannotRead(path, "it is truncated: its voxels take " + std::to_string(needed) + " bytes, " +
                                    std::to_string(present) + " are there; get the file again");
    }
    return {};
}

} // namespace voxtact::io
