// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/kept_pipelines.h"

#include <cstdint>
#include <span>

namespace voxtact {

struct RasterPipelineDesc {
    std::span<const std::uint32_t> vertexSpirv;
    std::span<const std::uint32_t> fragmentSpirv;
    std::span<const ShaderConstant> constants; ///< of both stages; each takes those that it has
    VkPipelineLayout layout =
        VK_NULL_HANDLE;        ///< that of the shaders: ContextImpl::rasterLayout, or one that extends it
    bool vertexInput = true;   ///< false: the vertex shader reads no vertex buffer
    bool normals = false;      ///< float3 at binding and location 1, packed, in addition to the positions
    bool overestimate = false; ///< by VK_EXT_conservative_rasterization, which must be enabled
    std::span<const VkFormat> colourFormats{};  ///< of the attachments, which are written without blending
    VkFormat depthFormat = VK_FORMAT_UNDEFINED; ///< with one, what is nearer hides what is behind
    const char* name = "";
};

/// A pipeline that rasterises triangles. Without attachments what counts is which fragments survive. Vertices are
/// float3 at binding 0, if any; the strides of bindings are dynamic, as are viewport and scissor. Nothing is culled;
/// the near and far planes clip.
[[nodiscard]] Result<Owned<VkPipeline>> makeRasterPipeline(ContextImpl& context, const RasterPipelineDesc& desc);

[[nodiscard]] Result<Owned<VkPipeline>> makeComputePipeline(ContextImpl& context, std::span<const std::uint32_t> spirv,
                                                            std::span<const ShaderConstant> constants,
                                                            VkPipelineLayout layout, const char* name);

/// The same, kept by the context for all who ask for it: made for the first of them, destroyed with the context. It is
/// known by the address of `spirv`, which must stay where it is; `layout` is the context's. Any thread may ask, and
/// waits for a pipeline that another one is making.
[[nodiscard]] Result<VkPipeline> computePipeline(ContextImpl& context, std::span<const std::uint32_t> spirv,
                                                 std::span<const ShaderConstant> constants, VkPipelineLayout layout,
                                                 const char* name);

} // namespace voxtact
