// SPDX-License-Identifier: MIT
// What PretendDriver records, and the copies and fills that it executes.
#include "pretend_state.h"

#include <algorithm>
#include <cstring>

namespace voxtact::test::pretended {

namespace {

/// The command buffer that is being recorded; null, with a complaint, where it is not.
PretendCommandBuffer* recording(VkCommandBuffer handle) {
    PretendState& s = pretend();
    PretendCommandBuffer* buffer = s.get(s.commandBuffers, handle);
    if (buffer != nullptr && buffer->state != PretendCommandBuffer::State::Recording) {
        s.complain("a command is recorded into a command buffer that was not begun");
        return nullptr;
    }
    return buffer;
}

void record(VkCommandBuffer handle, std::vector<Id> uses, std::function<void()> execute) {
    if (PretendCommandBuffer* buffer = recording(handle)) {
        buffer->commands.push_back({std::move(uses), std::move(execute)});
    }
}

template <class Change> void bind(VkCommandBuffer handle, Change&& change) {
    if (PretendCommandBuffer* buffer = recording(handle)) {
        change(buffer->bound);
    }
}

void copy(std::span<const std::byte> from, std::span<std::byte> to) {
    if (from.size() != to.size()) {
        return; // one of them is missing, which was complained of
    }
    std::memcpy(to.data(), from.data(), from.size());
}

/// Visits the rows of a region of an image: its bytes there, and where the row is in a packed buffer.
template <class Visit> void forEachRow(VkImage handle, const VkBufferImageCopy& region, Visit&& visit) {
    PretendState& s = pretend();
    const PretendImage* image = s.get(s.images, handle);
    const std::span<std::byte> bytes = image == nullptr ? std::span<std::byte>() : s.imageBytes(bitsOf(handle));
    if (bytes.empty()) {
        return;
    }
    const std::size_t row = image->texelBytes * region.imageExtent.width;
    VkDeviceSize packed = region.bufferOffset;
    for (std::uint32_t z = 0; z < region.imageExtent.depth; ++z) {
        for (std::uint32_t y = 0; y < region.imageExtent.height; ++y, packed += row) {
            const std::size_t at = ((static_cast<std::size_t>(region.imageOffset.z) + z) * image->extent.height +
                                    static_cast<std::size_t>(region.imageOffset.y) + y) *
                                       image->extent.width +
                                   static_cast<std::size_t>(region.imageOffset.x);
            visit(bytes.subspan(at * image->texelBytes, row), packed);
        }
    }
}

std::vector<Id> usesOf(const Bound& bound, VkPipelineBindPoint point) {
    std::vector<Id> uses{point == VK_PIPELINE_BIND_POINT_GRAPHICS ? bound.graphics : bound.compute, bound.queries};
    uses.insert(uses.end(), bound.sets[point].begin(), bound.sets[point].end());
    if (point == VK_PIPELINE_BIND_POINT_GRAPHICS) {
        uses.insert(uses.end(), bound.colours.begin(), bound.colours.end());
        uses.push_back(bound.vertices[0].buffer);
        uses.push_back(bound.vertices[1].buffer);
        uses.push_back(bound.indices);
    }
    return uses;
}

void recordDraw(VkCommandBuffer handle, std::vector<std::uint32_t> numbers, std::uint32_t firstInstance,
                std::uint32_t instances) {
    if (const PretendCommandBuffer* buffer = recording(handle)) {
        record(handle, usesOf(buffer->bound, VK_PIPELINE_BIND_POINT_GRAPHICS),
               [bound = buffer->bound, numbers = std::move(numbers), firstInstance, instances] {
                   pretend().draw(bound, numbers, firstInstance, instances);
               });
    }
}

} // namespace

void VKAPI_CALL CmdCopyBuffer(VkCommandBuffer handle, VkBuffer from, VkBuffer to, std::uint32_t count,
                              const VkBufferCopy* regions) {
    record(handle, {bitsOf(from), bitsOf(to)}, [=, all = std::vector(regions, regions + count)] {
        for (const VkBufferCopy& region : all) {
            copy(pretend().bufferBytes(bitsOf(from), region.srcOffset, region.size),
                 pretend().bufferBytes(bitsOf(to), region.dstOffset, region.size));
        }
    });
}
void VKAPI_CALL CmdCopyBufferToImage(VkCommandBuffer handle, VkBuffer from, VkImage to, VkImageLayout,
                                     std::uint32_t count, const VkBufferImageCopy* regions) {
    record(handle, {bitsOf(from), bitsOf(to)}, [=, all = std::vector(regions, regions + count)] {
        for (const VkBufferImageCopy& region : all) {
            forEachRow(to, region, [&](std::span<std::byte> row, VkDeviceSize at) {
                copy(pretend().bufferBytes(bitsOf(from), at, row.size()), row);
            });
        }
    });
}
void VKAPI_CALL CmdCopyImageToBuffer(VkCommandBuffer handle, VkImage from, VkImageLayout, VkBuffer to,
                                     std::uint32_t count, const VkBufferImageCopy* regions) {
    record(handle, {bitsOf(from), bitsOf(to)}, [=, all = std::vector(regions, regions + count)] {
        for (const VkBufferImageCopy& region : all) {
            forEachRow(from, region, [&](std::span<std::byte> row, VkDeviceSize at) {
                copy(row, pretend().bufferBytes(bitsOf(to), at, row.size()));
            });
        }
    });
}
void VKAPI_CALL CmdFillBuffer(VkCommandBuffer handle, VkBuffer to, VkDeviceSize offset, VkDeviceSize size,
                              std::uint32_t word) {
    record(handle, {bitsOf(to)}, [=] {
        const std::span<std::byte> bytes = pretend().bufferBytes(bitsOf(to), offset, size);
        for (std::size_t at = 0; at + sizeof word <= bytes.size(); at += sizeof word) {
            std::memcpy(bytes.data() + at, &word, sizeof word);
        }
    });
}
void VKAPI_CALL CmdUpdateBuffer(VkCommandBuffer handle, VkBuffer to, VkDeviceSize offset, VkDeviceSize size,
                                const void* data) {
    const auto* first = static_cast<const std::byte*>(data);
    record(handle, {bitsOf(to)}, [=, kept = std::vector(first, first + size)] {
        copy(kept, pretend().bufferBytes(bitsOf(to), offset, size));
    });
}

void VKAPI_CALL CmdResetQueryPool(VkCommandBuffer handle, VkQueryPool pool, std::uint32_t first, std::uint32_t count) {
    record(handle, {bitsOf(pool)}, [=] {
        if (PretendQueryPool* found = pretend().get(pretend().queryPools, pool)) {
            std::fill_n(found->values.begin() + first, count, std::nullopt);
        }
    });
}
void VKAPI_CALL CmdBeginQuery(VkCommandBuffer handle, VkQueryPool pool, std::uint32_t query, VkQueryControlFlags) {
    bind(handle, [&](Bound& bound) {
        bound.queries = bitsOf(pool);
        bound.query = query;
    });
    record(handle, {bitsOf(pool)}, [=] {
        if (PretendQueryPool* found = pretend().get(pretend().queryPools, pool)) {
            if (found->values.at(query)) {
                pretend().complain("a query is begun that was not reset");
            }
            found->values.at(query) = 0;
        }
    });
}
void VKAPI_CALL CmdEndQuery(VkCommandBuffer handle, VkQueryPool, std::uint32_t) {
    bind(handle, [](Bound& bound) { bound.queries = 0; });
}
void VKAPI_CALL CmdCopyQueryPoolResults(VkCommandBuffer handle, VkQueryPool pool, std::uint32_t first,
                                        std::uint32_t count, VkBuffer to, VkDeviceSize offset, VkDeviceSize stride,
                                        VkQueryResultFlags) {
    record(handle, {bitsOf(pool), bitsOf(to)}, [=] {
        PretendState& s = pretend();
        const PretendQueryPool* found = s.get(s.queryPools, pool);
        for (std::uint32_t i = 0; found != nullptr && i < count; ++i) {
            const std::optional<std::uint64_t>& value = found->values.at(first + i);
            if (!value) {
                s.complain("a query is copied that has no result");
                return;
            }
            copy(std::as_bytes(std::span(&*value, 1)), s.bufferBytes(bitsOf(to), offset + i * stride, sizeof *value));
        }
    });
}
void VKAPI_CALL CmdWriteTimestamp2(VkCommandBuffer handle, VkPipelineStageFlags2, VkQueryPool pool,
                                   std::uint32_t query) {
    record(handle, {bitsOf(pool)}, [=] {
        if (PretendQueryPool* found = pretend().get(pretend().queryPools, pool)) {
            found->values.at(query) = pretend().ticks += 1000;
        }
    });
}
void VKAPI_CALL CmdPipelineBarrier2(VkCommandBuffer handle, const VkDependencyInfo* info) {
    std::vector<Id> uses;
    for (std::uint32_t i = 0; i < info->imageMemoryBarrierCount; ++i) {
        uses.push_back(bitsOf(info->pImageMemoryBarriers[i].image));
    }
    record(handle, std::move(uses), [] {});
}

void VKAPI_CALL CmdBindPipeline(VkCommandBuffer handle, VkPipelineBindPoint point, VkPipeline pipeline) {
    bind(handle, [&](Bound& bound) {
        (point == VK_PIPELINE_BIND_POINT_GRAPHICS ? bound.graphics : bound.compute) = bitsOf(pipeline);
    });
}
void VKAPI_CALL CmdBindDescriptorSets(VkCommandBuffer handle, VkPipelineBindPoint point, VkPipelineLayout,
                                      std::uint32_t first, std::uint32_t count, const VkDescriptorSet* sets,
                                      std::uint32_t, const std::uint32_t*) {
    bind(handle, [&](Bound& bound) {
        for (std::uint32_t i = 0; i < count; ++i) {
            bound.sets.at(point).at(first + i) = bitsOf(sets[i]);
        }
    });
}
void VKAPI_CALL CmdBindVertexBuffers2(VkCommandBuffer handle, std::uint32_t first, std::uint32_t count,
                                      const VkBuffer* buffers, const VkDeviceSize* offsets, const VkDeviceSize*,
                                      const VkDeviceSize* strides) {
    bind(handle, [&](Bound& bound) {
        for (std::uint32_t i = 0; i < count; ++i) {
            bound.vertices.at(first + i) = {bitsOf(buffers[i]), offsets[i], strides[i]};
        }
    });
}
void VKAPI_CALL CmdBindIndexBuffer(VkCommandBuffer handle, VkBuffer buffer, VkDeviceSize offset, VkIndexType) {
    bind(handle, [&](Bound& bound) {
        bound.indices = bitsOf(buffer);
        bound.indexOffset = offset;
    });
}
void VKAPI_CALL CmdPushConstants(VkCommandBuffer handle, VkPipelineLayout, VkShaderStageFlags, std::uint32_t offset,
                                 std::uint32_t size, const void* values) {
    bind(handle, [&](Bound& bound) { std::memcpy(bound.constants.data() + offset, values, size); });
}
void VKAPI_CALL CmdSetViewport(VkCommandBuffer handle, std::uint32_t, std::uint32_t, const VkViewport* viewports) {
    bind(handle, [&](Bound& bound) { bound.viewport = *viewports; });
}
void VKAPI_CALL CmdSetScissor(VkCommandBuffer handle, std::uint32_t, std::uint32_t, const VkRect2D*) {
    recording(handle);
}
void VKAPI_CALL CmdBeginRendering(VkCommandBuffer handle, const VkRenderingInfo* info) {
    for (const VkRenderingAttachmentInfo& colour : std::span(info->pColorAttachments, info->colorAttachmentCount)) {
        bind(handle, [&](Bound& bound) { bound.colours.push_back(bitsOf(colour.imageView)); });
        if (colour.loadOp == VK_ATTACHMENT_LOAD_OP_CLEAR) {
            record(handle, {bitsOf(colour.imageView)}, [=, clear = colour.clearValue.color.uint32[0]] {
                if (const PretendImageView* view = pretend().get(pretend().views, colour.imageView)) {
                    std::ranges::fill(pretend().imageBytes(view->image), static_cast<std::byte>(clear >> 16U));
                }
            });
        }
    }
}
void VKAPI_CALL CmdEndRendering(VkCommandBuffer handle) {
    bind(handle, [](Bound& bound) { bound.colours.clear(); });
}

void VKAPI_CALL CmdDraw(VkCommandBuffer handle, std::uint32_t vertices, std::uint32_t instances,
                        std::uint32_t firstVertex, std::uint32_t firstInstance) {
    recordDraw(handle, {vertices, firstVertex}, firstInstance, instances);
}
void VKAPI_CALL CmdDrawIndexed(VkCommandBuffer handle, std::uint32_t indices, std::uint32_t instances,
                               std::uint32_t firstIndex, std::int32_t, std::uint32_t firstInstance) {
    recordDraw(handle, {indices, firstIndex, 1}, firstInstance, instances);
}
void VKAPI_CALL CmdDispatch(VkCommandBuffer handle, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    if (const PretendCommandBuffer* buffer = recording(handle)) {
        record(handle, usesOf(buffer->bound, VK_PIPELINE_BIND_POINT_COMPUTE),
               [bound = buffer->bound, numbers = std::array{x, y, z}] { pretend().dispatch(bound, numbers); });
    }
}
void VKAPI_CALL CmdDispatchIndirect(VkCommandBuffer handle, VkBuffer from, VkDeviceSize offset) {
    if (const PretendCommandBuffer* buffer = recording(handle)) {
        std::vector<Id> uses = usesOf(buffer->bound, VK_PIPELINE_BIND_POINT_COMPUTE);
        uses.push_back(bitsOf(from));
        record(handle, std::move(uses), [bound = buffer->bound, from, offset] {
            std::array<std::uint32_t, 3> numbers{};
            copy(pretend().bufferBytes(bitsOf(from), offset, sizeof numbers),
                 std::as_writable_bytes(std::span(numbers)));
            if (std::ranges::count(numbers, 0U) == 0) {
                pretend().dispatch(bound, numbers);
            }
        });
    }
}

} // namespace voxtact::test::pretended
