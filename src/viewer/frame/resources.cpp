// SPDX-License-Identifier: MIT
#include "viewer/frame/resources.h"

#include "core/base/try.h"
#include "vulkan/own/created.h"
#include "vulkan/own/timed_submission.h"

#include <imgui.h>

#include <array>
#include <cstddef>
#include <optional>
#include <utility>

namespace voxtact::view {

namespace {

using device::createdOrNull;
using device::vulkanError;

Result<std::uint32_t> memoryType(const device::VulkanDevice& device, std::uint32_t allowed,
                                 VkMemoryPropertyFlags wanted) {
    const ContextDesc& desc = device.contextDesc();
    // Vulkan's loader gives every function as one of no arguments.
    const auto get = reinterpret_cast<PFN_vkGetPhysicalDeviceMemoryProperties>(
        desc.getInstanceProcAddr(desc.instance, "vkGetPhysicalDeviceMemoryProperties"));
    VkPhysicalDeviceMemoryProperties properties{};
    get(desc.physicalDevice, &properties);
    for (std::uint32_t type = 0; type < properties.memoryTypeCount; ++type) {
        if ((allowed >> type & 1U) != 0 && (properties.memoryTypes[type].propertyFlags & wanted) == wanted) {
            return type;
        }
    }
    return Error{ErrorCode::Unsupported, 0, "the device has no suitable memory for the pictures of the window"};
}

Result<void> allocate(const device::VulkanDevice& device, const VkMemoryRequirements& needs,
                      VkMemoryPropertyFlags wanted, VkDeviceMemory& memory) {
    const Result<std::uint32_t> type = memoryType(device, needs.memoryTypeBits, wanted);
    VOXTACT_TRY(type);
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = *type;
    const VkResult result =
        createdOrNull(device.table().vkAllocateMemory(device.handle(), &info, nullptr, &memory), memory);
    return result == VK_SUCCESS ? Result<void>() : vulkanError(result, "device memory for the window's pictures");
}

VkResult makeView(const device::VulkanDevice& device, VkImage image, VkFormat format, VkImageView& view) {
    VkImageViewCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = format;
    info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    return createdOrNull(device.table().vkCreateImageView(device.handle(), &info, nullptr, &view), view);
}

/// Exists while a pipeline is made.
class ShaderModule {
  public:
    ShaderModule(const device::VulkanDevice& device, std::span<const std::uint32_t> words) : device_(device) {
        VkShaderModuleCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        info.codeSize = words.size_bytes();
        info.pCode = words.data();
        result_ =
            createdOrNull(device.table().vkCreateShaderModule(device.handle(), &info, nullptr, &module_), module_);
    }
    ShaderModule(const ShaderModule&) = delete;
    ShaderModule& operator=(const ShaderModule&) = delete;
    ~ShaderModule() { device_.table().vkDestroyShaderModule(device_.handle(), module_, nullptr); }

    [[nodiscard]] VkResult result() const { return result_; }
    [[nodiscard]] VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits stage) const {
        VkPipelineShaderStageCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage = stage;
        info.module = module_;
        info.pName = "main";
        return info;
    }

  private:
    const device::VulkanDevice& device_;
    VkShaderModule module_ = VK_NULL_HANDLE;
    VkResult result_ = VK_SUCCESS;
};

VkPipelineColorBlendAttachmentState blendState(bool blended) {
    VkPipelineColorBlendAttachmentState blend{};
    blend.blendEnable = blended ? VK_TRUE : VK_FALSE;
    blend.srcColorBlendFactor = VK_BLEND_FACTOR_SRC_ALPHA;
    blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    blend.colorBlendOp = VK_BLEND_OP_ADD;
    blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    blend.alphaBlendOp = VK_BLEND_OP_ADD;
    blend.colorWriteMask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    return blend;
}

/// The states of a pipeline that all of ours share. Not to be moved: the structs point at each other.
struct PipelineStates {
    explicit PipelineStates(const DrawPipelineDesc& desc) : blend(blendState(desc.blended)), format(desc.format) {
        vertexInput.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
        if (desc.guiVertices) {
            vertexInput.vertexBindingDescriptionCount = 1;
            vertexInput.pVertexBindingDescriptions = &binding;
            vertexInput.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(attributes.size());
            vertexInput.pVertexAttributeDescriptions = attributes.data();
        }
        assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
        assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
        viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
        viewport.viewportCount = 1;
        viewport.scissorCount = 1;
        raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
        raster.lineWidth = 1;
        samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
        samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
        blending.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
        blending.attachmentCount = 1;
        blending.pAttachments = &blend;
        dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
        dynamic.dynamicStateCount = static_cast<std::uint32_t>(kDynamic.size());
        dynamic.pDynamicStates = kDynamic.data();
        rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
        rendering.colorAttachmentCount = 1;
        rendering.pColorAttachmentFormats = &format;
    }
    PipelineStates(const PipelineStates&) = delete;
    PipelineStates& operator=(const PipelineStates&) = delete;

