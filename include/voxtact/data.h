// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

/// Plain host data: spaces, images, transfer functions, triangle meshes. No Vulkan here.
///
/// Spaces. *object*: the mesh's own coordinates. *world*: millimetres, LPS (+x left, +y posterior, +z superior).
/// *index*: voxel numbers, voxel i's centre at i. *texture*: [0,1]^3 over the whole image, voxel i's centre at
/// (i+0.5)/n. *clip*: Vulkan's (y down, depth 0..1). A matrix `b_from_a` takes points of space a to space b.
namespace voxtact {

/// x, y, z; of which space, and whether a point or a direction, its name says.
using Vec3 = std::array<double, 3>;

/// 4x4 matrix, column-major: element (row r, column c) is at [4*c + r]; vectors are columns.
/// Double, because `texture_from_object` and `clip_from_object` are products that are rounded to float once.
using Mat4 = std::array<double, 16>;

/// The matrix that leaves every point where it is.
[[nodiscard]] VOXTACT_API Mat4 identity() noexcept;
/// The matrix that moves every point by `offset`.
[[nodiscard]] VOXTACT_API Mat4 translation(const Vec3& offset) noexcept;
/// c_from_a = multiply(c_from_b, b_from_a)
[[nodiscard]] VOXTACT_API Mat4 multiply(const Mat4& c_from_b, const Mat4& b_from_a) noexcept;
/// Fails when the matrix is singular or not finite. Any 4x4 matrix, projective ones too; of an affine one exactly
/// affine.
[[nodiscard]] VOXTACT_API Result<Mat4> inverse(const Mat4& b_from_a);
/// The image of a point, divided by its w.
[[nodiscard]] VOXTACT_API Vec3 transformPoint(const Mat4& b_from_a, const Vec3& point) noexcept;
/// Widens a column-major float matrix, which is what most engines hold.
[[nodiscard]] VOXTACT_API Mat4 fromFloats(const float (&columnMajor)[16]) noexcept;

/// Millimetres between voxels, from a picometre to a million kilometres: nothing that a mesh can meet lies beyond.
inline constexpr double kMinSpacing = 1e-9;
inline constexpr double kMaxSpacing = 1e12; ///< also of an origin's coordinates, in either direction

/// Where the voxels of an image are. `direction` holds three columns, the unit vectors (LPS) along the index axes:
/// component r of axis c is at [3*c + r], as in ITK's direction matrix. It may be oblique; it must not be singular.
struct Grid {
    std::array<std::uint32_t, 3> size{}; ///< voxels along x, y, z; each at least 1
    Vec3 spacing{1, 1, 1};               ///< mm; from kMinSpacing to kMaxSpacing
    Vec3 origin{};                       ///< mm, within kMaxSpacing; the *centre* of voxel (0,0,0)
    std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1}; ///< columns: unit vectors along the index axes
};

/// Refuses an empty grid, one of more than 2^56 voxels, a spacing outside [kMinSpacing, kMaxSpacing], by itself or
/// times the length of its direction, an origin farther off than kMaxSpacing, a singular or non-finite direction.
[[nodiscard]] VOXTACT_API Result<void> checkGrid(const Grid& grid);
/// From texture space to the world. Expects a grid that checkGrid() accepts.
[[nodiscard]] VOXTACT_API Mat4 worldFromTexture(const Grid& grid) noexcept;
/// From index space to the world. Expects a grid that checkGrid() accepts.
[[nodiscard]] VOXTACT_API Mat4 worldFromIndex(const Grid& grid) noexcept;
/// The inverse of worldFromTexture(). Refuses what checkGrid() refuses.
[[nodiscard]] VOXTACT_API Result<Mat4> textureFromWorld(const Grid& grid);
/// Voxels of the whole grid.
[[nodiscard]] VOXTACT_API std::uint64_t voxelCount(const Grid& grid) noexcept;

/// How a voxel is stored. The number is the image's own unit (HU for CT): there is no other scale behind it.
enum class ScalarType : std::uint32_t { UInt8, Int16, UInt16, Float32 };

