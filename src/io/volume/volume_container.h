// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/result.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace voxtact::io {

enum class VolumeFormat { Nifti, Nrrd, Meta };

/// By the ending of the name, in any case.
[[nodiscard]] std::optional<VolumeFormat> volumeFormat(const std::filesystem::path& path);

struct ContainerFacts {
    VolumeFormat format = VolumeFormat::Nifti;
    std::filesystem::path header; ///< what ITK is given
    std::vector<std::string> notes;
};

/// Reads the header without ITK and refuses what ITK would read in silence or crash on: files that end before their
/// last voxel (ITK fills the rest with zeros or leaves it undefined), damaged compressed data, more than one image,
/// and sizes that are not positive.
[[nodiscard]] Result<ContainerFacts> checkContainer(const std::filesystem::path& path);

[[nodiscard]] Result<ContainerFacts> checkNifti(const std::filesystem::path& path);
[[nodiscard]] Result<ContainerFacts> checkNrrd(const std::filesystem::path& path);
[[nodiscard]] Result<ContainerFacts> checkMeta(const std::filesystem::path& path);

/// Bytes of an image with these sizes; refuses 2D, more than one image, and no voxel.
[[nodiscard]] Result<std::uint64_t> imageBytes(const std::filesystem::path& path, std::span<const std::int64_t> sizes,
                                               std::uint64_t bytesPerVoxel);
/// Refuses a file in which fewer than `needed` bytes are left for the voxels.
[[nodiscard]] Result<void> checkLength(const std::filesystem::path& path, std::uint64_t needed, std::uint64_t present);

} // namespace voxtact::io
