// SPDX-License-Identifier: MIT
#include "c/convert.h"

#include <limits>

namespace voxtact::c {
namespace {

static_assert(VXT_SCALAR_UINT8 == static_cast<int>(ScalarType::UInt8));
static_assert(VXT_SCALAR_INT16 == static_cast<int>(ScalarType::Int16));
static_assert(VXT_SCALAR_UINT16 == static_cast<int>(ScalarType::UInt16));
static_assert(VXT_SCALAR_FLOAT32 == static_cast<int>(ScalarType::Float32));

// No function has vxt_output in its type, so the record of the binary interface does not contain these numbers.
static_assert(VXT_OUTPUT_TRIANGLES == 1 && VXT_OUTPUT_CONTACTS == 2 && VXT_OUTPUT_BOUNDS == 4 &&
              VXT_OUTPUT_LABELS == 8);

// The comments of the headers repeat these numbers.
static_assert(kDefaultThreshold == 0.1 && kDefaultTableSize == 256 && kDefaultMaxDepth == 10);
static_assert(kDefaultResolution == 1.0 / 64 && kDefaultSamplesPerVoxel == 1);

} // namespace

std::size_t times(std::size_t count, std::size_t each, const char* what) {
    if (count > std::numeric_limits<std::size_t>::max() / sizeof(double) / each) {
        refuse(ErrorCode::InvalidArgument, std::string(what) + ": " + std::to_string(count) + " are too many");
    }
    return count * each;
}

Vec3 toVec3(const double* vector, const char* what) {
    const double* first = &need(vector, what);
    return {first[0], first[1], first[2]};
}

Grid toGrid(const vxt_grid& grid) {
    const auto isSet = [](double number) { return number != 0; };
    Grid out;
    std::copy_n(grid.size, 3, out.size.begin());
    std::copy_n(grid.origin, 3, out.origin.begin());
    if (std::ranges::any_of(grid.spacing, isSet)) {
        std::copy_n(grid.spacing, 3, out.spacing.begin());
    }
    if (std::ranges::any_of(grid.direction, isSet)) {
        std::copy_n(grid.direction, 9, out.direction.begin());
    }
    return out;
}

Grid checkedGrid(const vxt_grid* grid) {
    const Grid checked = toGrid(need(grid, "grid"));
    take(checkGrid(checked));
    return checked;
}

vxt_grid fromGrid(const Grid& grid) noexcept {
    vxt_grid out{};
    std::ranges::copy(grid.size, out.size);
    std::ranges::copy(grid.spacing, out.spacing);
    std::ranges::copy(grid.origin, out.origin);
    std::ranges::copy(grid.direction, out.direction);
    return out;
}

VolumeView toVolumeView(const vxt_volume_view* view) {
    const vxt_volume_view given = readStruct(view, zero<vxt_volume_view>(), "volume");
    return {toGrid(given.grid), number<ScalarType>(given.type), toBytes(given.voxels, given.bytes, "volume: voxels")};
}

vxt_volume_view fromVolumeView(const VolumeView& view) noexcept {
    vxt_volume_view out = zero<vxt_volume_view>();
    out.voxels = view.voxels.data();
    out.bytes = view.voxels.size();
    out.grid = fromGrid(view.grid);
    out.type = number<vxt_scalar_type>(view.type);
    return out;
}

MeshView toMeshView(const vxt_mesh_view* view) {
    const vxt_mesh_view given = readStruct(view, zero<vxt_mesh_view>(), "mesh");
    return {toSpan(given.positions, times(given.vertex_count, 3, "mesh: vertices"), "mesh: positions"),
            toSpan(given.indices, times(given.triangle_count, 3, "mesh: triangles"), "mesh: indices"),
            given.deflection};
}

vxt_mesh_view fromMeshView(const MeshView& view) noexcept {
    vxt_mesh_view out = zero<vxt_mesh_view>();
    out.positions = view.positions.data();
    out.vertex_count = view.positions.size() / 3;
    out.indices = view.indices.data();
    out.triangle_count = view.indices.size() / 3;
    out.deflection = view.deflection;
    return out;
}

vxt_mesh_facts fromFacts(const MeshFacts& facts) noexcept {
    return {fromBox(facts.bounds), facts.vertices, facts.triangles, facts.degenerate, facts.rounding, facts.deflection};
}

Box toBox(const vxt_box& box) noexcept {
    return {{box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]}};
}

