// SPDX-License-Identifier: MIT
// Host data: checks, spaces, boxes, label maps, and what files and builtins give.
#include "c/convert.h"
#include "c/handles.h"
#include "voxtact/samples.h"

using namespace voxtact;
using namespace voxtact::c;

namespace {

std::vector<Box> toBoxes(const vxt_box* boxes, std::size_t count, const char* what) {
    std::vector<Box> out;
    for (const vxt_box& box : toSpan(boxes, count, what)) {
        out.push_back(toBox(box));
    }
    return out;
}

const char* noteOf(const std::vector<std::string>& notes, std::size_t index) noexcept {
    return index < notes.size() ? notes[index].c_str() : nullptr;
}

} // namespace

vxt_result vxt_check_volume(const vxt_volume_view* volume, vxt_range* range) {
    return call([&] { need(range, "range") = fromRange(take(checkVolume(toVolumeView(volume)))); });
}

vxt_result vxt_check_mesh(const vxt_mesh_view* mesh, vxt_mesh_facts* facts) {
    return call([&] { need(facts, "facts") = fromFacts(take(checkMesh(toMeshView(mesh)))); });
}

const char* vxt_scalar_type_name(vxt_scalar_type type) {
    return toString(number<ScalarType>(type));
}

vxt_result vxt_check_grid(const vxt_grid* grid) {
    return call([&] { static_cast<void>(checkedGrid(grid)); });
}

vxt_result vxt_check_affine(const double b_from_a[16]) {
    return call([&] { take(checkAffine(toMat4(b_from_a, "b_from_a"), "b_from_a")); });
}

vxt_result vxt_sample_table(const vxt_transfer_function_desc* desc, float* table, size_t room) {
    return call([&] {
        const std::vector<float> sampled = take(sampleTable(TransferFunctionOf(desc).desc()));
        if (room < sampled.size()) {
            refuse(ErrorCode::InvalidArgument, "table has room for " + std::to_string(room) + " entries, there are " +
                                                   std::to_string(sampled.size()));
        }
        std::copy(sampled.begin(), sampled.end(), &need(table, "table"));
    });
}

vxt_result vxt_check_opacity(const vxt_transfer_function_desc* desc, const vxt_range* data, double threshold,
                             vxt_opacity_facts* facts) {
    return call([&] {
        const vxt_range& values = need(data, "data");
        vxt_opacity_facts& out = need(facts, "facts");
        const OpacityFacts found = take(checkOpacity(TransferFunctionOf(desc).desc(), toRange(values), threshold));
        out = {found.moved, found.reaches ? 1U : 0U, found.any ? 1U : 0U};
    });
}

vxt_result vxt_world_from_index(const vxt_grid* grid, double world_from_index[16]) {
    return call([&] { writeMat4(world_from_index, worldFromIndex(checkedGrid(grid)), "world_from_index"); });
}

vxt_result vxt_world_from_texture(const vxt_grid* grid, double world_from_texture[16]) {
    return call([&] { writeMat4(world_from_texture, worldFromTexture(checkedGrid(grid)), "world_from_texture"); });
}

vxt_result vxt_texture_from_world(const vxt_grid* grid, double texture_from_world[16]) {
    return call([&] {
        writeMat4(texture_from_world, take(textureFromWorld(toGrid(need(grid, "grid")))), "texture_from_world");
    });
}

vxt_result vxt_ball_voxels(const vxt_grid* grid, const double centre[3], double radius, vxt_voxel_box* box) {
    return call([&] {
        const VoxelBox found = take(voxelBounds(toBall(centre, radius), checkedGrid(grid)));
        vxt_voxel_box& out = need(box, "box");
        std::copy(found.first.begin(), found.first.end(), out.first);
        std::copy(found.size.begin(), found.size.end(), out.size);
    });
}

vxt_result vxt_framing_view(const vxt_grid* grid, uint32_t width, uint32_t height, vxt_view* view) {
    return call([&] {
        const Grid checked = checkedGrid(grid);
        vxt_view& out = need(view, "view");
        checkPixels(width, height);
        writeMat4(out.clip_from_world, framingCamera(checked, width, height), "view");
        out.width = width;
        out.height = height;
    });
}

vxt_result vxt_inverse(const double b_from_a[16], double a_from_b[16]) {
    return call([&] { writeMat4(a_from_b, take(inverse(toMat4(b_from_a, "b_from_a"))), "a_from_b"); });
}

vxt_result vxt_side_view(const double clip_from_world[16], double side_from_world[16]) {
    return call(
        [&] { writeMat4(side_from_world, sideView(toMat4(clip_from_world, "clip_from_world")), "side_from_world"); });
}

vxt_result vxt_multiply(const double c_from_b[16], const double b_from_a[16], double c_from_a[16]) {
    return call(
        [&] { writeMat4(c_from_a, multiply(toMat4(c_from_b, "c_from_b"), toMat4(b_from_a, "b_from_a")), "c_from_a"); });
}

vxt_result vxt_transform_point(const double b_from_a[16], const double point[3], double transformed[3]) {
    return call([&] {
        writeVec3(transformed, transformPoint(toMat4(b_from_a, "b_from_a"), toVec3(point, "point")), "transformed");
    });
}

vxt_result vxt_transform_box(const double b_from_a[16], const vxt_box* box, vxt_box* transformed) {
    return call([&] {
        const Box out = transformBox(toMat4(b_from_a, "b_from_a"), toBox(need(box, "box")));
        need(transformed, "transformed") = fromBox(out);
    });
}

