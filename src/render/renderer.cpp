// SPDX-License-Identifier: MIT
#include "core/base/guard.h"

#include "core/base/try.h"
#include "render/render_impl.h"
#include "vulkan/layouts.h"
#include "vulkan/pipeline.h"

#include "voxtact_shaders/preintegrate_comp.h"
#include "voxtact_shaders/render_volume_frag.h"
#include "voxtact_shaders/render_volume_vert.h"

#include <string>

namespace voxtact {

namespace {

constexpr std::uint32_t kBoundSets = 4;
static_assert(VOXTACT_SET_VOLUME == 0 && PICTURE_SET_BRICKS + 1 == kBoundSets);
static_assert(VOXTACT_SET_TRANSFER_FUNCTION == VOXTACT_SET_VOLUME + 1 && PICTURE_SET_PAINT + 1 == kBoundSets);
static_assert(PICTURE_SET_TARGETS == VOXTACT_SET_TRANSFER_FUNCTION + 1);

/// True if a format's pixels are integers; the fragment shader's floats cannot be written to them.
bool isOfIntegers(VkFormat format) {
    switch (format) {
    case VK_FORMAT_R8_UINT:
    case VK_FORMAT_R8_SINT:
    case VK_FORMAT_R8G8_UINT:
    case VK_FORMAT_R8G8_SINT:
    case VK_FORMAT_R8G8B8_UINT:
    case VK_FORMAT_R8G8B8_SINT:
    case VK_FORMAT_B8G8R8_UINT:
    case VK_FORMAT_B8G8R8_SINT:
    case VK_FORMAT_R8G8B8A8_UINT:
    case VK_FORMAT_R8G8B8A8_SINT:
    case VK_FORMAT_B8G8R8A8_UINT:
    case VK_FORMAT_B8G8R8A8_SINT:
    case VK_FORMAT_A8B8G8R8_UINT_PACK32:
    case VK_FORMAT_A8B8G8R8_SINT_PACK32:
    case VK_FORMAT_A2R10G10B10_UINT_PACK32:
    case VK_FORMAT_A2R10G10B10_SINT_PACK32:
    case VK_FORMAT_A2B10G10R10_UINT_PACK32:
    case VK_FORMAT_A2B10G10R10_SINT_PACK32:
    case VK_FORMAT_R16_UINT:
    case VK_FORMAT_R16_SINT:
    case VK_FORMAT_R16G16_UINT:
    case VK_FORMAT_R16G16_SINT:
    case VK_FORMAT_R16G16B16_UINT:
    case VK_FORMAT_R16G16B16_SINT:
    case VK_FORMAT_R16G16B16A16_UINT:
    case VK_FORMAT_R16G16B16A16_SINT:
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SINT:
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32_SINT:
    case VK_FORMAT_R32G32B32_UINT:
    case VK_FORMAT_R32G32B32_SINT:
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SINT:
    case VK_FORMAT_R64_UINT:
    case VK_FORMAT_R64_SINT:
    case VK_FORMAT_R64G64_UINT:
    case VK_FORMAT_R64G64_SINT:
    case VK_FORMAT_R64G64B64_UINT:
    case VK_FORMAT_R64G64B64_SINT:
    case VK_FORMAT_R64G64B64A64_UINT:
    case VK_FORMAT_R64G64B64A64_SINT:
        return true;
    default:
        return false;
    }
}

/// A format of Vulkan 1.0, or one of two 16-bit formats of 1.3. Querying a driver about an invalid format is not
/// allowed.
bool mayBeAskedAbout(VkFormat format) {
    return (format > VK_FORMAT_UNDEFINED && format <= VK_FORMAT_ASTC_12x12_SRGB_BLOCK) ||
           format == VK_FORMAT_A4R4G4B4_UNORM_PACK16 || format == VK_FORMAT_A4B4G4R4_UNORM_PACK16;
}

Result<void> checkFormat(const ContextImpl& context, VkFormat format, VkFormatFeatureFlags needed, const char* use) {
    VkFormatProperties properties{};
    if (mayBeAskedAbout(format)) {
        context.vk.GetPhysicalDeviceFormatProperties(context.physicalDevice, format, &properties);
    }
    if (!mayBeAskedAbout(format) || (properties.optimalTilingFeatures & needed) != needed) {
        return Error{ErrorCode::Unsupported, 0,
                     "the device cannot use VkFormat " + std::to_string(format) + " for " + use};
    }
    return {};
}

Result<void> checkFormats(const ContextImpl& context, VkFormat colour) {
    constexpr VkFormatFeatureFlags kTarget =
        VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
    struct Needed {
        VkFormat format;
        VkFormatFeatureFlags features;
        const char* use;
    };
    for (const Needed& needed :
         {Needed{colour, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT, "RendererDesc::colorFormat"},
          Needed{kMeshColourFormat, kTarget, "the mesh's colour"},
          Needed{kMeshDistanceFormat, kTarget, "the mesh's distance"},
          Needed{kMeshDepthFormat, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT, "the mesh's depth"},
          Needed{kRenderTableFormat,
                 VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT,
                 "the pre-integrated table"}}) {
        VOXTACT_TRY(checkFormat(context, needed.format, needed.features, needed.use));
    }
    if (isOfIntegers(colour)) {
        return Error{ErrorCode::Unsupported, 0,
                     "RendererDesc::colorFormat is VkFormat " + std::to_string(colour) +
                         ", whose pixels are integers; a picture's are floats, or fractions as those of "
                         "R8G8B8A8_UNORM"};
    }
    return {};
}

Result<void> makeSetLayouts(RendererImpl& renderer) {
    constexpr VkShaderStageFlags kCompute = VK_SHADER_STAGE_COMPUTE_BIT;
    constexpr VkShaderStageFlags kFragment = VK_SHADER_STAGE_FRAGMENT_BIT;
    constexpr VkDescriptorType kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    constexpr VkDescriptorSetLayoutBinding kMaking[] = {
        {0, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 1, kCompute, nullptr},
        {1, kBuffer, 1, kCompute, nullptr},
    };
    constexpr VkDescriptorSetLayoutBinding kFunction[] = {
        {PICTURE_BINDING_TABLE, kSampled, 1, kFragment, nullptr},
        {PICTURE_BINDING_OPACITY, kBuffer, 1, kFragment, nullptr},
    };
    constexpr VkDescriptorSetLayoutBinding kTargets[] = {
        {PICTURE_BINDING_CONSTANTS, kBuffer, 1, VK_SHADER_STAGE_VERTEX_BIT | kFragment, nullptr},
        {PICTURE_BINDING_MESH_COLOUR, kSampled, 1, kFragment, nullptr},
        {PICTURE_BINDING_MESH_DISTANCE, kSampled, 1, kFragment, nullptr},
    };
    constexpr VkDescriptorSetLayoutBinding kBricks[] = {{0, kBuffer, 1, kMeshStages, nullptr}};
    struct Wanted {
        Owned<VkDescriptorSetLayout>& layout;
        std::span<const VkDescriptorSetLayoutBinding> bindings;
        const char* name;
    };
    for (const Wanted& wanted : {Wanted{renderer.makingLayout, kMaking, "pre-integration set layout"},
                                 Wanted{renderer.functionLayout, kFunction, "render function set layout"},
                                 Wanted{renderer.targetsLayout, kTargets, "render targets set layout"},
                                 Wanted{renderer.bricksLayout, kBricks, "render bricks set layout"}}) {
        VOXTACT_TRY(makeSetLayout(renderer.context, wanted.layout, wanted.bindings, wanted.name));
    }
    return {};
}

Result<void> makePipelineLayouts(RendererImpl& renderer) {
    ContextImpl& context = renderer.context;
    constexpr VkPushConstantRange kConstants{VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(shader::PreintegrateConstants)};
    const VkDescriptorSetLayout making = renderer.makingLayout.get();
    VOXTACT_TRY(makePipelineLayout(context, renderer.makingPipelineLayout, {&making, 1}, {&kConstants, 1},
                                   "pre-integration pipeline layout"));
    constexpr VkPushConstantRange kMesh{kMeshStages, 0, sizeof(std::uint32_t)};
    const VkDescriptorSetLayout sets[] = {context.setLayouts[VOXTACT_SET_VOLUME], renderer.functionLayout.get(),
                                          renderer.targetsLayout.get(), renderer.bricksLayout.get()};
    if (Result<void> made =
            makePipelineLayout(context, renderer.pictureLayout, sets, {&kMesh, 1}, "picture pipeline layout");
        !made.ok()) {
        return made;
    }
    const VkDescriptorSetLayout paintSets[] = {context.setLayouts[VOXTACT_SET_VOLUME],
                                               context.setLayouts[VOXTACT_SET_TRANSFER_FUNCTION],
                                               renderer.targetsLayout.get(), renderer.bricksLayout.get()};
    return makePipelineLayout(context, renderer.paintLayout, paintSets, {&kMesh, 1}, "paint pipeline layout");
}

Result<void> keep(Owned<VkPipeline>& out, Result<Owned<VkPipeline>> made) {
    VOXTACT_TRY(made);
    out = std::move(*made);
    return {};
}

Result<void> makeVolumePipelines(RendererImpl& renderer) {
    for (const bool occlusion : {false, true}) {
        const ShaderConstant constant{PICTURE_CONSTANT_OCCLUSION, occlusion ? 1U : 0U};
        const RasterPipelineDesc desc{.vertexSpirv = spirv::render_volume_vert,
                                      .fragmentSpirv = spirv::render_volume_frag,
                                      .constants = {&constant, 1},
                                      .layout = renderer.pictureLayout.get(),
                                      .vertexInput = false,
                                      .colourFormats = {&renderer.desc.colorFormat, 1},
                                      .name = occlusion ? "volume, occlusion" : "volume"};
        VOXTACT_TRY(keep(renderer.volumePipelines[occlusion ? 1 : 0], makeRasterPipeline(renderer.context, desc)));
    }
    return {};
}

Result<void> makePipelines(RendererImpl& renderer) {
    ContextImpl& context = renderer.context;
    if (Result<void> made =
            keep(renderer.makingPipeline, makeComputePipeline(context, spirv::preintegrate_comp, {},
                                                              renderer.makingPipelineLayout.get(), "pre-integration"));
        !made.ok()) {
        return made;
    }
    VOXTACT_TRY(makeMeshPipelines(renderer));
    return makeVolumePipelines(renderer);
}

/// Bound without bricks.
Result<void> makeNoBricks(RendererImpl& renderer) {
    const Result<VkBuffer> nothing = emptyBuffer(renderer.context);
    VOXTACT_TRY(nothing);
    constexpr VkDescriptorPoolSize kSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1};
    Result<DescriptorSet> set =
        makeDescriptorSet(renderer.context, renderer.bricksLayout.get(), {&kSize, 1}, "no bricks");
    VOXTACT_TRY(set);
    renderer.noBricks = std::move(*set);
    writeBuffer(renderer.context, renderer.noBricks.set, 0, *nothing);
    return {};
}

} // namespace

Renderer::Renderer(std::unique_ptr<RendererImpl> impl) noexcept : impl_(std::move(impl)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&& other) noexcept {
    if (this != &other) {
        RendererImpl::letGo(impl_);
        impl_ = std::move(other.impl_);
    }
    return *this;
}
Renderer::~Renderer() {
    RendererImpl::letGo(impl_);
}

Result<Renderer> Renderer::create(const Context& context, const RendererDesc& desc) {
    return guard([&]() -> Result<Renderer> {
        ContextImpl& c = context.impl();
        VOXTACT_TRY(c.alive());
        VOXTACT_TRY(checkFormats(c, desc.colorFormat));
        auto impl = std::make_shared<RendererImpl>(c, desc);
        for (const auto make : {makeSetLayouts, makePipelineLayouts, makePipelines, makeNoBricks}) {
            VOXTACT_TRY(make(*impl));
        }
        return Renderer(RendererImpl::hold(impl));
    });
}

} // namespace voxtact
