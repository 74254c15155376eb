// SPDX-License-Identifier: MIT
// Transfer functions, meshes and label maps on the device.
#include "c/convert_vulkan.h"
#include "c/handles.h"

using namespace voxtact;
using namespace voxtact::c;

namespace {

constexpr auto kPlainStride = decltype(vxt_mesh_options::vertex_stride){12};

WrappedTransferFunction toWrapped(const vxt_wrapped_transfer_function* given) {
    const vxt_wrapped_transfer_function wrapped =
        readStruct(given, zero<vxt_wrapped_transfer_function>(), "wrapped transfer function");
    return {.view = wrapped.view,
            .layout = layoutOf(wrapped.layout),
            .domain = toRange(wrapped.domain),
            .table = toSpan(wrapped.table, wrapped.table_size, "wrapped transfer function: table")};
}

MeshOptions toOptions(const vxt_mesh_options* given) {
    const vxt_mesh_options options = readOptions(given, zero<vxt_mesh_options>(), "options");
    return {.name = options.name,
            .clusters = options.clusters != 0,
            .editable = options.editable != 0,
            .vertexStride = orDefault(options.vertex_stride, kPlainStride)};
}

WrappedMesh toWrapped(const vxt_wrapped_mesh* given) {
    const vxt_wrapped_mesh wrapped = readStruct(given, zero<vxt_wrapped_mesh>(), "wrapped mesh");
    return {.vertices = wrapped.vertices,
            .vertexOffset = wrapped.vertex_offset,
            .vertexStride = orDefault(wrapped.vertex_stride, kPlainStride),
            .vertexCount = wrapped.vertex_count,
            .indices = wrapped.indices,
            .indexOffset = wrapped.index_offset,
            .indexType = wrapped.index_type,
            .triangleCount = wrapped.triangle_count,
            .storage = wrapped.storage != 0,
            .clusters = wrapped.clusters != 0,
            .shape = wrapped.shape == nullptr ? MeshView{} : toMeshView(wrapped.shape)};
}

} // namespace

vxt_result vxt_transfer_function_create(const vxt_context* context, const vxt_transfer_function_desc* desc,
                                        const char* name, vxt_transfer_function** function) {
    return create(context, "context", function, [&](const Context& on) {
        return take(TransferFunction::create(on, TransferFunctionOf(desc).desc(), name));
    });
}

vxt_result vxt_transfer_function_wrap(const vxt_context* context, const vxt_wrapped_transfer_function* wrapped,
                                      vxt_transfer_function** function) {
    return create(context, "context", function,
                  [&](const Context& on) { return take(TransferFunction::wrap(on, toWrapped(wrapped))); });
}

vxt_result vxt_transfer_function_upload(const vxt_context* context, const vxt_queue* queue,
                                        const vxt_transfer_function_desc* desc, const char* name,
                                        vxt_transfer_function** function) {
    return create(context, "context", function, [&](const Context& on) {
        return take(TransferFunction::upload(on, toQueue(queue), TransferFunctionOf(desc).desc(), name));
    });
}

vxt_result vxt_transfer_function_cmd_upload(vxt_transfer_function* function, VkCommandBuffer commands) {
    return call(function, [&] { take(need(function, "transfer function").object.cmdUpload(commands)); });
}

void vxt_transfer_function_release_staging(vxt_transfer_function* function) {
    if (function != nullptr) {
        function->object.releaseStaging();
    }
}

vxt_result vxt_transfer_function_cmd_update(vxt_transfer_function* function, VkCommandBuffer commands,
                                            const vxt_transfer_function_desc* desc) {
    return call(function, [&] {
        take(need(function, "transfer function").object.cmdUpdate(commands, TransferFunctionOf(desc).desc()));
    });
}

vxt_result vxt_transfer_function_domain(const vxt_transfer_function* function, vxt_range* domain) {
    return call(function,
                [&] { need(domain, "domain") = fromRange(need(function, "transfer function").object.domain()); });
}

void vxt_transfer_function_destroy(vxt_transfer_function* function) {
    delete function;
}

vxt_result vxt_mesh_create(const vxt_context* context, const vxt_mesh_view* view, const vxt_mesh_options* options,
                           vxt_mesh** mesh) {
    return create(context, "context", mesh,
                  [&](const Context& on) { return take(Mesh::create(on, toMeshView(view), toOptions(options))); });
}

vxt_result vxt_mesh_wrap(const vxt_context* context, const vxt_wrapped_mesh* wrapped, vxt_mesh** mesh) {
    return create(context, "context", mesh,
                  [&](const Context& on) { return take(Mesh::wrap(on, toWrapped(wrapped))); });
}