    static constexpr std::array kDynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkVertexInputBindingDescription binding{0, sizeof(ImDrawVert), VK_VERTEX_INPUT_RATE_VERTEX};
    std::array<VkVertexInputAttributeDescription, 3> attributes{
        {{0, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, pos)},
         {1, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(ImDrawVert, uv)},
         {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(ImDrawVert, col)}}};
    VkPipelineVertexInputStateCreateInfo vertexInput{};
    VkPipelineInputAssemblyStateCreateInfo assembly{};
    VkPipelineViewportStateCreateInfo viewport{};
    VkPipelineRasterizationStateCreateInfo raster{};
    VkPipelineMultisampleStateCreateInfo samples{};
    VkPipelineColorBlendAttachmentState blend;
    VkPipelineColorBlendStateCreateInfo blending{};
    VkPipelineDynamicStateCreateInfo dynamic{};
    VkFormat format;
    VkPipelineRenderingCreateInfo rendering{};
};

template <class Barrier> Barrier between(VkStructureType type, const BarrierSide& before, const BarrierSide& after) {
    Barrier barrier{};
    barrier.sType = type;
    barrier.srcStageMask = before.stage;
    barrier.srcAccessMask = before.access;
    barrier.dstStageMask = after.stage;
    barrier.dstAccessMask = after.access;
    return barrier;
}

void wait(const device::VulkanDevice& device, VkCommandBuffer commands, VkDependencyInfo info) {
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    device.table().vkCmdPipelineBarrier2(commands, &info);
}

} // namespace

Result<Image> Image::create(const device::VulkanDevice& device, VkExtent2D extent, VkFormat format,
                            VkImageUsageFlags usage) {
    Image out;
    out.device_ = &device;
    out.extent_ = extent;
    VkImageCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent = {extent.width, extent.height, 1};
    info.mipLevels = 1;
    info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    const VolkDeviceTable& table = device.table();
    VkResult result = createdOrNull(table.vkCreateImage(device.handle(), &info, nullptr, &out.image_), out.image_);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "making a picture of the window");
    }
    VkMemoryRequirements needs{};
    table.vkGetImageMemoryRequirements(device.handle(), out.image_, &needs);
    VOXTACT_TRY(allocate(device, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, out.memory_));
    result = table.vkBindImageMemory(device.handle(), out.image_, out.memory_, 0);
    result = result == VK_SUCCESS ? makeView(device, out.image_, format, out.view_) : result;
    if (result != VK_SUCCESS) {
        return vulkanError(result, "making a picture of the window");
    }
    return out;
}

Image& Image::operator=(Image&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(image_, other.image_);
    std::swap(memory_, other.memory_);
    std::swap(view_, other.view_);
    std::swap(extent_, other.extent_);
    return *this;
}

Image::~Image() {
    if (device_ != nullptr) {
        device_->table().vkDestroyImageView(device_->handle(), view_, nullptr);
        device_->table().vkDestroyImage(device_->handle(), image_, nullptr);
        device_->table().vkFreeMemory(device_->handle(), memory_, nullptr);
    }
}

