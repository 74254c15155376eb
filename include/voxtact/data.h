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

/// Plain host data: spaces, images, transfer functions, triangle meshes. No Vulkan.
///
/// Spaces. *object*: the mesh's own coordinates. *world*: millimetres, LPS (+x left, +y posterior, +z superior).
/// *index*: voxel indices; the centre of voxel i is at i. *texture*: [0,1]^3 over the whole image; the centre of voxel
/// i is at (i+0.5)/n. *clip*: Vulkan's clip space (y down, depth 0..1). A matrix `b_from_a` maps points of space a to
/// space b.
namespace voxtact {

/// x, y, z. The name of the variable states the space, and whether it is a point or a direction.
using Vec3 = std::array<double, 3>;

/// 4x4 matrix, column-major: element (row r, column c) is at [4*c + r]; vectors are columns. Double precision, because
/// `texture_from_object` and `clip_from_object` are products that are rounded to float once.
using Mat4 = std::array<double, 16>;

/// Returns the identity matrix.
[[nodiscard]] VOXTACT_API Mat4 identity() noexcept;
/// Returns the translation by `offset`.
[[nodiscard]] VOXTACT_API Mat4 translation(const Vec3& offset) noexcept;
/// Returns the product: c_from_a = multiply(c_from_b, b_from_a).
[[nodiscard]] VOXTACT_API Mat4 multiply(const Mat4& c_from_b, const Mat4& b_from_a) noexcept;
/// Inverts any 4x4 matrix, also a projective one. The inverse of an affine matrix is exactly affine. Fails if the
/// matrix is singular or not finite.
[[nodiscard]] VOXTACT_API Result<Mat4> inverse(const Mat4& b_from_a);
/// Transforms a point and divides by its w.
[[nodiscard]] VOXTACT_API Vec3 transformPoint(const Mat4& b_from_a, const Vec3& point) noexcept;
/// Converts a column-major float matrix, the layout of most engines, to doubles.
[[nodiscard]] VOXTACT_API Mat4 fromFloats(const float (&columnMajor)[16]) noexcept;

/// Range of spacings, mm: from a picometre to a million kilometres.
inline constexpr double kMinSpacing = 1e-9;
inline constexpr double kMaxSpacing = 1e12; ///< also the maximum magnitude of an origin's coordinates

/// Position of an image's voxels in the world. `direction` has three columns, the unit vectors (LPS) along the index
/// axes: component r of axis c is at [3*c + r], as in ITK's direction matrix. Axes may be oblique, but not singular.
struct Grid {
    std::array<std::uint32_t, 3> size{}; ///< voxels along x, y, z; each at least 1
    Vec3 spacing{1, 1, 1};               ///< mm; from kMinSpacing to kMaxSpacing
    Vec3 origin{};                       ///< mm, within kMaxSpacing; the *centre* of voxel (0,0,0)
    std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1}; ///< columns: unit vectors along the index axes
};

/// Refuses an empty grid, more than 2^56 voxels, an origin beyond kMaxSpacing, and a singular or non-finite direction.
/// Refuses a spacing outside [kMinSpacing, kMaxSpacing], also multiplied by the length of its direction.
[[nodiscard]] VOXTACT_API Result<void> checkGrid(const Grid& grid);
/// Returns the matrix from texture space to the world. Expects a grid that checkGrid() accepts.
[[nodiscard]] VOXTACT_API Mat4 worldFromTexture(const Grid& grid) noexcept;
/// Returns the matrix from index space to the world. Expects a grid that checkGrid() accepts.
[[nodiscard]] VOXTACT_API Mat4 worldFromIndex(const Grid& grid) noexcept;
/// Returns the inverse of worldFromTexture(). Refuses grids that checkGrid() refuses.
[[nodiscard]] VOXTACT_API Result<Mat4> textureFromWorld(const Grid& grid);
/// Returns the number of voxels.
[[nodiscard]] VOXTACT_API std::uint64_t voxelCount(const Grid& grid) noexcept;

/// Storage type of a voxel. Values are in the image's own unit (HU for CT), without further scaling.
enum class ScalarType : std::uint32_t { UInt8, Int16, UInt16, Float32 };

