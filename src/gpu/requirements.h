// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/device_functions.h"
#include "voxtact/context.h"

namespace voxtact {

/// The features of requirements(), read from a chain.
struct EnabledFeatures {
    bool dynamicRendering = false;
    bool synchronization2 = false;
    bool occlusionQueryPrecise = false;
    bool fragmentStoresAndAtomics = false;
    bool shaderInt64 = false;
    bool geometryShader = false;
};

/// What no feature struct says: the subgroup operations of the stages.
struct SubgroupSupport {
    bool fragmentBallotAndShuffle = false;
    bool computeArithmetic = false;
};

/// Null reads as nothing enabled.
[[nodiscard]] EnabledFeatures readFeatures(const VkPhysicalDeviceFeatures2* features) noexcept;
[[nodiscard]] bool debugUtilsEnabled(const ContextDesc& desc) noexcept;
[[nodiscard]] bool conservativeRasterizationEnabled(const ContextDesc& desc) noexcept;

} // namespace voxtact
