// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/memory.h"

#include <compare>
#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

namespace voxtact {

/// A 32-bit specialization constant.
struct ShaderConstant {
    std::uint32_t id;
    std::uint32_t value;

    friend auto operator<=>(const ShaderConstant&, const ShaderConstant&) = default;
};

/// Which compute pipeline it is. `spirv`: where the words are.
struct PipelineKey {
    const std::uint32_t* spirv;
    VkPipelineLayout layout;
    std::vector<ShaderConstant> constants;

    friend auto operator<=>(const PipelineKey&, const PipelineKey&) = default;
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
