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

/// Files (target voxtact::io). Errors name the file, the reason and, if there is one, the line. Functions for a file
/// refuse folders, pipes, sockets and devices without opening them. Thread-safety: safe from any thread on different
/// files.
namespace voxtact::io {

/// Receives the progress of reading: bytes of the stored file, or files of a DICOM series, done and in total. Header
/// file and voxel file count one after the other. Called on the reading thread, at least every 8 MiB. Return false to
/// cancel: the reading function returns Cancelled.
using ReadProgress = std::function<bool(std::uint64_t done, std::uint64_t all)>;

/// Selects an image of a file or folder that holds several; receives progress.
struct VolumeReadOptions {
    /// Index of the image in a 4D NIfTI file, from 0. Required if the file holds several images. Other files have only
    /// image 0, and folders none.
    std::optional<std::uint32_t> frame{};
    /// SeriesInstanceUID of a series in a DICOM folder. Required if the folder holds several series; refused for a
    /// file. Empty: the only series.
    std::string series{}; // the initialisers let {.frame = 3} compile without a warning
    /// Called while a file is read, not for bytes in memory. Must not throw; may be empty.
    ReadProgress progress{};
    /// Grid of the image to which the contours of an RTSTRUCT belong; only readLabels() uses it.
    std::optional<Grid> grid{};
    /// Resamples DICOM slices without a regular grid (uneven gaps, a tilted gantry) by linear interpolation, as floats,
    /// with a note. False: refuses such slices. readLabels() never resamples, because labels are not interpolated.
    bool resample = false;
};

/// Maximum shear of a NIfTI sform, degrees: a larger shear comes from a registration to a template, and does not place
/// the voxels in the patient.
inline constexpr double kMaxShear = 0.1;
/// Returns the largest deviation of two axes from a right angle, degrees. Expects a grid that checkGrid() accepts.
[[nodiscard]] VOXTACT_API double shearDegrees(const Grid& grid) noexcept;
/// Returns the note for a volume whose axes deviate from right angles by more than a hundredth of a degree; otherwise
/// empty.
[[nodiscard]] VOXTACT_API std::string shearNote(const Grid& grid);

/// Reads a volume: NIfTI-1 and -2 (.nii, .hdr/.img, also with .gz; Analyze 7.5 pairs), NRRD (.nrrd, .nhdr), MetaImage
/// (.mha, .mhd), or a folder with one DICOM series (one slice per file, enhanced multi-frame, or dose frames). World is
/// LPS, in millimetres; left-handed directions are kept. Voxels keep their type if ScalarType has it. Other integers
/// become int16, else uint16, else float if every voxel stays exact; otherwise they are refused. Double becomes float.
/// `notes` lists conversions, assumptions about unstated facts, data after the stated voxels, and skipped files of a
/// DICOM folder. Applies NIfTI's slope and intercept, and DICOM's rescale and dose scaling; the result may be float.
///
/// NIfTI: the position is nibabel's `affine`: the sform, else the qform, else the centre. A qform that differs from the
/// sform gives a note; an sform with a shear above kMaxShear is refused. Lengths in metres and micrometres become
/// millimetres. NRRD and MetaImage: shears are kept and give a note.
///
/// Refuses 2D images, 4D without a chosen image, and RGB, complex, vector and empty images. Refuses NaN and infinite
/// voxels (the error names the first), positions that are not finite, and singular directions. Refuses truncated and
/// damaged files; verifies checksums. Refuses DICOM folders with several series unless one is chosen, fewer than 2
/// slices, mosaics, and invalid .dcm files. Without resampling, also refuses missing slices, uneven gaps and a tilted
/// gantry. The size of the file bounds the memory, whatever its header claims; deflate expands at most 1032-fold.
[[nodiscard]] VOXTACT_API Result<VolumeData> readVolume(const std::filesystem::path& path,
                                                        const VolumeReadOptions& options = {});
/// Returns true if VolumeReadOptions::resample changed the voxels of a volume; its notes describe the change.
[[nodiscard]] VOXTACT_API bool wasResampled(const VolumeData& volume) noexcept;
/// Like readVolume(path), from the bytes of one file; the ending of `name` selects the format.
[[nodiscard]] VOXTACT_API Result<VolumeData> readVolume(std::string_view name, std::span<const std::byte> content,
                                                        const VolumeReadOptions& options = {});

/// The name of a label of a label map.
struct LabelName {
    std::int32_t label = 0; ///< value in the map
    std::string name;       ///< name of the structure
};

/// A label map read from a file.
struct LabelFile {
    LabelData labels;               ///< in millimetres in LPS, like VolumeData
    std::vector<std::string> notes; ///< as in VolumeData
    std::vector<LabelName> names;   ///< names in a segmentation; empty for other files
};
/// Reads a label map from the files of readVolume(), through makeLabels(). Unlike readVolume(), keeps the stored values
/// of doubles and of integers of 32 and 64 bits. Refuses labels beyond an int32.
///
/// Also reads segmentations. 3D Slicer's (.seg.nrrd): its layers become one map, with a note. DICOM SEG: on its own
/// grid; positions without a frame are empty, fractions of at least 0.5 are inside. RTSTRUCT: its closed planar
/// contours are filled in the slices of `options.grid` at voxel centres, by the even-odd rule. Refuses overlapping
/// segments (the error names two), uneven slices, and contours outside all slices.
[[nodiscard]] VOXTACT_API Result<LabelFile> readLabels(const std::filesystem::path& path,
                                                       const VolumeReadOptions& options = {});
/// Returns true for an RTSTRUCT: readLabels() then needs the grid of an image. Returns false for unreadable files.
[[nodiscard]] VOXTACT_API bool holdsContours(const std::filesystem::path& path);

/// Writes NIfTI-1 (.nii, .nii.gz), NRRD (.nrrd) or MetaImage (.mha), by the ending, to a temporary name, then renames.
/// NRRD and MetaImage store the grid to the last bits; NIfTI stores it in single precision, as sform and qform. Refuses
/// volumes that checkVolume() refuses. Refuses grids that the format cannot store within 0.01 voxel (NIfTI: directions
/// that are not at right angles, fewer than 2 slices, sizes above 32767).
VOXTACT_API Result<void> writeVolume(const std::filesystem::path& path, const VolumeView& volume);
/// Like writeVolume(path), to a stream, whose state the caller checks. The ending of `name` selects the format;
/// messages use `name`.
VOXTACT_API Result<void> writeVolume(std::ostream& out, const std::filesystem::path& name, const VolumeView& volume);

/// Space of the coordinates in a mesh file.
enum class MeshSpace { LPS, RAS };

/// Unit and space of a mesh file.
struct MeshReadOptions {
    /// RAS: x and y are negated. Empty: the space in a header of STL, OBJ, PLY or VTK (`SPACE=RAS`, as 3D Slicer writes
    /// it), else LPS. A contradicting header is refused.
    std::optional<MeshSpace> space{};
    double scale = 1;                       ///< millimetres per unit of the file, for STEP and IGES per mm; positive
    double deflection = kDefaultDeflection; ///< mm, for the triangulation of STEP and IGES; at least 1e-6
};

/// Returns the note for a mesh whose MeshFacts::rounding exceeds kNotedRounding; otherwise empty.
[[nodiscard]] VOXTACT_API std::string roundingNote(const MeshFacts& facts);

/// Reads a mesh: STL (ascii, binary), OBJ, PLY (ascii, binary of either byte order), OFF, VTK's PolyData (.vtk, .vtp),
/// glTF 2 or GLB, by the ending, ignoring case.
///
/// glTF: applies node transforms, and skins and morph targets as stored. Reverses triangles of mirrored nodes, so they
/// still face outward. Ignores animations and hidden nodes. Polygons become triangles: a fan around the first corner if
/// it stays inside, else by ear clipping. All meshes of a file become one; points and lines are skipped. `notes` lists
/// skipped parts and choices. Merges corners with bit-identical positions (-0 is 0), and removes unused vertices. Keeps
/// degenerate triangles, and the order of the file. Coordinates are doubles; a loss by single precision gives a note.
///
/// Refuses unknown content, files without a triangle, malformed numbers, truncated files, and data after the stated end
/// (zeros and white space give a note). Refuses vertices that are NaN, infinite or beyond the range of floats, indices
/// out of range, and self-intersecting polygons. Refuses OBJ with curved surfaces or weights other than 1, VTK files of
/// other datasets, and a scale that is not positive and finite. Refuses glTF that requires an extension other than
/// KHR_mesh_quantization, KHR_node_visibility, and extensions for appearance and lights.
///
/// STEP and IGES (.step, .stp, .iges, .igs): the program voxtact-step reads and triangulates them with OpenCASCADE in a
/// separate process. The program must be in the folder of the library or of the calling program; otherwise such files
/// are refused. MeshData::deflection bounds the distance of the file's faces from the triangles.
[[nodiscard]] VOXTACT_API Result<MeshData> readMesh(const std::filesystem::path& path,
                                                    const MeshReadOptions& options = {});
/// Like readMesh(path), for a file in memory. Messages use `name`; its ending selects the format. Refuses STEP, IGES,
/// and glTF that refers to other files.
[[nodiscard]] VOXTACT_API Result<MeshData>
readMesh(std::span<const std::byte> content, const std::filesystem::path& name, const MeshReadOptions& options = {});

/// Writes STL (binary), OBJ or PLY (binary), by the ending, to a temporary name, then renames. STL rounds coordinates
/// to floats. Refuses meshes that checkMesh() refuses.
VOXTACT_API Result<void> writeMesh(const std::filesystem::path& path, const MeshView& mesh);

/// Notation of poses in a file.
enum class PoseFormat {
    Matrix,          ///< matrices, in all forms of readPoses()
    TranslationXyzw, ///< 7 numbers per line: a translation in mm and a unit quaternion x y z w
    TranslationWxyz, ///< a translation and w x y z
    XyzwTranslation, ///< x y z w and a translation
    WxyzTranslation, ///< w x y z and a translation
};
/// Returns all formats.
[[nodiscard]] VOXTACT_API std::span<const PoseFormat> poseFormats() noexcept;
/// Returns "matrix", "t-xyzw", "t-wxyz", "xyzw-t" or "wxyz-t"; static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(PoseFormat format) noexcept;
/// Returns the format with a name; none if the name is unknown.
[[nodiscard]] VOXTACT_API std::optional<PoseFormat> poseFormatFromName(std::string_view name) noexcept;

/// Reads poses in parts, in constant memory, with the syntax of readPoses().
/// Thread-safety: none; one thread at a time.
class PoseReader {
  public:
    /// Opens a file. Refuses a file that cannot be opened.
    [[nodiscard]] VOXTACT_API static Result<PoseReader> open(const std::filesystem::path& path,
                                                             PoseFormat format = PoseFormat::Matrix);
    /// Reads from the buffer of a stream, which must outlive the reader and not be bad. Leaves the stream's state
    /// unchanged. Errors name the stream `name`.
    [[nodiscard]] VOXTACT_API static Result<PoseReader> over(std::istream& stream, const std::string& name,
                                                             PoseFormat format = PoseFormat::Matrix);
    VOXTACT_API PoseReader(PoseReader&&) noexcept;
    VOXTACT_API PoseReader& operator=(PoseReader&&) noexcept;
    VOXTACT_API ~PoseReader();

