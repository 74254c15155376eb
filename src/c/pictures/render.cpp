// SPDX-License-Identifier: MIT
// What pictures are made of.
#include "c/convert_vulkan.h"
#include "c/pictures/handles.h"

using namespace voxtact;
using namespace voxtact::c;

namespace {

// The comments of voxtact_vulkan.h repeat these numbers.
static_assert(RenderTransferFunctionDesc{}.opacityUnit == 1 && RenderTransferFunctionDesc{}.step == 0.5);

/// A RenderTransferFunctionDesc with the points that it references.
class RenderFunctionOf {
  public:
    explicit RenderFunctionOf(const vxt_render_function_desc* given)
        : given_(readStruct(given, zero<vxt_render_function_desc>(), "transfer function")) {
        for (const vxt_control_point& point : toSpan(given_.points, given_.point_count, "transfer function: points")) {
            points_.push_back({point.value, point.opacity});
        }
        for (const vxt_colour_point& point :
             toSpan(given_.colours, given_.colour_count, "transfer function: colours")) {
            colours_.push_back({point.value, toColour(point.colour)});
        }
    }
    [[nodiscard]] RenderTransferFunctionDesc desc() const noexcept {
        constexpr RenderTransferFunctionDesc kDefaults;
        return {.opacity = {points_, toRange(given_.domain), orDefault(given_.table_size, kDefaultTableSize)},
                .colours = colours_,
                .opacityUnit = orDefault(given_.opacity_unit, kDefaults.opacityUnit),
                .step = orDefault(given_.step, kDefaults.step)};
    }

  private:
    vxt_render_function_desc given_;
    std::vector<ControlPoint> points_;
    std::vector<ColourPoint> colours_;
};

/// `colours`: three numbers for each vertex.
std::vector<Colour> vertexColours(const double* colours, std::size_t vertices) {
    const std::span<const double> numbers = toSpan(colours, times(vertices, 3, "colours"), "colours");
    std::vector<Colour> out;
    out.reserve(vertices);
    for (std::size_t at = 0; at < numbers.size(); at += 3) {
        out.push_back({numbers[at], numbers[at + 1], numbers[at + 2]});
    }
    return out;
}

/// Makes an object with a renderer.
template <class Handle, class Body>
vxt_result createWith(const vxt_renderer* renderer, Handle** out, const Body& body) noexcept {
    return create(renderer, "renderer", out, [&](const OwnOrLent& with) { return take(body(with.get())); });
}

} // namespace

vxt_result vxt_renderer_create(const vxt_context* context, VkFormat color_format, vxt_renderer** renderer) {
    return create(context, "context", renderer, [&](const Context& on) {
        return OwnOrLent{take(Renderer::create(on, {color_format})), nullptr};
    });
}

void vxt_renderer_destroy(vxt_renderer* renderer) {
    if (renderer != nullptr && renderer->object.own) {
        delete renderer;
    }
}

vxt_result vxt_render_function_create(const vxt_renderer* renderer, const vxt_render_function_desc* desc,
                                      vxt_render_function** function) {
    return createWith(renderer, function, [&](const Renderer& with) {
        return RenderTransferFunction::create(with, RenderFunctionOf(desc).desc());
    });
}

vxt_result vxt_render_function_upload(const vxt_renderer* renderer, const vxt_queue* queue,
                                      const vxt_render_function_desc* desc, vxt_render_function** function) {
    return createWith(renderer, function, [&](const Renderer& with) {
        return RenderTransferFunction::upload(with, toQueue(queue), RenderFunctionOf(desc).desc());
    });
}

vxt_result vxt_render_function_cmd_upload(vxt_render_function* function, VkCommandBuffer commands) {
    return call(function, [&] { take(need(function, "function").object.cmdUpload(commands)); });
}

vxt_result vxt_render_function_cmd_update(vxt_render_function* function, VkCommandBuffer commands,
                                          const vxt_render_function_desc* desc) {
    return call(function, [&] {
        RenderTransferFunction& to = need(function, "function").object;
        take(to.cmdUpdate(commands, RenderFunctionOf(desc).desc()));
    });
}

uint32_t vxt_render_function_visible(const vxt_render_function* function) {
    return function != nullptr && function->object.visible() ? 1 : 0;
}

void vxt_render_function_destroy(vxt_render_function* function) {
    delete function;
}

vxt_result vxt_mesh_normals_create(const vxt_renderer* renderer, const vxt_mesh_view* mesh,
                                   vxt_mesh_normals** normals) {
    return createWith(renderer, normals,
                      [&](const Renderer& with) { return MeshNormals::create(with, toMeshView(mesh)); });
}

vxt_result vxt_mesh_normals_upload(const vxt_renderer* renderer, const vxt_queue* queue, const vxt_mesh_view* mesh,
                                   vxt_mesh_normals** normals) {
    return createWith(renderer, normals, [&](const Renderer& with) {
        return MeshNormals::upload(with, toQueue(queue), toMeshView(mesh));
    });
}

