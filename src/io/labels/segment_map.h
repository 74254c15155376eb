// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/io.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace voxtact::io {

/// One segment of a segmentation.
struct Segment {
    std::string name;
    std::int64_t number = 0; ///< in the file
};

/// A label map made of segments that must not overlap.
class SegmentMap {
  public:
    /// Refuses more segments than a label map has labels.
    [[nodiscard]] static Result<SegmentMap> create(const std::filesystem::path& path, const Grid& grid,
                                                   std::vector<Segment> segments);

    [[nodiscard]] const Grid& grid() const noexcept { return grid_; }
    [[nodiscard]] const std::vector<Segment>& segments() const noexcept { return segments_; }

    /// Gives the voxel to a segment; false if it is another one's.
    [[nodiscard]] bool set(std::uint64_t voxel, std::size_t segment);
    /// The error of the last set() that returned false.
    [[nodiscard]] Error overlap() const;

    /// The labels are the numbers of the segments if these are distinct and positive, else 1, 2, ..., with a note.
    [[nodiscard]] LabelFile finish(std::vector<std::string> notes) &&;

  private:
    SegmentMap(std::filesystem::path path, const Grid& grid, std::vector<Segment> segments);

    std::filesystem::path path_;
    Grid grid_;
    std::vector<Segment> segments_;
    std::vector<std::uint16_t> owners_; ///< of each voxel: 0, or 1 + the segment
    std::size_t first_ = 0;             ///< the two that overlap
    std::size_t second_ = 0;
};

/// A segmentation of 3D Slicer (.seg.nrrd); none if the file is NRRD without segments, or no NRRD.
[[nodiscard]] Result<std::optional<LabelFile>> readSegNrrd(const std::filesystem::path& path,
                                                           const VolumeReadOptions& options);

/// The voxels of any file of readVolume() as labels.
[[nodiscard]] Result<LabelFile> readLabelImage(const std::filesystem::path& path, const VolumeReadOptions& options);

} // namespace voxtact::io
