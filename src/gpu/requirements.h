// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/device_functions.h"
#include "gpu/float_controls.h"
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

/// What no feature struct says.
struct DeviceSupport {
    bool fragmentBallotAndShuffle = false; ///< subgroup operations of the stages
    bool computeArithmetic = false;
    bool computeBuffers = false; ///< kComputeStorageBuffers in the compute stage
};

/// Storage buffers of the compute stage: bricks, the table's extremes, transforms, results, vertices, indices. Vulkan
/// promises four.
inline constexpr std::uint32_t kComputeStorageBuffers = 6;

[[nodiscard]] FloatControls readFloatControls(const VkPhysicalDeviceFloatControlsProperties& properties) noexcept;
/// Null reads as nothing enabled.
[[nodiscard]] EnabledFeatures readFeatures(const VkPhysicalDeviceFeatures2* features) noexcept;
[[nodiscard]] bool debugUtilsEnabled(const ContextDesc& desc) noexcept;
[[nodiscard]] bool conservativeRasterizationEnabled(const ContextDesc& desc) noexcept;

} // namespace voxtact