vxt_result vxt_mesh_normals_cmd_upload(vxt_mesh_normals* normals, VkCommandBuffer commands) {
    return call(normals, [&] { take(need(normals, "normals").object.cmdUpload(commands)); });
}

vxt_result vxt_mesh_normals_cmd_update(vxt_mesh_normals* normals, VkCommandBuffer commands, const vxt_mesh_view* mesh) {
    return call(normals, [&] { take(need(normals, "normals").object.cmdUpdate(commands, toMeshView(mesh))); });
}

void vxt_mesh_normals_release_staging(vxt_mesh_normals* normals) {
    if (normals != nullptr) {
        normals->object.releaseStaging();
    }
}

void vxt_mesh_normals_destroy(vxt_mesh_normals* normals) {
    delete normals;
}

vxt_result vxt_render_bricks_create(const vxt_renderer* renderer, const vxt_volume* volume,
                                    vxt_render_bricks** bricks) {
    return createWith(renderer, bricks,
                      [&](const Renderer& with) { return RenderBricks::create(with, need(volume, "volume").object); });
}

void vxt_render_bricks_destroy(vxt_render_bricks* bricks) {
    delete bricks;
}

vxt_result vxt_painted_triangles_create(const vxt_renderer* renderer, uint32_t mesh_triangles,
                                        const uint32_t* triangles, size_t triangle_count,
                                        vxt_painted_triangles** painted) {
    return createWith(renderer, painted, [&](const Renderer& with) {
        return PaintedTriangles::create(with, mesh_triangles, toSpan(triangles, triangle_count, "triangles"));
    });
}

vxt_result vxt_painted_triangles_upload(const vxt_renderer* renderer, const vxt_queue* queue, uint32_t mesh_triangles,
                                        const uint32_t* triangles, size_t triangle_count,
                                        vxt_painted_triangles** painted) {
    return createWith(renderer, painted, [&](const Renderer& with) {
        return PaintedTriangles::upload(with, toQueue(queue), mesh_triangles,
                                        toSpan(triangles, triangle_count, "triangles"));
    });
}

vxt_result vxt_painted_triangles_wrap(const vxt_renderer* renderer, const vxt_buffer_range* mask,
                                      vxt_painted_triangles** painted) {
    return createWith(renderer, painted, [&](const Renderer& with) {
        const vxt_buffer_range& given = need(mask, "mask");
        return PaintedTriangles::wrap(with, {given.buffer, given.offset, given.size});
    });
}

vxt_result vxt_painted_triangles_cmd_upload(vxt_painted_triangles* painted, VkCommandBuffer commands) {
    return call(painted, [&] { take(need(painted, "painted").object.cmdUpload(commands)); });
}

void vxt_painted_triangles_release_staging(vxt_painted_triangles* painted) {
    if (painted != nullptr) {
        painted->object.releaseStaging();
    }
}

void vxt_painted_triangles_destroy(vxt_painted_triangles* painted) {
    delete painted;
}

vxt_result vxt_painted_vertices_create(const vxt_renderer* renderer, const double* colours, size_t vertex_count,
                                       vxt_painted_vertices** painted) {
    return createWith(renderer, painted, [&](const Renderer& with) {
        return PaintedVertices::create(with, vertexColours(colours, vertex_count));
    });
}

vxt_result vxt_painted_vertices_upload(const vxt_renderer* renderer, const vxt_queue* queue, const double* colours,
                                       size_t vertex_count, vxt_painted_vertices** painted) {
    return createWith(renderer, painted, [&](const Renderer& with) {
        return PaintedVertices::upload(with, toQueue(queue), vertexColours(colours, vertex_count));
    });
}

vxt_result vxt_painted_vertices_wrap(const vxt_renderer* renderer, const vxt_buffer_range* colours,
                                     vxt_painted_vertices** painted) {
    return createWith(renderer, painted, [&](const Renderer& with) {
        const vxt_buffer_range& given = need(colours, "colours");
        return PaintedVertices::wrap(with, {given.buffer, given.offset, given.size});
    });
}

vxt_result vxt_painted_vertices_cmd_upload(vxt_painted_vertices* painted, VkCommandBuffer commands) {
    return call(painted, [&] { take(need(painted, "painted").object.cmdUpload(commands)); });
}

void vxt_painted_vertices_release_staging(vxt_painted_vertices* painted) {
    if (painted != nullptr) {
        painted->object.releaseStaging();
    }
}

void vxt_painted_vertices_destroy(vxt_painted_vertices* painted) {
    delete painted;
}

vxt_result vxt_render_targets_create(const vxt_renderer* renderer, uint32_t width, uint32_t height,
                                     vxt_render_targets** targets) {
    return createWith(renderer, targets, [&](const Renderer& with) {
        return RenderTargets::create(with, {width, height});
    });
}

void vxt_render_targets_destroy(vxt_render_targets* targets) {
    delete targets;
}
