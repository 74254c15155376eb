// SPDX-License-Identifier: MIT
#include "vulkan/memory/pool.h"

#include "core/base/try.h"
#include "vulkan/debug.h"

#include <algorithm>
#include <string>
#include <utility>

namespace voxtact {

struct MemoryBlock {
    /// What may share a block.
    enum class Content { Buffers, MappedBuffers, Images };
    struct Kind {
        std::uint32_t type = 0; ///< of the device's memory types
        Content content = Content::Buffers;
        [[nodiscard]] bool operator==(const Kind&) const = default;
    };

    MemoryBlock(Kind ofAll, VkDeviceSize bytes, bool ofOne) : kind(ofAll), size(bytes), alone(ofOne), ranges(bytes) {}

    Kind kind;
    VkDeviceSize size;
    bool alone; ///< dedicated to one buffer or image
    BlockRanges ranges;
    Owned<VkDeviceMemory> memory;
    void* mapped = nullptr;
};

namespace {

/// A block that is no larger stays when it is the only one of its kind, so that making and ending a small object again
/// and again allocates once.
constexpr VkDeviceSize kFirstBlock = VkDeviceSize{1} << 20U;
constexpr VkDeviceSize kLargestBlock = VkDeviceSize{64} << 20U;
constexpr VkDeviceSize kBlocksOfAHeap = 16;
constexpr VkDeviceSize kSharesOfABlock = 4;

constexpr VkMemoryPropertyFlags kVisible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT;
constexpr VkMemoryPropertyFlags kCoherent = kVisible | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

std::optional<std::uint32_t> memoryType(const ContextImpl& context, std::uint32_t allowed,
                                        VkMemoryPropertyFlags wanted) {
    for (std::uint32_t i = 0; i < context.memory.memoryTypeCount; ++i) {
        if ((allowed & (1U << i)) != 0 && (context.memory.memoryTypes[i].propertyFlags & wanted) == wanted) {
            return i;
        }
    }
    return std::nullopt;
}

/// The best type first; the last of each list is what Vulkan guarantees to exist.
std::optional<std::uint32_t> memoryTypeFor(const ContextImpl& context, std::uint32_t allowed, MemoryUse use) {
    constexpr VkMemoryPropertyFlags kWanted[3][3] = {
        {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0, 0},
        {kCoherent, kVisible, kVisible},
        {kCoherent | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, kVisible | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, kVisible},
    };
    for (const VkMemoryPropertyFlags wanted : kWanted[static_cast<std::size_t>(use)]) {
        if (const auto type = memoryType(context, allowed, wanted)) {
            return type;
        }
    }
    return std::nullopt;
}

MemoryRequest requestOf(const MemoryNeed& need) {
    constexpr VkMemoryPropertyFlags kPreferred[3] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0,
                                                     VK_MEMORY_PROPERTY_HOST_CACHED_BIT};
    return {need.requirements,
            need.use == MemoryUse::Device ? 0 : kCoherent,
            kPreferred[static_cast<std::size_t>(need.use)],
            need.buffer,
            need.image,
            need.name};
}

/// Refuses memory of the caller's that cannot be bound.
Result<void> checkGiven(const DeviceMemory& given, const MemoryRequest& request) {
    const auto refused = [&](const char* why) {
        return Error{ErrorCode::InvalidArgument, 0,
                     std::string("ContextDesc::memory.allocate gave ") + why + " for " + request.name};
    };
    if (given.memory == VK_NULL_HANDLE) {
        return refused("no VkDeviceMemory");
    }
    if (given.offset % request.requirements.alignment != 0) {
        return refused("an offset that is not aligned");
    }
    if (request.required != 0 && given.mapped == nullptr) {
        return refused("no host address");
    }
    return {};
}

Error failedAllocation(ContextImpl& context, VkResult result, const MemoryNeed& need) {
    const std::string text =
        "allocating " + std::to_string(need.requirements.size) + " bytes for " + std::string(need.what);
    return context.failure(result, text.c_str());
}

VkDeviceSize largestBlock(const ContextImpl& context, std::uint32_t type) {
    const VkDeviceSize heap = context.memory.memoryHeaps[context.memory.memoryTypes[type].heapIndex].size;
    return std::min({kLargestBlock, heap / kBlocksOfAHeap, context.maxAllocation});
}

/// What a need takes of which blocks.
struct Want {
    MemoryBlock::Kind kind;
    VkDeviceSize bytes = 0;
    VkDeviceSize alignment = 1;
    bool coherent = true;
};

Result<Want> wantOf(const ContextImpl& context, const MemoryNeed& need) {
    using Content = MemoryBlock::Content;
    const auto type = memoryTypeFor(context, need.requirements.memoryTypeBits, need.use);
    if (!type) {
        return Error{ErrorCode::Unsupported, 0, std::string("the device has no memory type for ") + need.what};
    }
    const bool mapped = need.use != MemoryUse::Device;
    const Content ofBuffers = mapped ? Content::MappedBuffers : Content::Buffers;
    Want want{{*type, need.image != VK_NULL_HANDLE ? Content::Images : ofBuffers},
              need.requirements.size,
              need.requirements.alignment};
    want.coherent = (context.memory.memoryTypes[*type].propertyFlags & VK_MEMORY_PROPERTY_HOST_COHERENT_BIT) != 0;
    if (mapped && !want.coherent) { // ranges share no atom: a flush of one would write over the other
        const VkDeviceSize atom = std::max<VkDeviceSize>(context.limits.nonCoherentAtomSize, 1);
        want.alignment = std::max(want.alignment, atom);
        want.bytes = (want.bytes + atom - 1) / atom * atom;
    }
    return want;
}

/// Allocates the memory of a block, and maps it where it is to be.
VkResult fillBlock(ContextImpl& context, MemoryBlock& block, const MemoryNeed& need) {
    VkMemoryDedicatedAllocateInfo dedicated{};
    VkMemoryAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = block.size;
    info.memoryTypeIndex = block.kind.type;
    if (block.alone && block.size == need.requirements.size) { // rounded up, it may not be dedicated
        dedicated.sType = VK_STRUCTURE_TYPE_MEMORY_DEDICATED_ALLOCATE_INFO;
        dedicated.buffer = need.buffer;
        dedicated.image = need.image;
        info.pNext = &dedicated;
    }
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkResult result = context.vk.AllocateMemory(context.device, &info, context.allocator, &memory);
    if (result != VK_SUCCESS) {
        return result;
    }
    block.memory = Owned<VkDeviceMemory>(
        context, memory, [](ContextImpl& c, VkDeviceMemory handle) { c.vk.FreeMemory(c.device, handle, c.allocator); });
    constexpr const char* kNames[] = {"buffers", "mapped buffers", "images"};
    nameObject(context, VK_OBJECT_TYPE_DEVICE_MEMORY, memory,
               block.alone ? need.name : kNames[static_cast<std::size_t>(block.kind.content)]);
    if (block.kind.content == MemoryBlock::Content::MappedBuffers) {
        result = context.vk.MapMemory(context.device, memory, 0, VK_WHOLE_SIZE, 0, &block.mapped);
    }
    return result;
}

/// A list of a new block that has room for a need. `largest` is the size of the largest of its kind.
Result<std::list<MemoryBlock>> makeBlock(ContextImpl& context, const Want& want, const MemoryNeed& need,
                                         VkDeviceSize largest) {
    const VkDeviceSize most = largestBlock(context, want.kind.type);
    const bool shared = want.bytes <= most / kSharesOfABlock;
    const VkDeviceSize size = std::min(std::max({kFirstBlock, 2 * largest, 2 * want.bytes}), most);
    std::list<MemoryBlock> made;
    MemoryBlock* block = &made.emplace_back(want.kind, shared ? size : want.bytes, !shared);
    VkResult result = fillBlock(context, *block, need);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY && shared && !block->memory) { // there may be room for the need alone
        made.clear();
        block = &made.emplace_back(want.kind, want.bytes, true);
        result = fillBlock(context, *block, need);
    }
    if (result != VK_SUCCESS) {
        return failedAllocation(context, result, need);
    }
    return made;
}

} // namespace