/// Returns 1, 2 or 4.
[[nodiscard]] VOXTACT_API std::size_t bytesPerVoxel(ScalarType type) noexcept;
/// Returns "uint8", "int16", "uint16" or "float", with static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(ScalarType type) noexcept;

/// An image that the caller owns. `voxels` holds voxelCount(grid) scalars of `type`: x fastest, then y, then z, without
/// padding, in the machine's byte order, aligned to their size.
struct VolumeView {
    Grid grid;                           ///< position of the voxels
    ScalarType type = ScalarType::UInt8; ///< type of each voxel
    std::span<const std::byte> voxels;   ///< x fastest
};

/// An image that owns its voxels.
struct VolumeData {
    Grid grid;                           ///< position of the voxels
    ScalarType type = ScalarType::UInt8; ///< type of each voxel
    std::vector<std::byte> voxels;       ///< as in VolumeView
    std::string name;                    ///< name of the file or builtin
    std::vector<std::string> notes;      ///< notes of the reader for the user, one line each

    /// Returns a view of these voxels, valid as long as they are.
    [[nodiscard]] VolumeView view() const noexcept { return {grid, type, voxels}; }
};

/// A closed interval of scalars in the image's own units.
struct ValueRange {
    double lo = 0; ///< smallest value
    double hi = 0; ///< largest value
};

/// Returns the smallest and largest voxel. Refuses grids that checkGrid() refuses, a span of the wrong length, and NaN
/// or infinite voxels (the error names the first). O(voxels).
[[nodiscard]] VOXTACT_API Result<ValueRange> checkVolume(const VolumeView& volume);

/// A corner of the piecewise linear transfer function.
struct ControlPoint {
    double value = 0;   ///< in the image's own units
    double opacity = 0; ///< 0..1
};

using Colour = std::array<double, 3>; ///< red, green, blue; 0..1

/// A corner of the piecewise linear colours of pictures.
struct ColourPoint {
    double value = 0;       ///< in the image's own units
    Colour colour{1, 1, 1}; ///< colour at that value
};

/// Default number of entries in a transfer function's table.
inline constexpr std::uint32_t kDefaultTableSize = 256;
/// Maximum number of entries in a table: floats cannot distinguish more.
inline constexpr std::uint32_t kMaxTableSize = 1U << 24U;
inline constexpr double kDefaultThreshold = 0.1; ///< opacity from which a sample is opaque (paper, section 5)

/// Value -> opacity. Certified questions use the points themselves: a value is opaque if its opacity reaches the
/// threshold; at a step (points of equal value) the largest opacity counts.
///
/// The other projections and pictures sample the function into a table: entry i of `tableSize` holds the opacity at the
/// normalised scalar s = (i+0.5)/tableSize, where s = (value - domain.lo) / (domain.hi - domain.lo). Lookups at s
/// interpolate linearly between entries; outside the domain they return the first or last entry.
struct TransferFunctionDesc {
    std::span<const ControlPoint> points{}; ///< ascending values; piecewise linear between, constant outside
    /// Domain of the table; lo < hi, and hi - lo finite. {0, 0}: tableDomain().
    ValueRange domain{0, 0};
    std::uint32_t tableSize = kDefaultTableSize; ///< entries; 2 to kMaxTableSize
};

/// Returns the domain of the table: the given domain, or the domain whose first and last entries lie at the first and
/// last point. A single value is widened by 1/4096 of the value to both sides.
[[nodiscard]] VOXTACT_API ValueRange tableDomain(const TransferFunctionDesc& desc) noexcept;

/// Returns the table. Refuses an empty list of points; values that are not finite, not ascending (equal values make a
/// step) or whose difference overflows; opacities outside [0,1]; a domain that is empty or too wide; fewer than 2
/// entries, and more than kMaxTableSize (LimitExceeded).
[[nodiscard]] VOXTACT_API Result<std::vector<float>> sampleTable(const TransferFunctionDesc& desc);

