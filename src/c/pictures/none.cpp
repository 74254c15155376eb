// SPDX-License-Identifier: MIT
// Pictures, of a library without voxtact::render: the functions are there, so that the interface is the same, and
// refuse.
#include "c/absent.h"
#include "voxtact/voxtact_vulkan.h"

#include <algorithm>

using namespace voxtact;
using namespace voxtact::c;

namespace {

constexpr const char* kNoPictures =
    "this library was built without voxtact::render and makes no pictures; build it with VOXTACT_BUILD_RENDER";

/// Returns no array, and count 0.
template <class T> const T* none(std::size_t* count) noexcept {
    if (count != nullptr) {
        *count = 0;
    }
    return nullptr;
}

} // namespace

const char* vxt_look_name(size_t) {
    return nullptr;
}

vxt_result vxt_look_create(const char*, const vxt_range*, vxt_look** look) {
    return absent(kNoPictures, look);
}

const vxt_control_point* vxt_look_opacity(const vxt_look*, size_t* count) {
    return none<vxt_control_point>(count);
}

const vxt_colour_point* vxt_look_colours(const vxt_look*, size_t* count) {
    return none<vxt_colour_point>(count);
}

void vxt_look_destroy(vxt_look*) {}

vxt_result vxt_direction_named(const char*, vxt_view_direction*) {
    return absent(kNoPictures);
}

vxt_result vxt_view_from(const vxt_view_direction*, const vxt_grid*, const vxt_box*, uint32_t, uint32_t, vxt_view*) {
    return absent(kNoPictures);
}

vxt_result vxt_clip_side(const char*, const double*, const vxt_grid*, const vxt_view_direction*, vxt_clip_plane*) {
    return absent(kNoPictures);
}

vxt_result vxt_lighting_named(const char*, const vxt_grid*, vxt_lighting*) {
    return absent(kNoPictures);
}

void vxt_mesh_colour(size_t, double colour[3]) {
    if (colour != nullptr) {
        std::fill_n(colour, 3, 0);
    }
}

void vxt_plain_colour(double colour[3]) {
    if (colour != nullptr) {
        std::fill_n(colour, 3, 0);
    }
}

double vxt_paint_through(vxt_paint) {
    return 0;
}

vxt_result vxt_split_at_creases(const vxt_mesh_view*, double, vxt_mesh_data** data) {
    return absent(kNoPictures, data);
}

vxt_result vxt_renderer_create(const vxt_context*, VkFormat, vxt_renderer** renderer) {
    return absent(kNoPictures, renderer);
}

void vxt_renderer_destroy(vxt_renderer*) {}

vxt_result vxt_render_function_create(const vxt_renderer*, const vxt_render_function_desc*,
                                      vxt_render_function** function) {
    return absent(kNoPictures, function);
}

vxt_result vxt_render_function_upload(const vxt_renderer*, const vxt_queue*, const vxt_render_function_desc*,
                                      vxt_render_function** function) {
    return absent(kNoPictures, function);
}

vxt_result vxt_render_function_cmd_upload(vxt_render_function*, VkCommandBuffer) {
    return absent(kNoPictures);
}

vxt_result vxt_render_function_cmd_update(vxt_render_function*, VkCommandBuffer, const vxt_render_function_desc*) {
    return absent(kNoPictures);
}

uint32_t vxt_render_function_visible(const vxt_render_function*) {
    return 0;
}

void vxt_render_function_destroy(vxt_render_function*) {}

vxt_result vxt_mesh_normals_create(const vxt_renderer*, const vxt_mesh_view*, vxt_mesh_normals** normals) {
    return absent(kNoPictures, normals);
}

vxt_result vxt_mesh_normals_upload(const vxt_renderer*, const vxt_queue*, const vxt_mesh_view*,
                                   vxt_mesh_normals** normals) {
    return absent(kNoPictures, normals);
}