Memory::Memory(Memory&& other) noexcept
    : context_(std::exchange(other.context_, nullptr)), place_(other.place_), block_(other.block_),
      incoherentBytes_(other.incoherentBytes_) {}

Memory& Memory::operator=(Memory&& other) noexcept {
    if (this != &other) {
        reset();
        context_ = std::exchange(other.context_, nullptr);
        place_ = other.place_;
        block_ = other.block_;
        incoherentBytes_ = other.incoherentBytes_;
    }
    return *this;
}

std::optional<VkMappedMemoryRange> Memory::incoherent() const noexcept {
    if (incoherentBytes_ == 0) {
        return std::nullopt;
    }
    VkMappedMemoryRange range{};
    range.sType = VK_STRUCTURE_TYPE_MAPPED_MEMORY_RANGE;
    range.memory = place_.memory;
    range.offset = place_.offset;
    range.size = incoherentBytes_;
    return range;
}

void Memory::reset() noexcept {
    ContextImpl* context = std::exchange(context_, nullptr);
    if (context == nullptr || !mayDestroy(*context)) {
        return;
    }
    if (block_ != nullptr) {
        context->pool.giveBack(*block_, place_.offset);
    } else {
        context->memoryCallbacks.release(context->memoryCallbacks.user, &place_);
    }
}

