// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// Files (target voxtact::io). Errors name the file and the reason, and where there is one the line. A folder, pipe,
/// socket or device in the place of a file is refused before it is opened.
/// Thread-safety: safe from any thread on different files.
namespace voxtact::io {

/// How far reading is: how much was taken up, of how much; bytes of a file as it is stored, or files of a DICOM series.
/// Of a header and of the file with its voxels one after the other. Called on the reading thread, at least every 8 MiB.
/// False: no more is read, and what is called returns Cancelled.
using ReadProgress = std::function<bool(std::uint64_t done, std::uint64_t all)>;

/// Which image of a file or folder that holds several is read, and who hears how far that is.
struct VolumeReadOptions {
    /// Which image of a 4D NIfTI file, counted from 0. A file that holds several is refused without it; of another file
    /// only 0 is there, and of a folder none.
    std::optional<std::uint32_t> frame{};
    /// SeriesInstanceUID of the series of a DICOM folder. A folder that holds several is refused without it, and a file
    /// with it. Empty: the only one.
    std::string series{}; // the initialisers let {.frame = 3} compile without a warning
    /// Must not throw. Empty: nobody. Not called for bytes in memory.
    ReadProgress progress{};
    /// Grid of the image that the contours of an RTSTRUCT belong to; only readLabels() uses it.
    std::optional<Grid> grid{};
};

/// Degrees by which an sform of NIfTI may be sheared: what is sheared by more comes from a registration, and places the
/// voxels in a template, not in the patient.
inline constexpr double kMaxShear = 0.1;
/// Degrees: how far two of the axes are from a right angle, at most. Expects a grid that checkGrid() accepts.
[[nodiscard]] VOXTACT_API double shearDegrees(const Grid& grid) noexcept;
/// The note of a volume whose axes are not at right angles, to more than a hundredth of a degree; otherwise empty.
[[nodiscard]] VOXTACT_API std::string shearNote(const Grid& grid);

/// NIfTI-1 and -2 (.nii, .hdr/.img, each also with .gz; Analyze 7.5 pairs too), NRRD (.nrrd, .nhdr), MetaImage (.mha,
/// .mhd), or a folder with one DICOM series: one slice a file, enhanced multi-frame, or a dose in frames. World is LPS,
/// in millimetres; left-handed directions are kept. Voxels keep their type where it is one of ScalarType; other
/// integers become int16, else uint16, else float when every voxel survives exactly (refused otherwise), and double
/// becomes float; both are said in `notes`, and so are what a file does not say and is assumed, data behind the stated
/// voxels, and files of a DICOM folder that are left out. NIfTI's slope and intercept and DICOM's rescale and dose
/// scaling are applied, which may make floats.
///
/// NIfTI: the place is that of nibabel's `affine`: the sform, else the qform, else the centre; a qform that differs
/// from the sform is noted, and an sform with a shear of more than kMaxShear is refused. Lengths in metres and
/// micrometres become millimetres. NRRD and MetaImage: shears are kept, and noted.
///
/// Refuses 2D, 4D with more than one image unless it is chosen, RGB, complex and vector images, empty images, NaN and
/// infinite voxels (the first is named), places that are not finite, singular directions, truncated and damaged files
/// (checksums of compressed data are verified), and DICOM folders with several series unless one is chosen, fewer than
/// 2 slices, missing slices, uneven gaps, a tilted gantry, mosaics, and files that end in .dcm and are none. Memory is
/// bounded by what the file holds, whatever its header claims; compressed, deflate packs up to 1032 bytes into one.
[[nodiscard]] VOXTACT_API Result<VolumeData> readVolume(const std::filesystem::path& path,
                                                        const VolumeReadOptions& options = {});
/// The same from one file's bytes in memory; the ending of `name` says the format.
[[nodiscard]] VOXTACT_API Result<VolumeData> readVolume(std::string_view name, std::span<const std::byte> content,
                                                        const VolumeReadOptions& options = {});

/// The name of a label of a label map.
struct LabelName {
    std::int32_t label = 0; ///< its number in the map
    std::string name;       ///< its name
};

/// A label map of a file.
struct LabelFile {
    LabelData labels;               ///< in millimetres in LPS, as VolumeData has it
    std::vector<std::string> notes; ///< as in VolumeData
    std::vector<LabelName> names;   ///< that a segmentation states; empty for other files
};
/// The files of readVolume() as a label map: makeLabels(). Integers of 32 and 64 bits, and doubles, are taken as they
/// are stored, where readVolume() makes floats of them. Refuses labels beyond an int32.
///
/// Reads segmentations too: 3D Slicer's (.seg.nrrd), whose layers become one map with a note; a DICOM file of the class
/// SEG, on its own grid (places without a frame are empty, fractions of a half or more are inside); and RTSTRUCT, whose
/// closed planar contours are filled in the slices of `options.grid` at voxel centres, by the even-odd rule. Refuses
/// segments that overlap, with the names of two, uneven slices, and contours that are in no slice.
[[nodiscard]] VOXTACT_API Result<LabelFile> readLabels(const std::filesystem::path& path,
                                                       const VolumeReadOptions& options = {});
/// True if readLabels() needs the grid of an image for this path: an RTSTRUCT. False for what cannot be read.
[[nodiscard]] VOXTACT_API bool holdsContours(const std::filesystem::path& path);

/// NIfTI-1 (.nii, .nii.gz), NRRD (.nrrd) or MetaImage (.mha), by the ending. Written to a temporary name and renamed.
/// NRRD and MetaImage keep the grid to the last bits; NIfTI holds it in single precision, as sform and qform. Refuses
/// what checkVolume() refuses, and a grid that the format cannot hold to a hundredth of a voxel (NIfTI: directions that
/// are not at right angles, fewer than 2 slices, sizes above 32767).
VOXTACT_API Result<void> writeVolume(const std::filesystem::path& path, const VolumeView& volume);
/// The same to a stream, which the caller looks at. The ending of `name` says the format, and messages have it.
VOXTACT_API Result<void> writeVolume(std::ostream& out, const std::filesystem::path& name, const VolumeView& volume);

/// What the coordinates of a mesh file mean.
enum class MeshSpace { LPS, RAS };

/// What the numbers of a mesh file mean.
struct MeshReadOptions {
    /// RAS: x and y are negated. Empty: what a header of STL, OBJ, PLY or VTK says (`SPACE=RAS`, as 3D Slicer writes
    /// it),
    /// else LPS. A header that says another one is refused.
    std::optional<MeshSpace> space{};
    double scale = 1; ///< millimetres in a unit of the file; positive. Of STEP and IGES: in their mm
    double deflection = kDefaultDeflection; ///< mm: STEP and IGES are triangulated with it; from 1e-6 on
};

/// The note of a mesh whose MeshFacts::rounding is more than kNotedRounding; otherwise empty.
[[nodiscard]] VOXTACT_API std::string roundingNote(const MeshFacts& facts);

/// STL (ascii, binary), OBJ, PLY (ascii, binary of either byte order), OFF, VTK's PolyData (.vtk, .vtp), glTF 2, GLB,
/// by the ending in any case. Node transforms are applied (a mirrored node's triangles are turned, so that outward
/// stays outward), and so are skins and morph targets as they stand in the file; animations and hidden nodes are left
/// out. Polygons are cut into triangles: a fan around the first corner where that stays inside, else ear by ear. All
/// meshes of a file become one; points and lines are left out. What is left out or chosen is said in `notes`. Corners
/// with bit-identical positions are merged (-0 is 0), vertices that no triangle uses are left out, degenerate triangles
/// stay, in the order of the file. Coordinates are doubles from the file on; what single precision loses of them is
/// noted. The file is read strictly: what is not understood is refused. So are files without a triangle, NaN or
/// infinite vertices and such as no float holds, indices out of range, malformed numbers, truncated files and files
/// that go on after what their header states (zeros and white space are noted), polygons that cross themselves, OBJ
/// with curved surfaces or weights other than 1, VTK files of other datasets, glTF that requires an extension other
/// than KHR_mesh_quantization, KHR_node_visibility and those about looks and lights, and a scale that is not positive
/// and finite.
///
/// STEP and IGES (.step, .stp, .iges, .igs): the program voxtact-step, which lies beside the library or the calling
/// program, reads and triangulates them by OpenCASCADE, in a process of its own. Without it they are refused.
/// MeshData::deflection bounds how far the faces of the file are from the triangles.
[[nodiscard]] VOXTACT_API Result<MeshData> readMesh(const std::filesystem::path& path,
                                                    const MeshReadOptions& options = {});
/// The same for a file in memory. Messages call it `name`, and the ending of that is the format. glTF that refers to
/// other files is refused, and so are STEP and IGES.
[[nodiscard]] VOXTACT_API Result<MeshData>
readMesh(std::span<const std::byte> content, const std::filesystem::path& name, const MeshReadOptions& options = {});

/// STL (binary), OBJ or PLY (binary), by the ending. STL rounds coordinates to floats. Written to a temporary name
/// and renamed. Refuses what checkMesh() refuses.
VOXTACT_API Result<void> writeMesh(const std::filesystem::path& path, const MeshView& mesh);

/// Poses as readPoses() reads them, some at a time: in constant memory.
/// Thread-safety: none; one thread at a time.
class PoseReader {
  public:
    /// Refuses a file that cannot be opened.
    [[nodiscard]] VOXTACT_API static Result<PoseReader> open(const std::filesystem::path& path);
    /// `name` is what errors call the stream, which must outlive the reader. Its buffer is read; its state, which must
    /// not be bad, stays as it is.
    [[nodiscard]] VOXTACT_API static Result<PoseReader> over(std::istream& stream, const std::string& name);
    VOXTACT_API PoseReader(PoseReader&&) noexcept;
    VOXTACT_API PoseReader& operator=(PoseReader&&) noexcept;
    VOXTACT_API ~PoseReader();

