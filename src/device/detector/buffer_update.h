// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/context_impl.h"

#include <array>
#include <cstring>

namespace voxtact {

/// vkCmdUpdateBuffer takes at most 65536 bytes.
inline constexpr std::size_t kMostUpdateBytes = 65536;

/// Mapped memory that what a batch is recorded with goes through, instead of the command buffer.
struct Staging {
    const Buffer* buffer = nullptr; ///< null: it goes into the command buffer
    VkDeviceSize used = 0;
};

/// Collects records of one type and updates a buffer from `offset` on with as many at once as Vulkan takes, or copies
/// them from the staging memory, which must have room for them.
template <class Record> class BufferUpdate {
  public:
    BufferUpdate(const ContextImpl& context, VkCommandBuffer commandBuffer, VkBuffer buffer, VkDeviceSize offset = 0,
                 Staging* staging = nullptr)
        : context_(context), commandBuffer_(commandBuffer), buffer_(buffer), offset_(offset),
          staging_(staging != nullptr && staging->buffer != nullptr ? staging : nullptr) {}

    void add(const Record& record) {
        if (staging_ != nullptr) {
            const VkDeviceSize at = staging_->used + pending_ * sizeof(Record);
            std::memcpy(static_cast<std::byte*>(staging_->buffer->mapped) + at, &record, sizeof record);
            ++pending_;
            return;
        }
        records_[pending_++] = record;
        if (pending_ == records_.size()) {
            finish();
        }
    }
    /// Leaves the next records as they are.
    void skip(std::size_t records) {
        finish();
        written_ += records;
    }
    void finish() {
        if (pending_ == 0) {
            return;
        }
        const VkDeviceSize to = offset_ + written_ * sizeof(Record);
        const VkDeviceSize bytes = pending_ * sizeof(Record);
        if (staging_ != nullptr) {
            const VkBufferCopy region{staging_->used, to, bytes};
            context_.vk.CmdCopyBuffer(commandBuffer_, staging_->buffer->get(), buffer_, 1, &region);
            staging_->used += bytes;
        } else {
            context_.vk.CmdUpdateBuffer(commandBuffer_, buffer_, to, bytes, records_.data());
        }
        written_ += pending_;
        pending_ = 0;
    }

  private:
    const ContextImpl& context_;
    VkCommandBuffer commandBuffer_;
    VkBuffer buffer_;
    VkDeviceSize offset_;
    Staging* staging_;
    std::array<Record, kMostUpdateBytes / sizeof(Record)> records_;
    std::size_t pending_ = 0;
    VkDeviceSize written_ = 0;
};

} // namespace voxtact
