// SPDX-License-Identifier: MIT
#include "vulkan/pipeline.h"

#include "core/base/try.h"
#include "vulkan/debug.h"

#include <array>
#include <vector>

namespace voxtact {

namespace {

Result<Owned<VkShaderModule>> makeModule(ContextImpl& context, std::span<const std::uint32_t> spirv, const char* name) {
    const std::vector<std::uint32_t> words = withFloatControls(spirv, context.floatControls);
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = words.size() * sizeof(std::uint32_t);
    info.pCode = words.data();
    VkShaderModule handle = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateShaderModule(context.device, &info, context.allocator, &handle);
        result != VK_SUCCESS) {
        return context.failure(result, "making a shader module");
    }
    nameObject(context, VK_OBJECT_TYPE_SHADER_MODULE, handle, name);
    return Owned<VkShaderModule>(context, handle, [](ContextImpl& c, VkShaderModule module) {
        c.vk.DestroyShaderModule(c.device, module, c.allocator);
    });
}

VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits bit, VkShaderModule module) {
    VkPipelineShaderStageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage = bit;
    info.module = module;
    info.pName = "main";
    return info;
}

/// Constants as Vulkan wants them. Refers to the span that it was made from.
struct Specialization {
    std::vector<VkSpecializationMapEntry> entries;
    VkSpecializationInfo info{};

    explicit Specialization(std::span<const ShaderConstant> constants) {
        for (const ShaderConstant& constant : constants) {
            const auto offset =
                static_cast<std::uint32_t>(entries.size() * sizeof(ShaderConstant) + offsetof(ShaderConstant, value));
            entries.push_back({constant.id, offset, sizeof constant.value});
        }
        info = {static_cast<std::uint32_t>(entries.size()), entries.data(), constants.size_bytes(), constants.data()};
    }
    Specialization(const Specialization&) = delete;
    Specialization& operator=(const Specialization&) = delete;
};

Owned<VkPipeline> own(ContextImpl& context, VkPipeline handle, const char* name) {
    nameObject(context, VK_OBJECT_TYPE_PIPELINE, handle, name);
    return {context, handle,
            [](ContextImpl& c, VkPipeline pipeline) { c.vk.DestroyPipeline(c.device, pipeline, c.allocator); }};
}

/// The fixed-function state of raster passes.
struct FixedState {
    std::array<VkVertexInputBindingDescription, 2> bindings{
        {{0, 3 * sizeof(float), VK_VERTEX_INPUT_RATE_VERTEX}, {1, 3 * sizeof(float), VK_VERTEX_INPUT_RATE_VERTEX}}};
    std::array<VkVertexInputAttributeDescription, 2> attributes{
        {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}, {1, 1, VK_FORMAT_R32G32B32_SFLOAT, 0}}};
    /// The last one is for vertex input only.
    std::array<VkDynamicState, 3> dynamicStates{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                                VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE};
    std::vector<VkPipelineColorBlendAttachmentState> attachments;
    VkPipelineVertexInputStateCreateInfo vertexInput{};
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    VkPipelineViewportStateCreateInfo viewport{};
    VkPipelineRasterizationStateCreateInfo raster{};
    VkPipelineRasterizationConservativeStateCreateInfoEXT conservative{};
    VkPipelineMultisampleStateCreateInfo multisample{};
    VkPipelineDepthStencilStateCreateInfo depth{};
    VkPipelineColorBlendStateCreateInfo blend{};
    VkPipelineDynamicStateCreateInfo dynamic{};
    VkPipelineRenderingCreateInfo rendering{};

    explicit FixedState(const RasterPipelineDesc& desc) {
        setVertexInput(desc);
        viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
        viewport.viewportCount = 1;
        viewport.scissorCount = 1;
        conservative.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_CONSERVATIVE_STATE_CREATE_INFO_EXT;
        conservative.conservativeRasterizationMode = VK_CONSERVATIVE_RASTERIZATION_MODE_OVERESTIMATE_EXT;
        raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
        raster.pNext = desc.overestimate ? &conservative : nullptr;
        raster.polygonMode = VK_POLYGON_MODE_FILL;
        raster.cullMode = VK_CULL_MODE_NONE;
        raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
        raster.lineWidth = 1.0F;
        multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
        multisample.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
        setAttachments(desc);
    }
    FixedState(const FixedState&) = delete;
    FixedState& operator=(const FixedState&) = delete;

  private:
    void setVertexInput(const RasterPipelineDesc& desc) {
        const std::uint32_t inputs = desc.vertexInput ? (desc.normals ? 2 : 1) : 0;
        vertexInput.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
        vertexInput.vertexBindingDescriptionCount = inputs;
        vertexInput.pVertexBindingDescriptions = bindings.data();
        vertexInput.vertexAttributeDescriptionCount = inputs;
        vertexInput.pVertexAttributeDescriptions = attributes.data();
        assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
        dynamic.dynamicStateCount = static_cast<std::uint32_t>(dynamicStates.size()) - (desc.vertexInput ? 0 : 1);
        dynamic.pDynamicStates = dynamicStates.data();
    }

    void setAttachments(const RasterPipelineDesc& desc) {
        VkPipelineColorBlendAttachmentState attachment{};
        attachment.colorWriteMask =
            VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
        attachments.assign(desc.colourFormats.size(), attachment);
        blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
        blend.attachmentCount = static_cast<std::uint32_t>(attachments.size());
        blend.pAttachments = attachments.data();
        depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
        depth.depthTestEnable = VK_TRUE;
        depth.depthWriteEnable = VK_TRUE;
        depth.depthCompareOp = VK_COMPARE_OP_LESS;
        rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
        rendering.colorAttachmentCount = blend.attachmentCount;
        rendering.pColorAttachmentFormats = desc.colourFormats.data();
        rendering.depthAttachmentFormat = desc.depthFormat;
    }
};

} // namespace

