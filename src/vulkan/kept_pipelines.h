// SPDX-License-Identifier: MIT
#pragma once

#include "vulkan/memory/memory.h"

#include <cstdint>
#include <map>
#include <mutex>
#include <tuple>
#include <vector>

namespace voxtact {

/// A 32-bit specialization constant.
struct ShaderConstant {
    std::uint32_t id;
    std::uint32_t value;

    friend bool operator<(const ShaderConstant& a, const ShaderConstant& b) noexcept {
        return std::tie(a.id, a.value) < std::tie(b.id, b.value);
    }
};

/// Which compute pipeline it is. `spirv`: where the words are.
struct PipelineKey {
    const std::uint32_t* spirv;
    VkPipelineLayout layout;
    std::vector<ShaderConstant> constants;

    friend bool operator<(const PipelineKey& a, const PipelineKey& b) noexcept {
        return std::tie(a.spirv, a.layout, a.constants) < std::tie(b.spirv, b.layout, b.constants);
    }
};

struct KeptPipeline {
    std::mutex making; ///< of `pipeline`
    Owned<VkPipeline> pipeline;
};

/// The compute pipelines of a context, by what they are made of: computePipeline(). Any thread may use it.
class KeptPipelines {
  public:
    /// Stays where it is.
    [[nodiscard]] KeptPipeline& of(const PipelineKey& key) {
        const std::lock_guard lock(mutex_);
        return kept_[key];
    }

  private:
    std::mutex mutex_;
    std::map<PipelineKey, KeptPipeline> kept_;
};

} // namespace voxtact
