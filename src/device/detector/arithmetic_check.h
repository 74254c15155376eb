// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/context.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace voxtact {

/// What a device makes of the operations that exactness rests on.
struct ArithmeticVerdict {
    std::uint32_t operations = 0; ///< asked
    std::string wrong;            ///< names of those that are not the host's, and the first result; empty: none
};

/// Work groups of inputs that a check takes unless it is told another number: 10^5 inputs, in whole work groups.
inline constexpr std::uint32_t kArithmeticGroups = 1563;

/// Does every operation of src/exact/operations.h on the device, on 64 inputs for each of `groups` (not 0), most of
/// them random, and compares the results with the host's bit for bit: 32-bit floats (rounding, no contraction, no
/// reassociation, NaN and infinities where the device promises them), conversions, doubles where the device has
/// them, integers of 32 bits and of two words, additions in shared memory, and the texels of every type of voxels that
/// the device takes. Denormals are left out: nothing rests on them. Blocks. Needs what the counting method `compute`
/// needs.
[[nodiscard]] Result<ArithmeticVerdict> checkArithmetic(const Context& context, const QueueAccess& queue,
                                                        std::uint32_t groups = kArithmeticGroups);

/// The words that operations are asked about, OPERATION_INPUTS for each of `count` sets: random ones, and many that are
/// special or nearly equal. The same for the same count.
[[nodiscard]] std::vector<std::uint32_t> operationInputs(std::size_t count);

/// How many of an operation's results are not the host's, and which is the first.
struct OperationFaults {
    std::size_t count = 0;
    std::size_t first = 0; ///< number of the set of inputs
};

/// Of OPERATION_RESULTS words for each set of inputs. Those that rest on denormals are not asked. Stops at `most`.
[[nodiscard]] OperationFaults operationFaults(int operation, std::span<const std::uint32_t> inputs,
                                              std::span<const std::uint32_t> results, std::size_t most = SIZE_MAX);

/// What an operation is called in texts.
[[nodiscard]] const char* operationName(int operation) noexcept;

} // namespace voxtact
