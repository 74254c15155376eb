// SPDX-License-Identifier: MIT
#pragma once

#include "io/dicom/dicom_slice.h"
#include "io/volume/stored_image.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::io {

/// Begins the note of a volume that was resampled.
inline constexpr std::string_view kResampledNote = "resampled to a regular grid";

/// The regular grid of slices that make none: upright on the first slice, as fine as the smallest gap, around all of
/// them.
class DicomResampler {
  public:
    /// Expects slices of one orientation and size, sorted by different heights. Refuses a grid of far more voxels than
    /// the slices have.
    [[nodiscard]] static Result<DicomResampler> create(const std::filesystem::path& folder, const DicomImage& image,
                                                       const std::vector<DicomSlice>& slices);

    [[nodiscard]] const Grid& grid() const noexcept { return grid_; }
    /// Interpolates the voxels of the slices (x fastest, slice by slice) at the grid's voxels: linear between the two
    /// slices around a voxel, and bilinear in each, in double precision. Voxels outside a slice that they need get the
    /// minimum of all voxels. Adds a note.
    [[nodiscard]] StoredImage resample(StoredType type, const std::vector<std::byte>& voxels,
                                       std::vector<std::string>& notes) const;

  private:
    /// Position of a slice: voxel (x, y) of the grid is its pixel (x + across, y + down).
    struct Place {
        double across = 0;
        double down = 0;
        double height = 0; ///< mm above the first slice
    };
    /// Sources of a slice of the grid: (1 - share) * slice + share * (slice + 1).
    struct Blend {
        std::size_t slice = 0;
        double share = 0;
    };

    DicomResampler(const DicomImage& image, const std::vector<DicomSlice>& slices);
    [[nodiscard]] Result<void> setGrid(const std::filesystem::path& folder, const std::vector<DicomSlice>& slices);
    [[nodiscard]] Blend blendAt(std::uint32_t slice) const;
    template <class Stored>
    void addSlice(const Stored* pixels, const Place& place, double weight, std::vector<double>& sum) const;
    template <class Stored> std::uint64_t fill(const Stored* stored, double least, float* out) const;
    [[nodiscard]] std::string note(std::uint64_t empty, double least) const;

    std::uint32_t columns_;
    std::uint32_t rows_;
    std::vector<Place> places_;
    Grid grid_;
    double smallestGap_ = 0;
    double largestGap_ = 0;
    double shear_ = 0; ///< degrees
};

} // namespace voxtact::io