/// 1, 2 or 4.
[[nodiscard]] VOXTACT_API std::size_t bytesPerVoxel(ScalarType type) noexcept;
/// "uint8", "int16", "uint16" or "float"; static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(ScalarType type) noexcept;

/// An image somebody else owns. `voxels` holds voxelCount(grid) scalars of `type`, x fastest, then y, then z, without
/// padding, in the machine's byte order, aligned to their size.
struct VolumeView {
    Grid grid;                           ///< where the voxels are
    ScalarType type = ScalarType::UInt8; ///< of each voxel
    std::span<const std::byte> voxels;   ///< x fastest
};

/// An image that owns its voxels.
struct VolumeData {
    Grid grid;                           ///< where the voxels are
    ScalarType type = ScalarType::UInt8; ///< of each voxel
    std::vector<std::byte> voxels;       ///< as in VolumeView
    std::string name;                    ///< the file's name, or the builtin's
    std::vector<std::string> notes;      ///< what the reader did that the user may want to know, a line each

    /// Of these voxels; valid as long as they are.
    [[nodiscard]] VolumeView view() const noexcept { return {grid, type, voxels}; }
};

/// A closed interval of scalars in the image's own units.
struct ValueRange {
    double lo = 0; ///< the least
    double hi = 0; ///< the greatest
};

/// Refuses what checkGrid() refuses, a span of the wrong length, and NaN or infinite voxels (the first is named).
/// Returns the smallest and largest voxel. O(voxels).
[[nodiscard]] VOXTACT_API Result<ValueRange> checkVolume(const VolumeView& volume);

/// A corner of the piecewise linear transfer function.
struct ControlPoint {
    double value = 0;   ///< in the image's own units
    double opacity = 0; ///< 0..1
};

using Colour = std::array<double, 3>; ///< red, green, blue; 0..1

/// A corner of the piecewise linear colours that pictures have.
struct ColourPoint {
    double value = 0;       ///< in the image's own units
    Colour colour{1, 1, 1}; ///< at that value
};

/// Entries of a transfer function's table, where nothing else is asked for.
inline constexpr std::uint32_t kDefaultTableSize = 256;
/// Entries of a table, at most: floats do not tell more apart.
inline constexpr std::uint32_t kMaxTableSize = 1U << 24U;
inline constexpr double kDefaultThreshold = 0.1; ///< opacity from which a sample is opaque (paper, section 5)

/// Value -> opacity. Certified questions are decided by the points themselves: a value is opaque if its opacity reaches
/// the threshold, and at a step (points of equal value) the greatest opacity counts.
///
/// For the other projections and for pictures the function is sampled into a table: entry i of `tableSize` holds the
/// opacity at the normalised scalar s = (i+0.5)/tableSize, where s = (value - domain.lo) / (domain.hi - domain.lo).
/// Between entries: linear. Outside the domain: the first and the last entry. The look-up coordinate is s itself.
struct TransferFunctionDesc {
    std::span<const ControlPoint> points{}; ///< ascending values; piecewise linear between, constant outside
    /// Of the table; lo < hi, and hi - lo finite. {0, 0}: tableDomain().
    ValueRange domain{0, 0};
    std::uint32_t tableSize = kDefaultTableSize; ///< entries; 2 to kMaxTableSize
};

/// Returns the domain of the table: the given one, or one whose first and last entry are at the first and the last
/// point; around a single value 1/4096 of it to both sides.
[[nodiscard]] VOXTACT_API ValueRange tableDomain(const TransferFunctionDesc& desc) noexcept;

/// Refuses no points, values not finite or not ascending (equal ones make a step) or too far apart for a difference,
/// opacities outside [0,1], a domain empty or too wide, a table of fewer than 2 entries, and one of more than
/// kMaxTableSize (LimitExceeded). Returns the table.
[[nodiscard]] VOXTACT_API Result<std::vector<float>> sampleTable(const TransferFunctionDesc& desc);

