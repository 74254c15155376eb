// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace voxtact {

/// What a device promises of the floats of a shader that asks for it, those of 32 bits where nothing else is said.
/// Nothing of it can be taken for granted.
struct FloatControls {
    bool keepsSpecials = false;   ///< signed zeros, infinities and NaN are what IEEE 754 says
    bool roundsToNearest = false; ///< ties to even
    bool keepsDenormals = false;
    /// Why there are no doubles that keep to the first two: the feature or property that is missing, as Vulkan spells
    /// it. Null: there are.
    const char* missingForDoubles = "shaderFloat64";

    [[nodiscard]] bool doubles() const noexcept { return missingForDoubles == nullptr; }
};

/// The module, every entry point of which asks for what the device promises (SPV_KHR_float_controls, which is part of
/// SPIR-V from 1.4 on). Of one that has doubles that is the rounding and the specials of both widths, and nothing about
/// denormals, which a device may have to treat alike. `spirv`: a valid module of version 1.4 or later that does not
/// yet.
[[nodiscard]] std::vector<std::uint32_t> withFloatControls(std::span<const std::uint32_t> spirv,
                                                           const FloatControls& promised);

} // namespace voxtact
