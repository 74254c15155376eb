// SPDX-License-Identifier: MIT
// Files, of a library without voxtact::io: the functions are there, so that the interface is the same, and refuse.
#include "c/absent.h"

using namespace voxtact;
using namespace voxtact::c;

namespace {

constexpr const char* kNoFiles =
    "this library was built without voxtact::io and reads no files; build it with VOXTACT_BUILD_IO";

} // namespace

vxt_result vxt_read_volume(const char*, const vxt_volume_read_options*, vxt_volume_data** data) {
    return absent(kNoFiles, data);
}

vxt_result vxt_read_volume_bytes(const char*, const void*, size_t, const vxt_volume_read_options*,
                                 vxt_volume_data** data) {
    return absent(kNoFiles, data);
}

vxt_result vxt_write_volume(const char*, const vxt_volume_view*) {
    return absent(kNoFiles);
}

vxt_result vxt_read_mesh(const char*, const vxt_mesh_read_options*, vxt_mesh_data** data) {
    return absent(kNoFiles, data);
}

vxt_result vxt_read_mesh_bytes(const char*, const void*, size_t, const vxt_mesh_read_options*, vxt_mesh_data** data) {
    return absent(kNoFiles, data);
}

vxt_result vxt_write_mesh(const char*, const vxt_mesh_view*) {
    return absent(kNoFiles);
}

vxt_result vxt_grid_shear(const vxt_grid*, double*, double*) {
    return absent(kNoFiles);
}

const char* vxt_grid_note(const vxt_grid*) {
    return "";
}

const char* vxt_mesh_note(const vxt_mesh_facts*) {
    return "";
}

vxt_result vxt_read_camera(const char*, double[16]) {
    return absent(kNoFiles);
}

vxt_result vxt_read_poses(const char*, const char*, vxt_poses** poses) {
    return absent(kNoFiles, poses);
}

vxt_result vxt_pose_reader_open(const char*, const char*, vxt_pose_reader** reader) {
    return absent(kNoFiles, reader);
}

vxt_result vxt_pose_reader_read(vxt_pose_reader*, double*, size_t, size_t*) {
    return absent(kNoFiles);
}

void vxt_pose_reader_destroy(vxt_pose_reader*) {}

vxt_result vxt_read_colours(const char*, vxt_colour_points** points) {
    return absent(kNoFiles, points);
}

const vxt_colour_point* vxt_colour_points_get(const vxt_colour_points*, size_t*) {
    return nullptr;
}

void vxt_colour_points_destroy(vxt_colour_points*) {}

vxt_result vxt_write_png(const char*, uint32_t, uint32_t, const void*, size_t) {
    return absent(kNoFiles);
}

vxt_result vxt_read_transfer_function(const char*, vxt_control_points** points) {
    return absent(kNoFiles, points);
}

vxt_result vxt_parse_opacity(const char*, vxt_control_points** points) {
    return absent(kNoFiles, points);
}

vxt_result vxt_read_label_names(const char*, vxt_label_names** names) {
    return absent(kNoFiles, names);
}

const char* vxt_label_names_get(const vxt_label_names*, size_t, int32_t*) {
    return nullptr;
}

void vxt_label_names_destroy(vxt_label_names*) {}

vxt_result vxt_read_points(const char*, vxt_points** points) {
    return absent(kNoFiles, points);
}

const char* vxt_points_get(const vxt_points*, size_t, double*, uint64_t*) {
    return nullptr;
}

void vxt_points_destroy(vxt_points*) {}