/// What a threshold makes of a transfer function and of the values of a volume. Where nothing is opaque nothing
/// touches, which is a true answer to what was hardly meant.
struct OpacityFacts {
    bool reaches = false; ///< some values are opaque
    bool any = false;     ///< some value of the data is
    /// How far the table moves an end of the opaque values that is among the data, in the image's units; infinity where
    /// its entries pass over all of an interval. Only projections that are not certified look at the table.
    double moved = 0;
};
/// `data`: the least and the largest value, as checkVolume() returns them. Refuses what sampleTable() refuses, data
/// that are empty or NaN, and a threshold outside [0,1]. O(points + entries log(points)).
[[nodiscard]] VOXTACT_API Result<OpacityFacts> checkOpacity(const TransferFunctionDesc& desc, const ValueRange& data,
                                                            double threshold = kDefaultThreshold);

/// mm: default of the deflection with which curved surfaces are triangulated.
inline constexpr double kDefaultDeflection = 0.01;

/// A triangle mesh somebody else owns, in object space. Three doubles per vertex, three indices per triangle.
struct MeshView {
    std::span<const double> positions;      ///< x, y, z of each vertex, object space
    std::span<const std::uint32_t> indices; ///< three per triangle
    /// Object units: no point of the curved surface that the triangles stand for is farther from them. cpu::HostEngine
    /// answers Touch with *no* only where that surface does not touch; all other answers are about the triangles.
    double deflection = 0;
};

/// A triangle mesh that owns its arrays.
struct MeshData {
    std::vector<double> positions;      ///< x, y, z of each vertex, object space
    std::vector<std::uint32_t> indices; ///< three a triangle
    std::string name;                   ///< the file's name, or the builtin's
    std::vector<std::string> notes;     ///< as in VolumeData
    double deflection = 0;              ///< as in MeshView

    /// Of these arrays; valid as long as they are.
    [[nodiscard]] MeshView view() const noexcept { return {positions, indices, deflection}; }
};

/// An axis-aligned box.
struct Box {
    Vec3 lo{}; ///< least coordinates
    Vec3 hi{}; ///< greatest coordinates
};

/// What checkMesh() finds out on its way.
struct MeshFacts {
    std::uint32_t vertices = 0;   ///< how many
    std::uint32_t triangles = 0;  ///< how many, degenerate ones included
    std::uint32_t degenerate = 0; ///< triangles whose area is zero in float: allowed, no pixel of a view is theirs
    Box bounds;                   ///< object space
    /// Object units: the largest distance between a vertex and the floats that the engines keep of it. These are
    /// relative to a centre of the mesh's own where it is far from the origin and floats would lose something.
    /// Certified answers hold for the vertices as they were given.
    double rounding = 0;
    double deflection = 0; ///< MeshView::deflection
};

/// Object units, a hundred nanometres at a scale of 1: a larger MeshFacts::rounding is worth a note.
inline constexpr double kNotedRounding = 1e-4;

/// Refuses a mesh with no triangle, a deflection that is negative or not finite, arrays whose length is not a multiple
/// of three, vertices that are NaN, infinite or beyond the range of floats, and indices out of range (the first is
/// named). O(vertices + triangles).
[[nodiscard]] VOXTACT_API Result<MeshFacts> checkMesh(const MeshView& mesh);

/// The camera of the projections `view` and `two-view`.
struct View {
    Mat4 clip_from_world{};     ///< Vulkan clip space; orthographic or perspective; not singular
    std::uint32_t width = 512;  ///< pixels; at least 1, at most what the method can do: Context::maxViewport()
    std::uint32_t height = 512; ///< pixels, likewise
};

/// An orthographic view along world -z (from above, anterior up: world x runs to the left, y down) whose square
/// pixels frame the box of the volume, with a margin of 1 %.
[[nodiscard]] VOXTACT_API Mat4 framingCamera(const Grid& grid, std::uint32_t width, std::uint32_t height) noexcept;

/// The second camera of the projection `two-view`: the view volume of the first one, seen along its x axis. With the
/// first one's clip coordinates x, y, z, w it has 2z - w, y, (x + w) / 2, w: what was depth runs to the right, what ran
/// to the right is depth, and no point enters or leaves the view volume. Orthographic or perspective.
[[nodiscard]] VOXTACT_API Mat4 sideView(const Mat4& clip_from_world) noexcept;