    /// Appends at most `most` poses. Returns false at the end. Fails like readPoses().
    [[nodiscard]] VOXTACT_API Result<bool> read(std::size_t most, std::vector<Mat4>& world_from_object);

    struct State;

  private:
    explicit PoseReader(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

/// Reads poses. PoseFormat::Matrix: one matrix per line, 16 numbers, or 12 without the last row, row by row, separated
/// by blanks or commas. Also accepts four lines of 4 numbers, or an affine ITK transform of 3D Slicer (the lines
/// Transform, Parameters and FixedParameters); its inverse is the pose. Other formats: 7 numbers per line; the
/// translation moves the object's origin. `#` begins a comment; empty lines are skipped. Numbers have a decimal point
/// in every locale. Errors name the line ("poses.txt line 7: 15 numbers, a pose has 16, or 12 (row by row)"). Refuses
/// matrices that checkAffine() refuses, a quaternion whose norm differs from 1 by more than 0.001 (others are
/// normalised), and a file without a pose.
[[nodiscard]] VOXTACT_API Result<std::vector<Mat4>> readPoses(const std::filesystem::path& path,
                                                              PoseFormat format = PoseFormat::Matrix);

/// Reads one `clip_from_world` matrix: 16 numbers, row by row, on any number of lines. Refuses a singular matrix.
[[nodiscard]] VOXTACT_API Result<Mat4> readCamera(const std::filesystem::path& path);

/// Reads opacity: text with lines `value opacity` and `#` comments; JSON (recognised by the first character) with
/// `points`, an array of [value, opacity] or of objects with `value` and `opacity`; ParaView's colour map (JSON) if its
/// opacity is linear between the points; or 3D Slicer's volume property (.vp) if its gradient opacity is 1. Errors name
/// the line or the point. Refuses opacities outside [0,1], descending values, and an empty list.
[[nodiscard]] VOXTACT_API Result<std::vector<ControlPoint>> readTransferFunction(const std::filesystem::path& path);
/// Reads the colours of a transfer function's file. JSON: `colours`, an array of [value, red, green, blue] with
/// channels from 0 to 1. ParaView and 3D Slicer: their colours, interpolated in RGB. Returns none for text and for
/// files without colours. Refuses channels outside [0,1] and descending values.
[[nodiscard]] VOXTACT_API Result<std::vector<ColourPoint>> readColours(const std::filesystem::path& path);
/// Parses opacity from "v:a,v:a,...".
[[nodiscard]] VOXTACT_API Result<std::vector<ControlPoint>> parseOpacity(std::string_view text);

/// Reads label names, one label per line: `number name`, or ITK-SNAP's `number R G B A VIS MSH "name"`; `#` comments
/// and empty lines. A name may have blanks. Trailing numbers (colours of FreeSurfer and 3D Slicer, or MRIcron's one
/// number) are not part of the name, unless one number alone distinguishes names. Keeps the order of the file. Errors
/// name the line. Refuses numbers that are not whole or beyond an int32, and numbers with two different names. Refuses
/// a line without a name, and a file without a label.
[[nodiscard]] VOXTACT_API Result<std::vector<LabelName>> readLabelNames(const std::filesystem::path& path);

/// A named point of a list.
struct NamedPoint {
    Vec3 position{};        ///< mm in LPS
    std::string name;       ///< may be empty
    std::uint64_t line = 0; ///< line in the file, from 1; in .mrk.json, position in the list of points
};

/// Reads points, in the order of the file: 3D Slicer's .fcsv and .mrk.json by the ending, else one point per line, `x y
/// z` or `x y z name` with `#` comments and empty lines. `space`: space of the coordinates; empty: as the file states,
/// else LPS. Errors name the line. Refuses a space that contradicts the file, numbers that are not finite, lines of
/// other lengths, and a file without a point. Refuses a .fcsv without a coordinate system if `space` is empty. Refuses
/// markups other than lists of points, unplaced points, and units other than mm.
[[nodiscard]] VOXTACT_API Result<std::vector<NamedPoint>> readPoints(const std::filesystem::path& path,
                                                                     std::optional<MeshSpace> space = {});

/// Receives the progress of writing: rows of a picture, done and in total. Called on the writing thread, after each
/// row. Return false to cancel: the writing function returns Cancelled. Must not throw. May be empty.
using WriteProgress = std::function<bool(std::uint32_t done, std::uint32_t rows)>;

/// Writes a PNG file of 8 bits per channel: red, green, blue and alpha of each pixel, the uppermost row first. Writes a
/// temporary file and renames it at the end, so cancelling leaves an existing file unchanged. Refuses an empty picture,
/// a wrong number of bytes, an ending other than .png, and more than 2^30 bytes.
VOXTACT_API Result<void> writePng(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                                  std::span<const std::uint8_t> rgba, const WriteProgress& progress = {});
/// Like writePng(path), to a stream, whose state the caller checks, also after Cancelled.
VOXTACT_API Result<void> writePng(std::ostream& out, std::uint32_t width, std::uint32_t height,
                                  std::span<const std::uint8_t> rgba, const WriteProgress& progress = {});

/// A file that appears when it is complete: its stream (classic locale) writes to a temporary file in the folder of
/// `path`; commit() renames it. Without commit() the temporary file is removed and `path` stays unchanged. Follows
/// links, keeps an existing file's permissions, and writes directly to a device or pipe. Thread-safety: none; one
/// thread at a time.
class OutputFile {
  public:
    /// Opens the temporary file. Refuses folders, missing folders, and files that cannot be opened.
    [[nodiscard]] VOXTACT_API static Result<OutputFile> create(const std::filesystem::path& path);
    VOXTACT_API OutputFile(OutputFile&&) noexcept;
    VOXTACT_API OutputFile& operator=(OutputFile&&) noexcept;
    VOXTACT_API ~OutputFile();

    /// Returns the stream: classic locale, valid until close() or commit().
    [[nodiscard]] VOXTACT_API std::ostream& stream() noexcept;
    /// Flushes and closes the file. Fails with the system's reason, such as a full disk.
    [[nodiscard]] VOXTACT_API Result<void> close();
    /// Closes the file if open, and renames the temporary file to `path`.
    [[nodiscard]] VOXTACT_API Result<void> commit();
    /// Commits several files, all or none: if one fails, the earlier contents of the others are restored, or the error
    /// names their location. Writes to a device or a pipe cannot be undone.
    [[nodiscard]] VOXTACT_API static Result<void> commitAll(std::span<OutputFile* const> files);

    struct State;

  private:
    explicit OutputFile(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

/// Calls `write` with the stream of an OutputFile, and commits it on success.
VOXTACT_API Result<void> writeFile(const std::filesystem::path& path,
                                   const std::function<Result<void>(std::ostream&)>& write);

} // namespace voxtact::io