vxt_result vxt_mesh_normals_cmd_upload(vxt_mesh_normals*, VkCommandBuffer) {
    return absent(kNoPictures);
}

vxt_result vxt_mesh_normals_cmd_update(vxt_mesh_normals*, VkCommandBuffer, const vxt_mesh_view*) {
    return absent(kNoPictures);
}

void vxt_mesh_normals_release_staging(vxt_mesh_normals*) {}

void vxt_mesh_normals_destroy(vxt_mesh_normals*) {}

vxt_result vxt_render_bricks_create(const vxt_renderer*, const vxt_volume*, vxt_render_bricks** bricks) {
    return absent(kNoPictures, bricks);
}

void vxt_render_bricks_destroy(vxt_render_bricks*) {}

vxt_result vxt_painted_triangles_create(const vxt_renderer*, uint32_t, const uint32_t*, size_t,
                                        vxt_painted_triangles** painted) {
    return absent(kNoPictures, painted);
}

vxt_result vxt_painted_triangles_upload(const vxt_renderer*, const vxt_queue*, uint32_t, const uint32_t*, size_t,
                                        vxt_painted_triangles** painted) {
    return absent(kNoPictures, painted);
}

vxt_result vxt_painted_triangles_wrap(const vxt_renderer*, const vxt_buffer_range*, vxt_painted_triangles** painted) {
    return absent(kNoPictures, painted);
}

vxt_result vxt_painted_triangles_cmd_upload(vxt_painted_triangles*, VkCommandBuffer) {
    return absent(kNoPictures);
}

void vxt_painted_triangles_release_staging(vxt_painted_triangles*) {}

void vxt_painted_triangles_destroy(vxt_painted_triangles*) {}

vxt_result vxt_painted_vertices_create(const vxt_renderer*, const double*, size_t, vxt_painted_vertices** painted) {
    return absent(kNoPictures, painted);
}

vxt_result vxt_painted_vertices_upload(const vxt_renderer*, const vxt_queue*, const double*, size_t,
                                       vxt_painted_vertices** painted) {
    return absent(kNoPictures, painted);
}

vxt_result vxt_painted_vertices_wrap(const vxt_renderer*, const vxt_buffer_range*, vxt_painted_vertices** painted) {
    return absent(kNoPictures, painted);
}

vxt_result vxt_painted_vertices_cmd_upload(vxt_painted_vertices*, VkCommandBuffer) {
    return absent(kNoPictures);
}

void vxt_painted_vertices_release_staging(vxt_painted_vertices*) {}

void vxt_painted_vertices_destroy(vxt_painted_vertices*) {}

vxt_result vxt_render_targets_create(const vxt_renderer*, uint32_t, uint32_t, vxt_render_targets** targets) {
    return absent(kNoPictures, targets);
}

void vxt_render_targets_destroy(vxt_render_targets*) {}

vxt_result vxt_renderer_cmd_render(const vxt_renderer*, VkCommandBuffer, const vxt_picture_scene*,
                                   const vxt_picture_target*) {
    return absent(kNoPictures);
}

vxt_result vxt_picture_create(vxt_picture** picture) {
    return absent(kNoPictures, picture);
}

vxt_result vxt_picture_get(const vxt_picture*, vxt_picture_view*) {
    return absent(kNoPictures);
}

void vxt_picture_destroy(vxt_picture*) {}

vxt_result vxt_blocking_renderer_create(const vxt_context*, const vxt_queue*, vxt_blocking_renderer** renderer) {
    return absent(kNoPictures, renderer);
}

const vxt_renderer* vxt_blocking_renderer_renderer(const vxt_blocking_renderer*) {
    return nullptr;
}

vxt_result vxt_blocking_renderer_render(vxt_blocking_renderer*, const vxt_picture_scene*, uint32_t, uint32_t,
                                        vxt_picture_progress, void*, vxt_picture*) {
    return absent(kNoPictures);
}

void vxt_blocking_renderer_destroy(vxt_blocking_renderer*) {}