/// Effect of a threshold on a transfer function and a volume's values. If nothing is opaque, nothing touches: a correct
/// answer, but rarely the intended one.
struct OpacityFacts {
    bool reaches = false; ///< some value is opaque
    bool any = false;     ///< some value of the data is opaque
    /// Largest error of the table at an end of an opaque interval within the data, in the image's units; infinity if
    /// the entries miss a whole interval. Only projections that are not certified use the table.
    double moved = 0;
};
/// Computes the facts of a transfer function. `data`: the smallest and largest value, as checkVolume() returns them.
/// Refuses descriptions that sampleTable() refuses, an empty or NaN range, and a threshold outside [0,1]. O(points +
/// entries log(points)).
[[nodiscard]] VOXTACT_API Result<OpacityFacts> checkOpacity(const TransferFunctionDesc& desc, const ValueRange& data,
                                                            double threshold = kDefaultThreshold);

/// Default deflection of the triangulation of curved surfaces, mm.
inline constexpr double kDefaultDeflection = 0.01;

/// A triangle mesh that the caller owns, in object space. Three doubles per vertex, three indices per triangle.
struct MeshView {
    std::span<const double> positions;      ///< x, y, z of each vertex, object space
    std::span<const std::uint32_t> indices; ///< three per triangle
    /// Maximum distance of the curved surface from the triangles that approximate it, object units. cpu::HostEngine
    /// answers Touch with *no* only if the curved surface does not touch; all other answers refer to the triangles.
    double deflection = 0;
};

/// A triangle mesh that owns its arrays.
struct MeshData {
    std::vector<double> positions;      ///< x, y, z of each vertex, object space
    std::vector<std::uint32_t> indices; ///< three per triangle
    std::string name;                   ///< name of the file or builtin
    std::vector<std::string> notes;     ///< as in VolumeData
    double deflection = 0;              ///< as in MeshView

    /// Returns a view of these arrays, valid as long as they are.
    [[nodiscard]] MeshView view() const noexcept { return {positions, indices, deflection}; }
};

/// An axis-aligned box.
struct Box {
    Vec3 lo{}; ///< smallest coordinates
    Vec3 hi{}; ///< largest coordinates
};

/// Facts of a mesh, as checkMesh() returns them.
struct MeshFacts {
    std::uint32_t vertices = 0;   ///< number of vertices
    std::uint32_t triangles = 0;  ///< number of triangles, degenerate ones included
    std::uint32_t degenerate = 0; ///< triangles whose area is zero in float: allowed; they cover no pixel of a view
    Box bounds;                   ///< object space
    /// Object units: the largest distance between a vertex and its float coordinates in the engines. For a mesh far
    /// from the origin the floats are relative to its centre. Certified answers hold for the given vertices.
    double rounding = 0;
    double deflection = 0; ///< MeshView::deflection
};

/// Object units: a larger MeshFacts::rounding gives a note. 100 nm at a scale of 1.
inline constexpr double kNotedRounding = 1e-4;

/// Returns the facts of a mesh. Refuses a mesh without a triangle, a deflection that is negative or not finite, and
/// arrays whose length is not a multiple of three. Refuses vertices that are NaN, infinite or beyond the range of
/// floats, and indices out of range; the error names the first. O(vertices + triangles).
[[nodiscard]] VOXTACT_API Result<MeshFacts> checkMesh(const MeshView& mesh);

/// The camera of the projections `view` and `two-view`.
struct View {
    Mat4 clip_from_world{};     ///< Vulkan clip space; orthographic or perspective; not singular
    std::uint32_t width = 512;  ///< pixels; from 1 to the maximum of the method: Context::maxViewport()
    std::uint32_t height = 512; ///< pixels, like `width`
};

/// Returns an orthographic view along world -z (from above, anterior up: world x runs to the left, y down). Its square
/// pixels frame the volume's box with a margin of 1 %.
[[nodiscard]] VOXTACT_API Mat4 framingCamera(const Grid& grid, std::uint32_t width, std::uint32_t height) noexcept;

/// Returns the second camera of the projection `two-view`: the view volume of the first one, seen along its x axis.
/// Maps the clip coordinates x, y, z, w of the first camera to 2z - w, y, (x + w) / 2, w: depth becomes x, x becomes
/// depth, and the view volume stays the same. Orthographic or perspective.
[[nodiscard]] VOXTACT_API Mat4 sideView(const Mat4& clip_from_world) noexcept;

/// Refuses NaN or infinite elements and a last row other than 0 0 0 1. `what` begins the error text ("pose 3").
[[nodiscard]] VOXTACT_API Result<void> checkAffine(const Mat4& matrix, const std::string& what);

