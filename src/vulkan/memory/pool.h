// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/context.h"
#include "vulkan/memory/block_ranges.h"
#include "vulkan/memory/owned.h"

#include <list>
#include <mutex>

namespace voxtact {

enum class MemoryUse {
    Device,   ///< device-local
    Upload,   ///< host-visible, written by the host in order, mapped
    ReadBack, ///< host-visible, cached where there is such memory, mapped
};

/// A buffer or image that needs memory.
struct MemoryNeed {
    VkMemoryRequirements requirements{};
    MemoryUse use = MemoryUse::Device;
    VkBuffer buffer = VK_NULL_HANDLE; ///< or
    VkImage image = VK_NULL_HANDLE;
    const char* what = nullptr; ///< for errors ("the volume")
    const char* name = nullptr; ///< for debugging
};

struct MemoryBlock;

/// The memory of one buffer or image. Goes back to the pool or to the caller's allocator when it ends. Move-only.
class Memory {
  public:
    Memory() = default;
    Memory(Memory&& other) noexcept;
    Memory& operator=(Memory&& other) noexcept;
    ~Memory() { reset(); }

    [[nodiscard]] const DeviceMemory& get() const noexcept { return place_; }
    /// The range for flushes and invalidations; nothing where memory is coherent.
    [[nodiscard]] std::optional<VkMappedMemoryRange> incoherent() const noexcept;

  private:
    friend class MemoryPool;
    Memory(ContextImpl& context, const DeviceMemory& place) noexcept : context_(&context), place_(place) {}
    void reset() noexcept;

    ContextImpl* context_ = nullptr; ///< null: there is nothing
    DeviceMemory place_{};
    MemoryBlock* block_ = nullptr;     ///< of the pool; null: the caller's
    VkDeviceSize incoherentBytes_ = 0; ///< whole atoms; 0: coherent
};

/// Memory for all buffers and images of a context: the caller's, by ContextDesc::memory, or ranges of blocks. Buffers,
/// mapped buffers and images have blocks of their own, so that bufferImageGranularity never matters and a block of
/// mapped buffers stays mapped. What needs more than a quarter of the largest block has a block of its own.
/// Thread-safe.
class MemoryPool {
  public:
    MemoryPool();
    MemoryPool(const MemoryPool&) = delete;
    MemoryPool& operator=(const MemoryPool&) = delete;
    ~MemoryPool();

    /// LimitExceeded beyond the largest allocation; OutOfMemory where the device has no room.
    [[nodiscard]] static Result<Memory> allocate(ContextImpl& context, const MemoryNeed& need);

  private:
    friend class Memory;
    Result<Memory> take(ContextImpl& context, const MemoryNeed& need);
    void giveBack(MemoryBlock& block, VkDeviceSize begin) noexcept;

    std::mutex mutex_;
    std::list<MemoryBlock> blocks_;
};

} // namespace voxtact
