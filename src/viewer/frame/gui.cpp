// SPDX-License-Identifier: MIT
#include "viewer/frame/gui.h"

#include "core/base/try.h"
#include "voxtact_shaders/gui_frag.h"
#include "voxtact_shaders/gui_vert.h"

#include <imgui.h>

#include <algorithm>
#include <cstring>

namespace voxtact::view {

namespace {

constexpr std::uint32_t kMostTextures = 9; // the font's among them

/// The push constants of gui.vert.
struct Placement {
    float scale[2];
    float offset[2];
    std::array<float, 2> used;
    std::array<float, 2> most;
};

/// Grows to at least this size, and by at least half to grow rarely.
Result<void> grow(const device::VulkanDevice& device, HostBuffer& buffer, std::size_t bytes, VkBufferUsageFlags usage) {
    if (buffer.bytes().size() >= bytes && !buffer.bytes().empty()) {
        return {};
    }
    constexpr std::size_t kLeast = 1U << 16U;
    Result<HostBuffer> larger = HostBuffer::create(device, std::max(kLeast, bytes + bytes / 2), usage);
    VOXTACT_TRY(larger);
    buffer = std::move(*larger);
    return {};
}

/// The part of the window that a command may draw in, within it.
VkRect2D scissorOf(const ImVec4& clip, const ImDrawData& data) {
    const auto within = [](float x, float most) { return std::clamp(x, 0.0F, most); };
    const float right = data.DisplaySize.x * data.FramebufferScale.x;
    const float bottom = data.DisplaySize.y * data.FramebufferScale.y;
    const float left = within((clip.x - data.DisplayPos.x) * data.FramebufferScale.x, right);
    const float top = within((clip.y - data.DisplayPos.y) * data.FramebufferScale.y, bottom);
    const float width = within((clip.z - data.DisplayPos.x) * data.FramebufferScale.x, right) - left;
    const float height = within((clip.w - data.DisplayPos.y) * data.FramebufferScale.y, bottom) - top;
    return {{static_cast<std::int32_t>(left), static_cast<std::int32_t>(top)},
            {static_cast<std::uint32_t>(std::max(width, 0.0F)), static_cast<std::uint32_t>(std::max(height, 0.0F))}};
}

} // namespace

Result<Gui> Gui::create(const device::Session& session, VkFormat format) {
    Gui gui(session.device);
    DrawPipelineDesc desc;
    desc.vertexShader = spirv::gui_vert;
    desc.fragmentShader = spirv::gui_frag;
    desc.format = format;
    desc.pushStages = VK_SHADER_STAGE_VERTEX_BIT;
    desc.pushBytes = sizeof(Placement);
    desc.blended = true;
    desc.guiVertices = true;
    Result<Drawing> drawing = Drawing::create(session.device, desc, kMostTextures, VK_FILTER_LINEAR);
    VOXTACT_TRY(drawing);
    gui.drawing_ = std::move(*drawing);
    VOXTACT_TRY(gui.uploadFont(session));
    return gui;
}

Result<void> Gui::uploadFont(const device::Session& session) {
    unsigned char* pixels = nullptr;
    int width = 0;
    int height = 0;
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
    const VkExtent2D extent{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
    const std::size_t bytes = std::size_t{4} * extent.width * extent.height;
    Result<Image> image = Image::create(*device_, extent, VK_FORMAT_R8G8B8A8_UNORM,
                                        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
    VOXTACT_TRY(image);
    font_ = std::move(*image);
    const Result<HostBuffer> staging = HostBuffer::create(*device_, bytes, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    VOXTACT_TRY(staging);
    std::memcpy(staging->bytes().data(), pixels, bytes);
    VOXTACT_TRY(submitAndWait(session, [&](VkCommandBuffer commands) {
        const BarrierSide copy{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
        layoutBarrier(*device_, commands,
                      {font_.handle(), VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL}, {}, copy);
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {extent.width, extent.height, 1};
        device_->table().vkCmdCopyBufferToImage(commands, staging->handle(), font_.handle(),
                                                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        layoutBarrier(*device_, commands,
                      {font_.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL},
                      copy, {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT});
    }));
    const Result<VkDescriptorSet> texture = addTexture();
    VOXTACT_TRY(texture);
    setTexture(*texture, font_.view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    atlas.SetTexID(static_cast<ImTextureID>(*texture));
    return {};
}

void Gui::place(VkCommandBuffer commands, const ImDrawData& data, const SampledPart& part) const {
    const Placement placement{
        {2 / data.DisplaySize.x, 2 / data.DisplaySize.y},
        {-1 - 2 * data.DisplayPos.x / data.DisplaySize.x, -1 - 2 * data.DisplayPos.y / data.DisplaySize.y},
        part.used,
        part.most};
    device_->table().vkCmdPushConstants(commands, drawing_.pipeline.layout(), VK_SHADER_STAGE_VERTEX_BIT, 0,
                                        sizeof placement, &placement);
}

Result<void> Gui::record(VkCommandBuffer commands, const ImDrawData& data, std::uint32_t slot,
                         const ShownTexture& picture) {
    const auto vertexBytes = static_cast<std::size_t>(data.TotalVtxCount) * sizeof(ImDrawVert);
    const auto indexBytes = static_cast<std::size_t>(data.TotalIdxCount) * sizeof(ImDrawIdx);
    VOXTACT_TRY(grow(*device_, vertices_[slot], vertexBytes, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT));
    VOXTACT_TRY(grow(*device_, indices_[slot], indexBytes, VK_BUFFER_USAGE_INDEX_BUFFER_BIT));
    const VolkDeviceTable& table = device_->table();
    table.vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing_.pipeline.handle());
    const VkDeviceSize none = 0;
    const VkBuffer vertices = vertices_[slot].handle();
    table.vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &none);
    table.vkCmdBindIndexBuffer(commands, indices_[slot].handle(), 0,
                               sizeof(ImDrawIdx) == 2 ? VK_INDEX_TYPE_UINT16 : VK_INDEX_TYPE_UINT32);
    std::size_t firstVertex = 0;
    std::size_t firstIndex = 0;
    for (int list = 0; list < data.CmdListsCount; ++list) {
        const ImDrawList& one = *data.CmdLists[list];
        std::memcpy(vertices_[slot].bytes().data() + firstVertex * sizeof(ImDrawVert), one.VtxBuffer.Data,
                    static_cast<std::size_t>(one.VtxBuffer.Size) * sizeof(ImDrawVert));
        std::memcpy(indices_[slot].bytes().data() + firstIndex * sizeof(ImDrawIdx), one.IdxBuffer.Data,
                    static_cast<std::size_t>(one.IdxBuffer.Size) * sizeof(ImDrawIdx));
        for (const ImDrawCmd& draw : one.CmdBuffer) {
            const VkRect2D scissor = scissorOf(draw.ClipRect, data);
            if (draw.ElemCount == 0 || scissor.extent.width == 0 || scissor.extent.height == 0) {
                continue;
            }
            auto* texture = static_cast<VkDescriptorSet>(draw.GetTexID());
            const bool isPicture = texture == picture.panels;
            texture = isPicture ? picture.drawn : texture;
            place(commands, data, isPicture ? picture.part : SampledPart{});
            table.vkCmdSetScissor(commands, 0, 1, &scissor);
            table.vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, drawing_.pipeline.layout(), 0, 1,
                                          &texture, 0, nullptr);
            table.vkCmdDrawIndexed(commands, draw.ElemCount, 1, static_cast<std::uint32_t>(firstIndex) + draw.IdxOffset,
                                   static_cast<std::int32_t>(firstVertex + draw.VtxOffset), 0);
        }
        firstVertex += static_cast<std::size_t>(one.VtxBuffer.Size);
        firstIndex += static_cast<std::size_t>(one.IdxBuffer.Size);
    }
    return {};
}

} // namespace voxtact::view