Result<HostBuffer> HostBuffer::create(const device::VulkanDevice& device, VkDeviceSize bytes,
                                      VkBufferUsageFlags usage) {
    HostBuffer out;
    out.device_ = &device;
    VkBufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = usage;
    const VolkDeviceTable& table = device.table();
    VkResult result = createdOrNull(table.vkCreateBuffer(device.handle(), &info, nullptr, &out.buffer_), out.buffer_);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "making a buffer of the window");
    }
    VkMemoryRequirements needs{};
    table.vkGetBufferMemoryRequirements(device.handle(), out.buffer_, &needs);
    VOXTACT_TRY(allocate(device, needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                         out.memory_));
    void* mapped = nullptr;
    result = table.vkBindBufferMemory(device.handle(), out.buffer_, out.memory_, 0);
    result =
        result == VK_SUCCESS ? table.vkMapMemory(device.handle(), out.memory_, 0, VK_WHOLE_SIZE, 0, &mapped) : result;
    if (result != VK_SUCCESS) {
        return vulkanError(result, "making a buffer of the window");
    }
    out.bytes_ = {static_cast<std::byte*>(mapped), static_cast<std::size_t>(bytes)};
    return out;
}

HostBuffer& HostBuffer::operator=(HostBuffer&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(memory_, other.memory_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

HostBuffer::~HostBuffer() {
    if (device_ != nullptr) {
        device_->table().vkDestroyBuffer(device_->handle(), buffer_, nullptr);
        device_->table().vkFreeMemory(device_->handle(), memory_, nullptr); // and unmaps
    }
}

Result<DrawPipeline> DrawPipeline::create(const device::VulkanDevice& device, const DrawPipelineDesc& desc) {
    DrawPipeline out;
    out.device_ = &device;
    const VolkDeviceTable& table = device.table();
    VkDescriptorSetLayoutBinding binding{};
    binding.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    binding.descriptorCount = 1;
    binding.stageFlags = VK_SHADER_STAGE_FRAGMENT_BIT;
    VkDescriptorSetLayoutCreateInfo set{};
    set.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    set.bindingCount = 1;
    set.pBindings = &binding;
    VkResult result = createdOrNull(table.vkCreateDescriptorSetLayout(device.handle(), &set, nullptr, &out.setLayout_),
                                    out.setLayout_);
    const VkPushConstantRange push{desc.pushStages, 0, desc.pushBytes};
    VkPipelineLayoutCreateInfo layout{};
    layout.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    layout.setLayoutCount = 1;
    layout.pSetLayouts = &out.setLayout_;
    layout.pushConstantRangeCount = 1;
    layout.pPushConstantRanges = &push;
    if (result == VK_SUCCESS) {
        result =
            createdOrNull(table.vkCreatePipelineLayout(device.handle(), &layout, nullptr, &out.layout_), out.layout_);
    }
    const ShaderModule vertex(device, desc.vertexShader);
    const ShaderModule fragment(device, desc.fragmentShader);
    for (const VkResult made : {vertex.result(), fragment.result()}) {
        result = result == VK_SUCCESS ? made : result;
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "making a pipeline of the window");
    }
    const PipelineStates states(desc);
    const std::array stages{vertex.stage(VK_SHADER_STAGE_VERTEX_BIT), fragment.stage(VK_SHADER_STAGE_FRAGMENT_BIT)};
    VkGraphicsPipelineCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pNext = &states.rendering;
    info.stageCount = static_cast<std::uint32_t>(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &states.vertexInput;
    info.pInputAssemblyState = &states.assembly;
    info.pViewportState = &states.viewport;
    info.pRasterizationState = &states.raster;
    info.pMultisampleState = &states.samples;
    info.pColorBlendState = &states.blending;
    info.pDynamicState = &states.dynamic;
    info.layout = out.layout_;
    result = createdOrNull(
        table.vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &out.pipeline_),
        out.pipeline_);
    if (result != VK_SUCCESS) {
        return vulkanError(result, "making a pipeline of the window");
    }
    return out;
}

DrawPipeline& DrawPipeline::operator=(DrawPipeline&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(setLayout_, other.setLayout_);
    std::swap(layout_, other.layout_);
    std::swap(pipeline_, other.pipeline_);
    return *this;
}

DrawPipeline::~DrawPipeline() {
    if (device_ != nullptr) {
        device_->table().vkDestroyPipeline(device_->handle(), pipeline_, nullptr);
        device_->table().vkDestroyPipelineLayout(device_->handle(), layout_, nullptr);
        device_->table().vkDestroyDescriptorSetLayout(device_->handle(), setLayout_, nullptr);
    }
}

Result<Textures> Textures::create(const device::VulkanDevice& device, std::uint32_t most, VkFilter filter) {
    Textures out;
    out.device_ = &device;
    VkSamplerCreateInfo sampler{};
    sampler.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    sampler.magFilter = filter;
    sampler.minFilter = filter;
    sampler.addressModeU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    sampler.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    sampler.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    VkResult result =
        createdOrNull(device.table().vkCreateSampler(device.handle(), &sampler, nullptr, &out.sampler_), out.sampler_);
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, most};
    VkDescriptorPoolCreateInfo pool{};
    pool.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool.maxSets = most;
    pool.poolSizeCount = 1;
    pool.pPoolSizes = &size;
    if (result == VK_SUCCESS) {
        result = createdOrNull(device.table().vkCreateDescriptorPool(device.handle(), &pool, nullptr, &out.pool_),
                               out.pool_);
    }
    if (result != VK_SUCCESS) {
        return vulkanError(result, "making the window's textures");
    }
    return out;
}