vxt_result vxt_mesh_upload(const vxt_context* context, const vxt_queue* queue, const vxt_mesh_view* view,
                           const vxt_mesh_options* options, vxt_mesh** mesh) {
    return create(context, "context", mesh, [&](const Context& on) {
        return take(Mesh::upload(on, toQueue(queue), toMeshView(view), toOptions(options)));
    });
}

vxt_result vxt_mesh_cmd_upload(vxt_mesh* mesh, VkCommandBuffer commands) {
    return call(mesh, [&] { take(need(mesh, "mesh").object.cmdUpload(commands)); });
}

void vxt_mesh_release_staging(vxt_mesh* mesh) {
    if (mesh != nullptr) {
        mesh->object.releaseStaging();
    }
}

vxt_result vxt_mesh_cmd_update(vxt_mesh* mesh, VkCommandBuffer commands, const double* positions, size_t vertex_count) {
    return call(mesh, [&] {
        take(need(mesh, "mesh")
                 .object.cmdUpdate(commands, toSpan(positions, times(vertex_count, 3, "positions"), "positions")));
    });
}

vxt_result vxt_mesh_cmd_copy(vxt_mesh* mesh, VkCommandBuffer commands, VkBuffer source, VkDeviceSize offset) {
    return call(mesh, [&] { take(need(mesh, "mesh").object.cmdCopy(commands, source, offset)); });
}

vxt_result vxt_mesh_cmd_refit(vxt_mesh* mesh, VkCommandBuffer commands) {
    return call(mesh, [&] { take(need(mesh, "mesh").object.cmdRefit(commands)); });
}

uint32_t vxt_mesh_triangles(const vxt_mesh* mesh) {
    return mesh == nullptr ? 0 : mesh->object.triangles();
}

vxt_result vxt_mesh_get_facts(const vxt_mesh* mesh, vxt_mesh_facts* facts) {
    return call(mesh, [&] {
        const std::optional<MeshFacts> known = need(mesh, "mesh").object.facts();
        if (!known) {
            refuse(ErrorCode::NotReady, "nothing is known of the vertices of the mesh: they are, or were copied from, "
                                        "a buffer of the caller's");
        }
        need(facts, "facts") = fromFacts(*known);
    });
}

void vxt_mesh_destroy(vxt_mesh* mesh) {
    delete mesh;
}

vxt_result vxt_pose_buffer_wrap(const vxt_context* context, const vxt_wrapped_poses* wrapped, const char* name,
                                vxt_pose_buffer** poses) {
    return create(context, "context", poses, [&](const Context& on) {
        const vxt_wrapped_poses from = readOptions(wrapped, zero<vxt_wrapped_poses>(), "wrapped poses");
        return take(PoseBuffer::wrap(on,
                                     {.buffer = from.buffer,
                                      .offset = from.offset,
                                      .stride = orDefault(from.stride, VkDeviceSize{64}),
                                      .count = from.count,
                                      .maxScale = orDefault(from.max_scale, 1.0)},
                                     name));
    });
}

uint32_t vxt_pose_buffer_count(const vxt_pose_buffer* poses) {
    return poses == nullptr ? 0 : poses->object.count();
}

void vxt_pose_buffer_destroy(vxt_pose_buffer* poses) {
    delete poses;
}

vxt_result vxt_label_map_create(const vxt_context* context, const vxt_labels* labels, const char* name,
                                vxt_label_map** map) {
    return create(context, "context", map,
                  [&](const Context& on) { return take(LabelMap::create(on, need(labels, "labels").object, name)); });
}

vxt_result vxt_label_map_upload(const vxt_context* context, const vxt_queue* queue, const vxt_labels* labels,
                                const char* name, vxt_label_map** map) {
    return create(context, "context", map, [&](const Context& on) {
        return take(LabelMap::upload(on, toQueue(queue), need(labels, "labels").object, name));
    });
}

vxt_result vxt_label_map_cmd_upload(vxt_label_map* map, VkCommandBuffer commands) {
    return call(map, [&] { take(need(map, "label map").object.cmdUpload(commands)); });
}

void vxt_label_map_release_staging(vxt_label_map* map) {
    if (map != nullptr) {
        map->object.releaseStaging();
    }
}

const int32_t* vxt_label_map_values(const vxt_label_map* map, size_t* count) {
    return handOut(map == nullptr ? std::span<const std::int32_t>() : map->object.values(), count);
}

void vxt_label_map_destroy(vxt_label_map* map) {
    delete map;
}
