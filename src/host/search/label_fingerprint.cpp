// SPDX-License-Identifier: MIT
#include "host/search/label_fingerprint.h"

#include <span>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace voxtact::cpu {

namespace {

template <class Numbers> std::uint64_t mixed(std::uint64_t state, const Numbers& numbers) noexcept {
    const auto bytes = std::as_bytes(std::span(numbers));
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), state);
}

} // namespace

std::uint64_t labelFingerprint(const LabelData& labels) noexcept {
    const Grid& grid = labels.grid;
    const std::uint64_t place = mixed(mixed(mixed(mixed(0, grid.size), grid.spacing), grid.origin), grid.direction);
    return mixed(mixed(place, labels.values), labels.indices);
}

} // namespace voxtact::cpu
