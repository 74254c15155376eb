// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Files (target voxtact::io). Volumes through ITK, meshes through assimp. Errors name the file and the reason, and
/// where there is one the line.
/// Thread-safety: safe from any thread on different files. ITK's readers share global state, so calls for volumes wait
/// for each other, and ITK's global warning display is off while one runs.
namespace voxtact::io {

/// NIfTI-1 (.nii, .hdr/.img, each also with .gz), NRRD (.nrrd, .nhdr), MetaImage (.mha, .mhd), or a folder with one
/// DICOM series: one slice a file, or enhanced multi-frame. World is LPS, as ITK gives it; left-handed directions are
/// kept. Voxels keep their type where it is one of ScalarType; other integers become int16, else uint16, else float
/// when every voxel survives exactly (refused otherwise), and double becomes float; both are said in `notes`, and so is
/// a NIfTI or NRRD file that does not say how the patient lies. NIfTI's slope and intercept and DICOM's rescale are
/// applied, which may make floats. Refuses 2D (NIfTI: one slice too), 4D with more than one image, RGB, complex and
/// vector images, empty images, NaN and infinite voxels (the first is named), singular directions, truncated and
/// damaged files (checksums of compressed data are verified), voxels as text or spread over several files, NIfTI-2, and
/// DICOM folders with several series (named), fewer than 2 slices, missing slices or uneven gaps, and slices sheared by
/// a tilted gantry.
[[nodiscard]] VOXTACT_API Result<VolumeData> readVolume(const std::filesystem::path& path);

/// NIfTI (.nii, .nii.gz), NRRD (.nrrd) or MetaImage (.mha), by the ending. Written to a temporary name, read back and
/// renamed. NRRD and MetaImage keep the grid to the last bits; NIfTI holds it in single precision. Refuses what
/// checkVolume() refuses, and a grid that the format cannot hold to a hundredth of a voxel (NIfTI: directions that are
/// not at right angles, fewer than 2 slices, sizes above 32767).
VOXTACT_API Result<void> writeVolume(const std::filesystem::path& path, const VolumeView& volume);

/// What the coordinates of a mesh file mean.
enum class MeshSpace { LPS, RAS };

struct MeshReadOptions {
    MeshSpace space = MeshSpace::LPS; ///< RAS: x and y are negated
    double scale = 1;                 ///< millimetres in a unit of the file; positive
};

/// STL (ascii, binary), OBJ, PLY, OFF, glTF 2, GLB, by the ending in any case. Node transforms are applied (a mirrored
/// node's triangles are turned, so that outward stays outward), polygons are cut into triangles, all meshes of a file
/// become one; points and lines are left out and said in `notes`. Corners with bit-identical positions are merged (-0
/// is 0), vertices that no triangle uses are left out, degenerate triangles stay. The file is read strictly: the number
/// of triangles is the number that the file states, or the file is refused. Refuses files without a triangle, NaN or
/// infinite vertices, indices out of range, malformed numbers, truncated files, polygons that cannot be cut, glTF with
/// compressed or quantized geometry, and a scale that is not positive and finite. Text coordinates may differ from the
/// nearest float in the last bits (assimp's number reader).
[[nodiscard]] VOXTACT_API Result<MeshData> readMesh(const std::filesystem::path& path,
                                                    const MeshReadOptions& options = {});

/// STL (binary), OBJ or PLY (binary), by the ending. Coordinates are written as they are. Written to a temporary name
/// and renamed. Refuses what checkMesh() refuses.
VOXTACT_API Result<void> writeMesh(const std::filesystem::path& path, const MeshView& mesh);

/// One matrix a line: 16 numbers, row by row; `#` comments and empty lines. Numbers have a decimal point in every
/// locale. Errors name the line ("poses.txt line 7: 15 numbers, a pose has 16 (row by row)"). Refuses what
/// checkAffine() refuses, and a file without a matrix.
[[nodiscard]] VOXTACT_API Result<std::vector<Mat4>> readPoses(const std::filesystem::path& path);
VOXTACT_API Result<void> writePoses(const std::filesystem::path& path, std::span<const Mat4> world_from_object);

/// One `clip_from_world` matrix: 16 numbers, row by row, on any number of lines. Refuses a singular one.
[[nodiscard]] VOXTACT_API Result<Mat4> readCamera(const std::filesystem::path& path);

/// Text: lines `value opacity`, `#` comments; or JSON (an object: told by the first character) with `points`: an array
/// of [value, opacity] or of objects with `value` and `opacity`; readColours() reads another member. Errors name the
/// line or the point. Refuses opacities outside [0,1], values below the one before, and no point.
[[nodiscard]] VOXTACT_API Result<std::vector<ControlPoint>> readTransferFunction(const std::filesystem::path& path);
/// The colours of such a JSON file: `colours`, an array of [value, red, green, blue] with channels from 0 to 1. None
/// where there are none, and for text. Refuses channels outside [0,1] and values below the one before.
[[nodiscard]] VOXTACT_API Result<std::vector<ColourPoint>> readColours(const std::filesystem::path& path);
/// The same as "v:a,v:a,...".
[[nodiscard]] VOXTACT_API Result<std::vector<ControlPoint>> parseOpacity(std::string_view text);

/// What a label of a label map is called.
struct LabelName {
    std::int32_t label = 0;
    std::string name;
};

/// One label a line: `number name`, and whatever follows; `#` comments and empty lines. This is what lies beside label
/// maps of MRIcron, and FreeSurfer's colour tables. In the order of the file. Errors name the line. Refuses numbers
/// that are not whole or beyond an int32, a line without a name, a number with two different names, and a file without
/// a label.
[[nodiscard]] VOXTACT_API Result<std::vector<LabelName>> readLabelNames(const std::filesystem::path& path);

/// A PNG file of 8 bits a channel: red, green, blue and alpha of each pixel, the uppermost row first. Written to a
/// temporary name and renamed. Refuses an empty picture, one with another number of bytes, an ending other than .png,
/// and more than 2^30 bytes.
VOXTACT_API Result<void> writePng(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                                  std::span<const std::uint8_t> rgba);

/// Calls `write` with a stream (classic locale) on a temporary file beside `path`, and renames it to `path` when
/// everything went well; otherwise the temporary file is removed and `path` is as it was. A link is followed, an
/// existing file's permissions are kept, and a device or pipe is written to directly.
VOXTACT_API Result<void> writeFile(const std::filesystem::path& path,
                                   const std::function<Result<void>(std::ostream&)>& write);
/// The same for libraries that open files themselves: `write` gets the temporary path, which has `path`'s ending.
/// Refuses devices and pipes.
VOXTACT_API Result<void> writeFileAt(const std::filesystem::path& path,
                                     const std::function<Result<void>(const std::filesystem::path& temporary)>& write);

} // namespace voxtact::io