/// Refuses NaN or infinite elements and a last row other than 0 0 0 1. `what` begins the error text ("pose 3").
[[nodiscard]] VOXTACT_API Result<void> checkAffine(const Mat4& matrix, const std::string& what);

/// A box of voxels.
struct VoxelBox {
    std::array<std::uint32_t, 3> first{}; ///< the lowest corner
    std::array<std::uint32_t, 3> size{};  ///< voxels along each axis; 0: empty
};

/// The voxels whose centre is at most a distance (mm) from a point, by exact arithmetic on these and the grid.
struct Ball {
    Vec3 centre{};     ///< world, mm
    double radius = 0; ///< mm; not negative
};

/// What an edit changes.
using VoxelRegion = std::variant<VoxelBox, Ball>;

/// The least box with all voxels of a region that lie in the grid; a Ball may reach over the grid's faces and be empty.
/// Refuses a VoxelBox that leaves the grid, and a Ball that is not finite or has a negative radius.
[[nodiscard]] VOXTACT_API Result<VoxelBox> voxelBounds(const VoxelRegion& region, const Grid& grid);

/// A label map: which structure each voxel belongs to. Looked up at the nearest voxel, never interpolated; outside of
/// the map's own grid the label is 0.
struct LabelData {
    Grid grid;                          ///< where its voxels are
    std::vector<std::uint16_t> indices; ///< of each voxel, x fastest: the number of its label in `values`
    std::vector<std::int32_t> values;   ///< the labels, ascending, each once; 0 is always among them
};

/// Refuses what checkVolume() refuses, float voxels that are not whole numbers within +-2^24, and more than 65536
/// different labels (LimitExceeded). O(voxels + the labels' range).
[[nodiscard]] VOXTACT_API Result<LabelData> makeLabels(const VolumeView& volume);
/// The same of labels of any 32-bit size, x fastest. O(voxels). Refuses what checkGrid() refuses and another number of
/// labels than the grid has voxels.
[[nodiscard]] VOXTACT_API Result<LabelData> makeLabels(const Grid& grid, std::span<const std::int32_t> labels);

/// Number of the label of a world point in `values`; that of 0 outside of the grid. The voxel along an axis with n of
/// them is floor(n * texture coordinate): half way between two centres it is the upper one, and at 1 the last one.
/// Expects what makeLabels() returns.
[[nodiscard]] VOXTACT_API std::uint32_t labelAt(const LabelData& labels, const Vec3& world) noexcept;

/// Two boxes that overlap: their numbers, `first` < `second`.
struct BoxPair {
    std::uint32_t first = 0;  ///< number of a box in the first span
    std::uint32_t second = 0; ///< in the same span, or in the second one
    /// By `first`, then by `second`.
    // clang-tidy 14 takes the 0 that the compiler writes for a null pointer.
    auto operator<=>(const BoxPair&) const = default; // NOLINT(modernize-use-nullptr)
};

/// The broad phase: all pairs of closed boxes that share a point, sorted; touching counts. Sweep and prune along the
/// axis on which the centres vary most (Cohen et al., "I-COLLIDE", 1995, section 3). A box with a NaN or with
/// lo > hi overlaps nothing. O(n log n + overlaps along the axis).
[[nodiscard]] VOXTACT_API Result<std::vector<BoxPair>> overlappingPairs(std::span<const Box> boxes);

/// The same between two sets: `first` is a number in `left`, `second` one in `right`.
[[nodiscard]] VOXTACT_API Result<std::vector<BoxPair>> overlappingPairs(std::span<const Box> left,
                                                                        std::span<const Box> right);

/// The box of a box's eight corners under an affine matrix, rounded outward (what is exact stays exact): for the world
/// box of a mesh at a pose (world_from_object), or of a volume (world_from_texture of the box [0,1]^3). A box that
/// overlaps nothing, and a matrix that is not finite, give a box that overlaps nothing.
[[nodiscard]] VOXTACT_API Box transformBox(const Mat4& b_from_a, const Box& box) noexcept;

} // namespace voxtact
