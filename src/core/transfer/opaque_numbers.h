// SPDX-License-Identifier: MIT
#pragma once

#include "core/transfer/opaque_intervals.h"
#include "exact/opaque_values.h"

#include <span>
#include <vector>

namespace voxtact {

/// OpaqueIntervals of stored values as single-precision entries: entry = scale * (stored - reference).
struct OpaqueNumbers {
    float scale = 1; ///< a power of two: values of all magnitudes can be added
    float reference = 0;
    shader::OpaqueValues counts{}; ///< `numbers` is null
    std::vector<float> numbers{};  ///< those of shader::OpaqueValues

    /// Returns a view of these numbers, valid as long as they are.
    [[nodiscard]] shader::OpaqueValues values() const noexcept {
        shader::OpaqueValues out = counts;
        out.numbers = numbers.data();
        return out;
    }
};

/// `whole`: the stored values are integers of 16 bits. The entry of a voxel is in an interval of these only if the
/// voxel is in that of stored values: ends that single precision does not have are rounded outward and inward.
[[nodiscard]] OpaqueNumbers opaqueNumbers(std::span<const ControlPoint> points, double threshold,
                                          const StoredScale& stored, bool whole);

} // namespace voxtact