vxt_result vxt_boxes_at(const double* world_from_object, size_t count, const vxt_box* box, vxt_box* boxes) {
    return call([&] {
        const std::span<const Mat4> poses = toPoses(world_from_object, count, "world_from_object");
        const Box of = toBox(need(box, "box"));
        if (!poses.empty()) {
            std::ranges::transform(poses, &need(boxes, "boxes"),
                                   [&](const Mat4& pose) { return fromBox(transformBox(pose, of)); });
        }
    });
}

vxt_result vxt_overlapping_pairs(const vxt_box* left, size_t left_count, const vxt_box* right, size_t right_count,
                                 vxt_box_pairs** pairs) {
    return create(pairs, [&] {
        const std::vector<Box> boxes = toBoxes(left, left_count, "left");
        const std::vector<BoxPair> found =
            take(right == nullptr && right_count == 0 ? overlappingPairs(boxes)
                                                      : overlappingPairs(boxes, toBoxes(right, right_count, "right")));
        std::vector<vxt_box_pair> out;
        out.reserve(found.size());
        for (const BoxPair& pair : found) {
            out.push_back({pair.first, pair.second});
        }
        return out;
    });
}

const vxt_box_pair* vxt_box_pairs_get(const vxt_box_pairs* pairs, size_t* count) {
    return handOut(pairs == nullptr ? std::span<const vxt_box_pair>() : pairs->object, count);
}

void vxt_box_pairs_destroy(vxt_box_pairs* pairs) {
    delete pairs;
}

vxt_result vxt_labels_create(const vxt_volume_view* volume, vxt_labels** labels) {
    return create(labels, [&] { return take(makeLabels(toVolumeView(volume))); });
}

vxt_result vxt_labels_on_grid(const vxt_labels* labels, const vxt_grid* volume, vxt_labels** on_grid) {
    return create(on_grid,
                  [&] { return take(labelsOnGrid(need(labels, "labels").object, toGrid(need(volume, "volume")))); });
}

const int32_t* vxt_labels_values(const vxt_labels* labels, size_t* count) {
    return handOut(labels == nullptr ? std::span<const std::int32_t>() : labels->object.values, count);
}

vxt_result vxt_labels_grid(const vxt_labels* labels, vxt_grid* grid) {
    return call([&] {
        const LabelData& data = need(labels, "labels").object;
        need(grid, "grid") = fromGrid(data.grid);
    });
}

vxt_result vxt_labels_at(const vxt_labels* labels, const double world[3], int32_t* label) {
    return call([&] {
        const LabelData& data = need(labels, "labels").object;
        need(label, "label") = data.values[labelAt(data, toVec3(world, "world"))];
    });
}

vxt_result vxt_labels_at_points(const vxt_labels* labels, const double* points, size_t count, int32_t* found) {
    return call([&] {
        const LabelData& data = need(labels, "labels").object;
        const std::span<const double> all = toSpan(points, times(count, 3, "points"), "points");
        for (std::size_t i = 0; i < count; ++i) {
            (&need(found, "found"))[i] = data.values[labelAt(data, toVec3(&all[3 * i], "points"))];
        }
    });
}

void vxt_labels_destroy(vxt_labels* labels) {
    delete labels;
}

vxt_result vxt_volume_data_view(const vxt_volume_data* data, vxt_volume_view* view) {
    return call([&] { writeStruct(view, fromVolumeView(need(data, "data").object.view()), "view"); });
}

const char* vxt_volume_data_name(const vxt_volume_data* data) {
    return data == nullptr ? "" : data->object.name.c_str();
}

const char* vxt_volume_data_note(const vxt_volume_data* data, size_t index) {
    return data == nullptr ? nullptr : noteOf(data->object.notes, index);
}

void vxt_volume_data_destroy(vxt_volume_data* data) {
    delete data;
}

vxt_result vxt_mesh_data_view(const vxt_mesh_data* data, vxt_mesh_view* view) {
    return call([&] { writeStruct(view, fromMeshView(need(data, "data").object.view()), "view"); });
}

const char* vxt_mesh_data_name(const vxt_mesh_data* data) {
    return data == nullptr ? "" : data->object.name.c_str();
}

const char* vxt_mesh_data_note(const vxt_mesh_data* data, size_t index) {
    return data == nullptr ? nullptr : noteOf(data->object.notes, index);
}

void vxt_mesh_data_destroy(vxt_mesh_data* data) {
    delete data;
}

const double* vxt_poses_get(const vxt_poses* poses, size_t* count) {
    const auto matrices = handOut(poses == nullptr ? std::span<const Mat4>() : poses->object, count);
    return matrices == nullptr ? nullptr : matrices->data();
}

void vxt_poses_destroy(vxt_poses* poses) {
    delete poses;
}

const vxt_control_point* vxt_control_points_get(const vxt_control_points* points, size_t* count) {
    return handOut(points == nullptr ? std::span<const vxt_control_point>() : points->object, count);
}

void vxt_control_points_destroy(vxt_control_points* points) {
    delete points;
}

vxt_result vxt_builtin_volume(const char* name, vxt_volume_data** data) {
    return create(data, [&] { return take(makeBuiltinVolume(&need(name, "name"))); });
}

vxt_result vxt_builtin_mesh(const char* name, vxt_mesh_data** data) {
    return create(data, [&] { return take(makeBuiltinMesh(&need(name, "name"))); });
}