    /// Appends the next poses, at most so many. False: there are no more. Errors as of readPoses().
    [[nodiscard]] VOXTACT_API Result<bool> read(std::size_t most, std::vector<Mat4>& world_from_object);

    struct State;

  private:
    explicit PoseReader(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

/// One matrix a line: 16 numbers, or 12 without the last row, row by row, with blanks or commas between them; or four
/// lines of 4 numbers; or an affine transform of ITK (the lines Transform, Parameters and FixedParameters), whose
/// inverse is the pose, as 3D Slicer writes it. `#` comments and empty lines. Numbers have a decimal point in every
/// locale. Errors name the line
/// ("poses.txt line 7: 15 numbers, a pose has 16, or 12 (row by row)"). Refuses what checkAffine() refuses, and a file
/// without a matrix.
[[nodiscard]] VOXTACT_API Result<std::vector<Mat4>> readPoses(const std::filesystem::path& path);

/// One `clip_from_world` matrix: 16 numbers, row by row, on any number of lines. Refuses a singular one.
[[nodiscard]] VOXTACT_API Result<Mat4> readCamera(const std::filesystem::path& path);

/// Reads opacity: text with lines `value opacity` and `#` comments; JSON (told by the first character) with `points`,
/// an array of [value, opacity] or of objects with `value` and `opacity`; ParaView's colour map (JSON), where its
/// opacity is linear between the points; or 3D Slicer's volume property (.vp), where its gradient opacity is 1. Errors
/// name the line or the point. Refuses opacities outside [0,1], values below the one before, and no point.
[[nodiscard]] VOXTACT_API Result<std::vector<ControlPoint>> readTransferFunction(const std::filesystem::path& path);
/// Reads the colours of such a file: of JSON `colours`, an array of [value, red, green, blue] with channels from 0 to
/// 1, or those of another program, which are mixed in RGB. None where there are none, and for text. Refuses channels
/// outside [0,1] and values below the one before.
[[nodiscard]] VOXTACT_API Result<std::vector<ColourPoint>> readColours(const std::filesystem::path& path);
/// The same as "v:a,v:a,...".
[[nodiscard]] VOXTACT_API Result<std::vector<ControlPoint>> parseOpacity(std::string_view text);

/// One label per line: `number name`, or ITK-SNAP's `number R G B A VIS MSH "name"`; `#` comments and empty lines. A
/// name may have blanks; numbers behind it (colours of FreeSurfer and 3D Slicer, or MRIcron's one number) are no part
/// of it, unless one number is all that tells names apart. In the order of the file. Errors name the line. Refuses
/// numbers that are not whole or beyond an int32, a line without a name, a number with two different names, and a file
/// without a label.
[[nodiscard]] VOXTACT_API Result<std::vector<LabelName>> readLabelNames(const std::filesystem::path& path);

/// A point of a list.
struct NamedPoint {
    Vec3 position{};        ///< mm in LPS
    std::string name;       ///< empty: it has none
    std::uint64_t line = 0; ///< of the file, from 1; in .mrk.json the number of the point
};

/// Reads points, in the order of the file: 3D Slicer's .fcsv and .mrk.json by the ending, else one point a line, `x y
/// z` or `x y z name` with `#` comments and empty lines. `space`: of the coordinates; empty: as the file states, else
/// LPS. Errors name the line. Refuses a space that contradicts the file, numbers that are not finite, lines of other
/// lengths, a .fcsv without a coordinate system where no space is given, markups other than lists of points, points
/// that are not placed, units other than mm, and a file without a point.
[[nodiscard]] VOXTACT_API Result<std::vector<NamedPoint>> readPoints(const std::filesystem::path& path,
                                                                     std::optional<MeshSpace> space = {});

/// How far writing is: rows of a picture that are written, and all. Called on the writing thread, after each. False: no
/// more is written, and what is called returns Cancelled. Must not throw. Empty: nobody.
using WriteProgress = std::function<bool(std::uint32_t done, std::uint32_t rows)>;

/// A PNG file of 8 bits a channel: red, green, blue and alpha of each pixel, the uppermost row first. Written to a
/// temporary name and renamed, so that a file that is cancelled is as it was. Refuses an empty picture, one with
/// another number of bytes, an ending other than .png, and more than 2^30 bytes.
VOXTACT_API Result<void> writePng(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                                  std::span<const std::uint8_t> rgba, const WriteProgress& progress = {});
/// The same to a stream, which the caller looks at, also after Cancelled.
VOXTACT_API Result<void> writePng(std::ostream& out, std::uint32_t width, std::uint32_t height,
                                  std::span<const std::uint8_t> rgba, const WriteProgress& progress = {});

/// A file that is there when it is complete: what is written to its stream (classic locale) goes to a temporary file
/// beside `path`, which commit() puts in its place. Without commit() the temporary file is removed, and `path` is as it
/// was. A link is followed, an existing file's permissions are kept, and a device or pipe is written to directly.
/// Thread-safety: none; one thread at a time.
class OutputFile {
  public:
    /// Refuses folders, folders that do not exist, and what cannot be opened.
    [[nodiscard]] VOXTACT_API static Result<OutputFile> create(const std::filesystem::path& path);
    VOXTACT_API OutputFile(OutputFile&&) noexcept;
    VOXTACT_API OutputFile& operator=(OutputFile&&) noexcept;
    VOXTACT_API ~OutputFile();

    /// Where to write: in the classic locale, valid until close() or commit().
    [[nodiscard]] VOXTACT_API std::ostream& stream() noexcept;
    /// Writes the rest, and says whether all went well, with the system's reason where it did not: a full disk.
    /// Nothing is written afterwards.
    [[nodiscard]] VOXTACT_API Result<void> close();
    /// close(), if that was not done, and the rename.
    [[nodiscard]] VOXTACT_API Result<void> commit();
    /// commit() of several: all of them are put in their places, or none: where one cannot be, what was in the places
    /// of the others is there again, or the error says under which name it is. What went to a device or a pipe cannot
    /// be taken back.
    [[nodiscard]] VOXTACT_API static Result<void> commitAll(std::span<OutputFile* const> files);

    struct State;

  private:
    explicit OutputFile(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

/// Calls `write` with the stream of an OutputFile, and commits that when everything went well.
VOXTACT_API Result<void> writeFile(const std::filesystem::path& path,
                                   const std::function<Result<void>(std::ostream&)>& write);

} // namespace voxtact::io
