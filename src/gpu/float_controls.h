// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace voxtact {

/// What a device promises of the 32-bit floats of a shader that asks for it. Nothing of it can be taken for granted.
struct FloatControls {
    bool keepsSpecials = false;   ///< signed zeros, infinities and NaN are what IEEE 754 says
    bool roundsToNearest = false; ///< ties to even
    bool keepsDenormals = false;
};

/// The module, every entry point of which asks for what the device promises (SPV_KHR_float_controls, which is part of
/// SPIR-V from 1.4 on). `spirv`: a valid module of version 1.4 or later that does not yet.
[[nodiscard]] std::vector<std::uint32_t> withFloatControls(std::span<const std::uint32_t> spirv,
                                                           const FloatControls& promised);

} // namespace voxtact
