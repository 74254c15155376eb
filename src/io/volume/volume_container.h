// SPDX-License-Identifier: MIT
#pragma once

#include "io/byte_reader.h"
#include "io/volume/stored_image.h"
#include "voxtact/io.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::io {

enum class VolumeFormat { Nifti, Nrrd, Meta };

/// Determines the format by the ending of the name, in any case.
[[nodiscard]] std::optional<VolumeFormat> volumeFormat(const std::filesystem::path& path);

/// Source of a volume's files: the disk, or one file in memory.
class VolumeSource {
  public:
    explicit VolumeSource(ReadProgress progress = {}) : progress_(std::move(progress)) {}
    VolumeSource(std::filesystem::path name, std::span<const std::byte> content)
        : name_(std::move(name)), content_(content) {}

    [[nodiscard]] bool has(const std::filesystem::path& path) const;
    /// Refuses an empty file.
    [[nodiscard]] Result<ByteReader> open(const std::filesystem::path& path) const;
    /// The file that a header names as its voxels'.
    [[nodiscard]] Result<ByteReader> openBeside(const std::filesystem::path& header, std::string_view name) const;

  private:
    ReadProgress progress_;
    std::filesystem::path name_;
    std::optional<std::span<const std::byte>> content_; ///< none: the disk
};

/// The stored voxels, the grid, and notes for the user.
struct ContainedImage {
    StoredImage image;
    std::vector<std::string> notes;
};

/// NIfTI, NRRD or MetaImage, by the ending.
[[nodiscard]] Result<ContainedImage> readContainer(const VolumeSource& source, const std::filesystem::path& path,
                                                   const VolumeReadOptions& options);
[[nodiscard]] Result<ContainedImage> readNifti(const VolumeSource& source, const std::filesystem::path& path,
                                               const VolumeReadOptions& options);
[[nodiscard]] Result<ContainedImage> readNrrd(const VolumeSource& source, const std::filesystem::path& path);
[[nodiscard]] Result<ContainedImage> readMeta(const VolumeSource& source, const std::filesystem::path& path);

/// Bytes of an image with these sizes; refuses 2D, more than one image, and no voxel.
[[nodiscard]] Result<std::uint64_t> imageBytes(const std::filesystem::path& path, std::span<const std::int64_t> sizes,
                                               std::uint64_t bytesPerVoxel);
/// Like above, for one of several images along the fourth axis: bytes of one image. Sets `frames` to their number.
[[nodiscard]] Result<std::uint64_t> frameBytes(const std::filesystem::path& path, std::vector<std::int64_t> sizes,
                                               std::uint64_t bytesPerVoxel, std::uint64_t& frames);

/// Index of the image in a file with this number of images, from 0.
[[nodiscard]] Result<std::uint64_t> frameOf(const std::filesystem::path& path, std::uint64_t frames,
                                            const VolumeReadOptions& options);

/// Layout of the voxels after their header, or in separate files.
struct VoxelFiles {
    enum class Coding { Raw, Text, Gzip, ZlibOrGzip };

    std::vector<std::string>
        names; ///< in order, in the header's folder, with equal numbers of slices; none: after the header
    Coding coding = Coding::Raw;
    std::int64_t skippedLines = 0; ///< of each file
    std::int64_t skippedBytes = 0; ///< after those lines; -1: the voxels are the end of the file
    bool swapped = false;          ///< not in the machine's byte order
};

/// Returns the names of a pattern like "slice%03d.raw 1 20 1" (default step 1; ignores text after the step). Empty if
/// the text is no such pattern.
[[nodiscard]] std::optional<std::vector<std::string>> numberedNames(std::string_view pattern);
/// One name per line, up to the end of the file or an empty line.
[[nodiscard]] Result<std::vector<std::string>> listedNames(ByteReader& reader);

/// Gives the image its voxels; `attached` stands behind the header. Data behind the voxels is noted.
[[nodiscard]] Result<void> readVoxels(const VolumeSource& source, ByteReader attached, const VoxelFiles& files,
                                      ContainedImage& contained);

/// The next bytes of `reader`, as many as the grid has voxels.
[[nodiscard]] Result<void> takeVoxels(ByteReader& reader, StoredImage& image, bool swapped);

/// Says that `bytes` of data follow the voxels, which may mean that these begin later.
void noteMore(std::uint64_t bytes, std::vector<std::string>& notes);

/// Position of voxel (0,0,0), and the step along each axis: a length times a direction, which need not be a unit
/// vector. mm, LPS.
struct AffineSteps {
    std::array<Vec3, 3> directions{};
    Vec3 lengths{1, 1, 1};
    Vec3 origin{};
};
/// Refuses steps that are not finite, that are none, that are beyond all reason (a damaged header), and that lie in
/// one plane. `grid.size` stays as it is.
[[nodiscard]] Result<void> setSteps(Grid& grid, const AffineSteps& affine, const std::filesystem::path& path);

/// Default of a missing header field.
inline constexpr const char* kNoSpacing = "the file does not say its spacing; 1 mm is taken";
inline constexpr const char* kNoOrigin = "the file does not say where its first voxel is; 0 0 0 is taken";

/// Says so where the axes are not at right angles and the format means it.
void noteShear(const Grid& grid, std::vector<std::string>& notes);

/// The largest distance in millimetres between the places of the same corner of the image.
[[nodiscard]] double cornersApart(const Grid& a, const Grid& b);

} // namespace voxtact::io