Textures& Textures::operator=(Textures&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(sampler_, other.sampler_);
    std::swap(pool_, other.pool_);
    return *this;
}

Textures::~Textures() {
    if (device_ != nullptr) {
        device_->table().vkDestroyDescriptorPool(device_->handle(), pool_, nullptr);
        device_->table().vkDestroySampler(device_->handle(), sampler_, nullptr);
    }
}

Result<VkDescriptorSet> Textures::add(VkDescriptorSetLayout layout) {
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = pool_;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkResult result = device_->table().vkAllocateDescriptorSets(device_->handle(), &info, &set);
    return result == VK_SUCCESS ? Result<VkDescriptorSet>(set) : vulkanError(result, "making a texture of the window");
}

void Textures::set(VkDescriptorSet set, VkImageView view, VkImageLayout layout) const {
    const VkDescriptorImageInfo image{sampler_, view, layout};
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.descriptorCount = 1;
    write.descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    write.pImageInfo = &image;
    device_->table().vkUpdateDescriptorSets(device_->handle(), 1, &write, 0, nullptr);
}

void memoryBarrier(const device::VulkanDevice& device, VkCommandBuffer commands, const BarrierSide& before,
                   const BarrierSide& after) {
    const VkMemoryBarrier2 barrier = between<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2, before, after);
    VkDependencyInfo info{};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &barrier;
    wait(device, commands, info);
}

void layoutBarrier(const device::VulkanDevice& device, VkCommandBuffer commands, const LayoutChange& change,
                   const BarrierSide& before, const BarrierSide& after) {
    auto barrier = between<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2, before, after);
    barrier.oldLayout = change.from;
    barrier.newLayout = change.to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = change.image;
    barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    VkDependencyInfo info{};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    wait(device, commands, info);
}

Result<void> submitAndWait(const device::Session& session, const std::function<void(VkCommandBuffer)>& record) {
    Result<device::TimedSubmission> submission = device::TimedSubmission::create(session);
    VOXTACT_TRY(submission);
    VOXTACT_TRY(submission->run([&record](VkCommandBuffer commands) -> Result<void> {
        record(commands);
        return {};
    }));
    return {};
}

Result<Drawing> Drawing::create(const device::VulkanDevice& device, const DrawPipelineDesc& desc,
                                std::uint32_t mostTextures, VkFilter filter) {
    Drawing out;
    Result<DrawPipeline> pipeline = DrawPipeline::create(device, desc);
    VOXTACT_TRY(pipeline);
    out.pipeline = std::move(*pipeline);
    Result<Textures> textures = Textures::create(device, mostTextures, filter);
    VOXTACT_TRY(textures);
    out.textures = std::move(*textures);
    return out;
}

void beginRendering(const device::VulkanDevice& device, VkCommandBuffer commands, VkImageView view,
                    VkImageLayout layout, VkExtent2D extent) {
    VkRenderingAttachmentInfo colour{};
    colour.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
    colour.imageView = view;
    colour.imageLayout = layout;
    colour.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    colour.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo info{};
    info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
    info.renderArea.extent = extent;
    info.layerCount = 1;
    info.colorAttachmentCount = 1;
    info.pColorAttachments = &colour;
    device.table().vkCmdBeginRendering(commands, &info);
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    const VkRect2D scissor{{}, extent};
    device.table().vkCmdSetViewport(commands, 0, 1, &viewport);
    device.table().vkCmdSetScissor(commands, 0, 1, &scissor);
}

} // namespace voxtact::view
