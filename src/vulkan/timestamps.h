// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>

namespace voxtact {

/// From one timestamp to a later one, of a counter of so many bits, which may have wrapped in between: what passed is
/// less than half of its range. Nothing where it went backwards, as on some drivers when a core or a clock changes.
inline std::optional<std::uint64_t> ticksBetween(std::uint64_t from, std::uint64_t to, std::uint32_t bits) noexcept {
    const std::uint64_t mask = bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << bits) - 1;
    const std::uint64_t ticks = (to - from) & mask;
    return ticks > mask / 2 ? std::nullopt : std::optional(ticks);
}

} // namespace voxtact