Result<Memory> MemoryPool::allocate(ContextImpl& context, const MemoryNeed& need) {
    if (need.requirements.size > context.maxAllocation) {
        return Error{ErrorCode::LimitExceeded, 0,
                     std::string(need.what) + " needs " + std::to_string(need.requirements.size) +
                         " bytes, the device's maxMemoryAllocationSize is " + std::to_string(context.maxAllocation)};
    }
    const MemoryCallbacks& callbacks = context.memoryCallbacks;
    if (callbacks.allocate == nullptr) {
        return context.pool.take(context, need);
    }
    const MemoryRequest request = requestOf(need);
    DeviceMemory given{};
    if (const VkResult result = callbacks.allocate(callbacks.user, &request, &given); result != VK_SUCCESS) {
        return failedAllocation(context, result, need);
    }
    Memory memory(context, given);
    VOXTACT_TRY(checkGiven(given, request));
    return memory;
}

MemoryPool::MemoryPool() = default;
MemoryPool::~MemoryPool() = default;

Result<Memory> MemoryPool::take(ContextImpl& context, const MemoryNeed& need) {
    const Result<Want> want = wantOf(context, need);
    VOXTACT_TRY(want);
    const std::lock_guard lock(mutex_);
    MemoryBlock* from = nullptr;
    std::optional<VkDeviceSize> begin;
    VkDeviceSize largest = 0;
    for (MemoryBlock& block : blocks_) {
        if (block.kind == want->kind && !begin) {
            largest = std::max(largest, block.size);
            from = &block;
            begin = block.ranges.take(want->bytes, want->alignment);
        }
    }
    if (!begin) {
        Result<std::list<MemoryBlock>> made = makeBlock(context, *want, need, largest);
        VOXTACT_TRY(made);
        from = &made->front();
        begin = from->ranges.take(want->bytes, want->alignment);
        blocks_.splice(blocks_.end(), *made);
    }
    Memory memory(context, {from->memory.get(), *begin, nullptr, nullptr});
    memory.block_ = from;
    if (from->mapped != nullptr) {
        memory.place_.mapped = static_cast<std::byte*>(from->mapped) + *begin;
        memory.incoherentBytes_ = want->coherent ? 0 : want->bytes;
    }
    return memory;
}

void MemoryPool::giveBack(MemoryBlock& block, VkDeviceSize begin) noexcept {
    const std::lock_guard lock(mutex_);
    block.ranges.giveBack(begin);
    const auto sameKind = [&](const MemoryBlock& other) { return other.kind == block.kind; };
    const bool stays = !block.alone && block.size <= kFirstBlock && std::ranges::count_if(blocks_, sameKind) == 1;
    if (block.ranges.empty() && !stays) {
        blocks_.remove_if([&](const MemoryBlock& other) { return &other == &block; });
    }
}

} // namespace voxtact
