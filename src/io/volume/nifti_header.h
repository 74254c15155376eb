// SPDX-License-Identifier: MIT
#pragma once

#include "io/volume/volume_container.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::io {

/// Fields of a NIfTI-1, NIfTI-2 or Analyze 7.5 header about type and position of the voxels.
struct NiftiHeader {
    enum class Kind { Analyze, Nifti1, Nifti2 };

    Kind kind = Kind::Nifti1;
    bool swapped = false;            ///< not in the machine's byte order
    std::vector<std::int64_t> sizes; ///< as many as there are dimensions
    std::int16_t type = 0;           ///< NIfTI's number
    std::uint64_t voxelOffset = 0;   ///< in the file that holds the voxels
    std::array<double, 4> pixdim{};  ///< the first is qfac
    double slope = 0;                ///< scl_slope, or SPM's use of that field
    double intercept = 0;            ///< scl_inter
    std::int32_t units = 0;          ///< xyzt_units
    std::int32_t qformCode = 0;
    std::int32_t sformCode = 0;
    std::array<double, 3> quaternion{}; ///< b, c, d
    std::array<double, 3> qoffset{};
    std::array<std::array<double, 4>, 3> srow{}; ///< rows of world_from_index, RAS
    std::array<double, 3> analyzeOrigin{};       ///< SPM's voxel, counted from 1, in Analyze files
};

/// A data type of single numbers.
struct NiftiType {
    std::int16_t number;
    StoredType stored;
};
constexpr std::array<NiftiType, 10> kNiftiTypes{{{2, StoredType::UInt8},
                                                 {4, StoredType::Int16},
                                                 {8, StoredType::Int32},
                                                 {16, StoredType::Float32},
                                                 {64, StoredType::Float64},
                                                 {256, StoredType::Int8},
                                                 {512, StoredType::UInt16},
                                                 {768, StoredType::UInt32},
                                                 {1024, StoredType::Int64},
                                                 {1280, StoredType::UInt64}}};

constexpr std::size_t kNifti1Bytes = 348;
constexpr std::size_t kNifti2Bytes = 540;

/// Returns true if a header with this beginning takes kNifti2Bytes.
[[nodiscard]] bool isNifti2(std::string_view head);

/// `head`: the first bytes of the file, kNifti1Bytes or kNifti2Bytes of them, or all. `single`: header and
/// voxels are one file.
[[nodiscard]] Result<NiftiHeader> parseNiftiHeader(const std::filesystem::path& path, std::string_view head,
                                                   bool single);

/// The header as NIfTI-1 has it, in the machine's byte order, of a file that holds such voxels as well. The sizes fit
/// int16.
[[nodiscard]] std::string nifti1Bytes(const NiftiHeader& header, StoredType voxels);

/// Says the place of the voxels, mm: the sform, and the qform where the axes are at right angles. The sizes too.
void setNiftiGrid(NiftiHeader& header, const Grid& grid);

/// Returns the position of the voxels like nibabel's `affine`, in mm and LPS: the sform if its code is set, else the
/// qform, else nibabel's default. Notes assumptions, and an sform and a qform that differ.
[[nodiscard]] Result<Grid> niftiGrid(const std::filesystem::path& path, const NiftiHeader& header,
                                     std::vector<std::string>& notes);

} // namespace voxtact::io