/// A box of voxels.
struct VoxelBox {
    std::array<std::uint32_t, 3> first{}; ///< lowest corner
    std::array<std::uint32_t, 3> size{};  ///< voxels along each axis; 0: empty
};

/// The voxels whose centre is within a distance (mm) of a point, by exact arithmetic.
struct Ball {
    Vec3 centre{};     ///< world, mm
    double radius = 0; ///< mm; not negative
};

/// The voxels that an edit changes.
using VoxelRegion = std::variant<VoxelBox, Ball>;

/// Returns the smallest box that contains all voxels of a region within the grid. A Ball may extend beyond the grid and
/// be empty. Refuses a VoxelBox outside the grid, and a Ball that is not finite or has a negative radius.
[[nodiscard]] VOXTACT_API Result<VoxelBox> voxelBounds(const VoxelRegion& region, const Grid& grid);

/// A label map: the structure of each voxel. Lookups use the nearest voxel and never interpolate; outside the map's
/// grid the label is 0.
struct LabelData {
    Grid grid;                          ///< position of the voxels
    std::vector<std::uint16_t> indices; ///< index into `values` for each voxel, x fastest
    std::vector<std::int32_t> values;   ///< the labels, ascending, each once; includes 0
};

/// Creates a label map. Refuses volumes that checkVolume() refuses, float voxels that are not whole numbers within
/// +-2^24, and more than 65536 different labels (LimitExceeded). O(voxels + the labels' range).
[[nodiscard]] VOXTACT_API Result<LabelData> makeLabels(const VolumeView& volume);
/// Like makeLabels(VolumeView), for 32-bit labels, x fastest. O(voxels). Refuses grids that checkGrid() refuses, and a
/// number of labels other than the number of voxels.
[[nodiscard]] VOXTACT_API Result<LabelData> makeLabels(const Grid& grid, std::span<const std::int32_t> labels);

/// Extends a label map to a volume's grid, which must contain the map's grid: same directions and spacing, and an
/// offset of whole voxels, within 0.001 voxel. Voxels outside the map's grid get the label 0. Refuses other grids
/// (Unsupported). O(voxels).
[[nodiscard]] VOXTACT_API Result<LabelData> labelsOnGrid(const LabelData& labels, const Grid& volume);

/// Returns the index into `values` for a world point; outside the grid, the index of label 0. Along an axis of n
/// voxels, the voxel is floor(n * texture coordinate): at 1 the last one, and halfway between two centres the upper
/// one. Expects a map that makeLabels() returned.
[[nodiscard]] VOXTACT_API std::uint32_t labelAt(const LabelData& labels, const Vec3& world) noexcept;

/// Indices of two boxes that overlap, `first` < `second`.
struct BoxPair {
    std::uint32_t first = 0;  ///< index in the first span
    std::uint32_t second = 0; ///< index in the same span, or in the second one
    /// Orders by `first`, then by `second`.
    // clang-tidy 14 takes the 0 that the compiler writes for a null pointer.
    auto operator<=>(const BoxPair&) const = default; // NOLINT(modernize-use-nullptr)
};

/// Returns all pairs of closed boxes that share a point, sorted (broad phase). Uses sweep and prune along the axis on
/// which the centres vary most (Cohen et al., "I-COLLIDE", 1995, section 3). A box with a NaN or with lo > hi overlaps
/// nothing. O(n log n + overlaps along the axis).
[[nodiscard]] VOXTACT_API Result<std::vector<BoxPair>> overlappingPairs(std::span<const Box> boxes);

/// Like overlappingPairs(boxes), between two sets: `first` is an index in `left`, `second` an index in `right`.
[[nodiscard]] VOXTACT_API Result<std::vector<BoxPair>> overlappingPairs(std::span<const Box> left,
                                                                        std::span<const Box> right);

/// Returns the bounding box of the box's eight corners under an affine matrix, rounded outward; exact coordinates stay
/// exact. Gives the world box of a mesh at a pose (world_from_object), or of a volume (world_from_texture, box
/// [0,1]^3). A box that overlaps nothing, or a matrix that is not finite, gives a box that overlaps nothing.
[[nodiscard]] VOXTACT_API Box transformBox(const Mat4& b_from_a, const Box& box) noexcept;

} // namespace voxtact
