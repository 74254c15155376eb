// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/context.h"
#include "vulkan/device_functions.h"
#include "vulkan/float_controls.h"

#include <optional>

namespace voxtact {

/// The features of requirements(), read from a chain.
struct EnabledFeatures {
    bool dynamicRendering = false;
    bool synchronization2 = false;
    bool occlusionQueryPrecise = false;
    bool fragmentStoresAndAtomics = false;
    bool geometryShader = false;
    bool shaderFloat64 = false;
};

/// What no feature struct says.
struct DeviceSupport {
    bool fragmentBallotAndShuffle = false; ///< subgroup operations of the fragment stage
    bool computeBuffers = false;           ///< kComputeStorageBuffers in the compute stage
    std::optional<FloatControls> floats;   ///< nothing: the device could not be asked
};

/// Storage buffers of the compute stage: bricks, transforms, results, vertices, indices. Vulkan promises four.
inline constexpr std::uint32_t kComputeStorageBuffers = 5;

[[nodiscard]] FloatControls readFloatControls(const VkPhysicalDeviceFloatControlsProperties& properties) noexcept;
/// What the projection certified lacks by the method compute, as Vulkan spells it; null: nothing.
[[nodiscard]] const char* missingFloatControl(const FloatControls& floats) noexcept;
/// Null reads as nothing enabled.
[[nodiscard]] EnabledFeatures readFeatures(const VkPhysicalDeviceFeatures2* features) noexcept;
[[nodiscard]] bool debugUtilsEnabled(const ContextDesc& desc) noexcept;
[[nodiscard]] bool conservativeRasterizationEnabled(const ContextDesc& desc) noexcept;

} // namespace voxtact