Result<Owned<VkPipeline>> makeRasterPipeline(ContextImpl& context, const RasterPipelineDesc& desc) {
    Result<Owned<VkShaderModule>> vertex = makeModule(context, desc.vertexSpirv, desc.name);
    VOXTACT_TRY(vertex);
    Result<Owned<VkShaderModule>> fragment = makeModule(context, desc.fragmentSpirv, desc.name);
    VOXTACT_TRY(fragment);
    const Specialization constants(desc.constants);
    VkPipelineShaderStageCreateInfo stages[] = {stage(VK_SHADER_STAGE_VERTEX_BIT, vertex->get()),
                                                stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment->get())};
    stages[0].pSpecializationInfo = &constants.info;
    stages[1].pSpecializationInfo = &constants.info;

    const FixedState fixed(desc);
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &fixed.rendering;
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &fixed.vertexInput;
    info.pInputAssemblyState = &fixed.assembly;
    info.pViewportState = &fixed.viewport;
    info.pRasterizationState = &fixed.raster;
    info.pMultisampleState = &fixed.multisample;
    info.pDepthStencilState = desc.depthFormat == VK_FORMAT_UNDEFINED ? nullptr : &fixed.depth;
    info.pColorBlendState = desc.colourFormats.empty() ? nullptr : &fixed.blend;
    info.pDynamicState = &fixed.dynamic;
    info.layout = desc.layout;
    VkPipeline handle = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateGraphicsPipelines(context.device, context.pipelineCache, 1, &info,
                                                                   context.allocator, &handle);
        result != VK_SUCCESS) {
        return context.failure(result, "making a pipeline");
    }
    return own(context, handle, desc.name);
}

Result<Owned<VkPipeline>> makeComputePipeline(ContextImpl& context, std::span<const std::uint32_t> spirv,
                                              std::span<const ShaderConstant> constants, VkPipelineLayout layout,
                                              const char* name) {
    Result<Owned<VkShaderModule>> module = makeModule(context, spirv, name);
    VOXTACT_TRY(module);
    const Specialization specialization(constants);
    VkComputePipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, module->get());
    info.stage.pSpecializationInfo = &specialization.info;
    info.layout = layout;
    VkPipeline handle = VK_NULL_HANDLE;
    if (const VkResult result = context.vk.CreateComputePipelines(context.device, context.pipelineCache, 1, &info,
                                                                  context.allocator, &handle);
        result != VK_SUCCESS) {
        return context.failure(result, "making a compute pipeline");
    }
    return own(context, handle, name);
}

Result<VkPipeline> computePipeline(ContextImpl& context, std::span<const std::uint32_t> spirv,
                                   std::span<const ShaderConstant> constants, VkPipelineLayout layout,
                                   const char* name) {
    KeptPipeline& kept = context.pipelines.of({spirv.data(), layout, {constants.begin(), constants.end()}});
    const std::lock_guard lock(kept.making);
    if (!kept.pipeline) {
        Result<Owned<VkPipeline>> made = makeComputePipeline(context, spirv, constants, layout, name);
        VOXTACT_TRY(made);
        kept.pipeline = std::move(*made);
    }
    return kept.pipeline.get();
}

} // namespace voxtact
