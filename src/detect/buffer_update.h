// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/context_impl.h"

#include <array>

namespace voxtact {

/// vkCmdUpdateBuffer takes at most 65536 bytes.
inline constexpr std::size_t kMostUpdateBytes = 65536;

/// Collects records of one type and updates a buffer from `offset` on with as many at once as Vulkan takes.
template <class Record> class BufferUpdate {
  public:
    BufferUpdate(const ContextImpl& context, VkCommandBuffer commandBuffer, VkBuffer buffer, VkDeviceSize offset = 0)
        : context_(context), commandBuffer_(commandBuffer), buffer_(buffer), offset_(offset) {}

    void add(const Record& record) {
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
        if (pending_ > 0) {
            context_.vk.CmdUpdateBuffer(commandBuffer_, buffer_, offset_ + written_ * sizeof(Record),
                                        pending_ * sizeof(Record), records_.data());
            written_ += pending_;
            pending_ = 0;
        }
    }

  private:
    const ContextImpl& context_;
    VkCommandBuffer commandBuffer_;
    VkBuffer buffer_;
    VkDeviceSize offset_;
    std::array<Record, kMostUpdateBytes / sizeof(Record)> records_;
    std::size_t pending_ = 0;
    VkDeviceSize written_ = 0;
};

} // namespace voxtact
