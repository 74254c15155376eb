// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "render/render_impl.h"
#include "vulkan/pipeline.h"

#include "voxtact_shaders/render_mesh_frag.h"
#include "voxtact_shaders/render_mesh_fragments_frag.h"
#include "voxtact_shaders/render_mesh_fragments_vert.h"
#include "voxtact_shaders/render_mesh_smooth_frag.h"
#include "voxtact_shaders/render_mesh_smooth_fragments_frag.h"
#include "voxtact_shaders/render_mesh_smooth_fragments_vert.h"
#include "voxtact_shaders/render_mesh_smooth_triangles_frag.h"
#include "voxtact_shaders/render_mesh_smooth_vert.h"
#include "voxtact_shaders/render_mesh_smooth_vertices_frag.h"
#include "voxtact_shaders/render_mesh_smooth_vertices_vert.h"
#include "voxtact_shaders/render_mesh_triangles_frag.h"
#include "voxtact_shaders/render_mesh_vert.h"
#include "voxtact_shaders/render_mesh_vertices_frag.h"
#include "voxtact_shaders/render_mesh_vertices_vert.h"

namespace voxtact {

namespace {

struct MeshShaders {
    PaintBy by;
    bool smooth;
    std::span<const std::uint32_t> vertex;
    std::span<const std::uint32_t> fragment;
    const char* name;
};

Result<void> makeMeshPipeline(RendererImpl& renderer, const MeshShaders& shaders) {
    constexpr VkFormat kFormats[] = {kMeshColourFormat, kMeshDistanceFormat};
    const VkPipelineLayout layout =
        (shaders.by == PaintBy::Nobody ? renderer.pictureLayout : renderer.paintLayout).get();
    Result<Owned<VkPipeline>> made = makeRasterPipeline(renderer.context, {.vertexSpirv = shaders.vertex,
                                                                           .fragmentSpirv = shaders.fragment,
                                                                           .constants = {},
                                                                           .layout = layout,
                                                                           .normals = shaders.smooth,
                                                                           .colourFormats = kFormats,
                                                                           .depthFormat = kMeshDepthFormat,
                                                                           .name = shaders.name});
    VOXTACT_TRY(made);
    renderer.meshPipelines[static_cast<std::size_t>(shaders.by)][shaders.smooth ? 1 : 0] = std::move(*made);
    return {};
}

} // namespace

Result<void> makeMeshPipelines(RendererImpl& renderer) {
    const MeshShaders all[] = {
        {PaintBy::Nobody, false, spirv::render_mesh_vert, spirv::render_mesh_frag, "mesh"},
        {PaintBy::Nobody, true, spirv::render_mesh_smooth_vert, spirv::render_mesh_smooth_frag, "smooth mesh"},
        {PaintBy::Fragments, false, spirv::render_mesh_fragments_vert, spirv::render_mesh_fragments_frag,
         "mesh painted by fragment"},
        {PaintBy::Fragments, true, spirv::render_mesh_smooth_fragments_vert, spirv::render_mesh_smooth_fragments_frag,
         "smooth mesh painted by fragment"},
        {PaintBy::Triangles, false, spirv::render_mesh_vert, spirv::render_mesh_triangles_frag,
         "mesh painted by triangle"},
        {PaintBy::Triangles, true, spirv::render_mesh_smooth_vert, spirv::render_mesh_smooth_triangles_frag,
         "smooth mesh painted by triangle"},
        {PaintBy::Vertices, false, spirv::render_mesh_vertices_vert, spirv::render_mesh_vertices_frag,
         "mesh painted by vertex"},
        {PaintBy::Vertices, true, spirv::render_mesh_smooth_vertices_vert, spirv::render_mesh_smooth_vertices_frag,
         "smooth mesh painted by vertex"},
    };
    for (const MeshShaders& shaders : all) {
        if (shaders.by == PaintBy::Triangles && !renderer.context.features.geometryShader) {
            continue;
        }
        VOXTACT_TRY(makeMeshPipeline(renderer, shaders));
    }
    return {};
}

} // namespace voxtact