vxt_box fromBox(const Box& box) noexcept {
    return {{box.lo[0], box.lo[1], box.lo[2]}, {box.hi[0], box.hi[1], box.hi[2]}};
}

VoxelBox toVoxelBox(const vxt_voxel_box* box) {
    const vxt_voxel_box& given = need(box, "box");
    return {{given.first[0], given.first[1], given.first[2]}, {given.size[0], given.size[1], given.size[2]}};
}

Ball toBall(const double* centre, double radius) {
    return {toVec3(centre, "centre"), radius};
}

ValueRange toRange(const vxt_range& range) noexcept {
    return {range.lo, range.hi};
}

vxt_range fromRange(const ValueRange& range) noexcept {
    return {range.lo, range.hi};
}

Mat4 toMat4(const double* matrix, const char* what) {
    Mat4 out;
    std::copy_n(&need(matrix, what), out.size(), out.begin());
    return out;
}

Colour toColour(const double (&colour)[3]) noexcept {
    return {colour[0], colour[1], colour[2]};
}

void checkPixels(std::uint32_t width, std::uint32_t height) {
    if (width == 0 || height == 0) {
        refuse(ErrorCode::InvalidArgument, "a view needs at least one pixel along each side");
    }
}

void writeMat4(double* out, const Mat4& matrix, const char* what) {
    std::ranges::copy(matrix, &need(out, what));
}

void writeVec3(double* out, const Vec3& vector, const char* what) {
    std::copy(vector.begin(), vector.end(), &need(out, what));
}

View toView(const vxt_view* view) noexcept {
    if (view == nullptr) {
        return {Mat4{}, 0, 0};
    }
    View out{{}, view->width, view->height};
    std::ranges::copy(view->clip_from_world, out.clip_from_world.begin());
    return out;
}

Outputs toOutputs(std::uint32_t outputs, double maxDepth) {
    constexpr std::uint32_t known = VXT_OUTPUT_TRIANGLES | VXT_OUTPUT_CONTACTS | VXT_OUTPUT_BOUNDS | VXT_OUTPUT_LABELS;
    if ((outputs & ~known) != 0) {
        refuse(ErrorCode::Unsupported,
               "outputs has bits that are none of vxt_output: " + std::to_string(outputs & ~known));
    }
    return {(outputs & VXT_OUTPUT_TRIANGLES) != 0, (outputs & VXT_OUTPUT_CONTACTS) != 0,
            (outputs & VXT_OUTPUT_BOUNDS) != 0, (outputs & VXT_OUTPUT_LABELS) != 0, maxDepth};
}

std::span<const Mat4> toPoses(const double* poses, std::size_t count, const char* what) {
    times(count, std::tuple_size_v<Mat4>, what);
    // An array of 16 doubles is laid out as 16 doubles.
    static_assert(sizeof(Mat4) == 16 * sizeof(double));
    return toSpan(reinterpret_cast<const Mat4*>(poses), count, what);
}

std::span<const std::byte> toBytes(const void* bytes, std::size_t count, const char* what) {
    return toSpan(static_cast<const std::byte*>(bytes), count, what);
}

TransferFunctionOf::TransferFunctionOf(const vxt_transfer_function_desc* given)
    : given_(readStruct(given, zero<vxt_transfer_function_desc>(), "transfer function")) {
    times(given_.point_count, 2, "transfer function: points");
    for (const vxt_control_point& point : toSpan(given_.points, given_.point_count, "transfer function: points")) {
        points_.push_back({point.value, point.opacity});
    }
}

TransferFunctionDesc TransferFunctionOf::desc() const noexcept {
    return {points_, toRange(given_.domain), orDefault(given_.table_size, kDefaultTableSize)};
}

} // namespace voxtact::c
