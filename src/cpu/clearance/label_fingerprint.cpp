// SPDX-License-Identifier: MIT
#include "cpu/clearance/label_fingerprint.h"

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <span>

namespace voxtact::cpu {

namespace {

/// An odd multiplier and a rotation: each step is a bijection of the state for any word, and of the word for any state.
constexpr std::uint64_t kMultiplier = 0x9e3779b97f4a7c15ULL;

std::uint64_t mixed(std::uint64_t state, std::uint64_t word) noexcept {
    return std::rotl((state ^ word) * kMultiplier, 29);
}

/// In lanes that do not wait for each other's product.
std::uint64_t mixed(std::uint64_t state, std::span<const std::byte> bytes) noexcept {
    constexpr std::size_t kLanes = 4;
    constexpr std::size_t kStep = kLanes * sizeof(std::uint64_t);
    std::array<std::uint64_t, kLanes> lanes{state, state + 1, state + 2, state + 3};
    const auto take = [&lanes](const std::byte* from) {
        std::array<std::uint64_t, kLanes> words{};
        std::memcpy(words.data(), from, kStep);
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            lanes[lane] = mixed(lanes[lane], words[lane]);
        }
    };
    std::size_t at = 0;
    for (; at + kStep <= bytes.size(); at += kStep) {
        take(&bytes[at]);
    }
    std::array<std::byte, kStep> rest{};
    if (at < bytes.size()) {
        std::memcpy(rest.data(), &bytes[at], bytes.size() - at);
    }
    take(rest.data());
    std::uint64_t out = mixed(state, bytes.size());
    for (const std::uint64_t lane : lanes) {
        out = mixed(out, lane);
    }
    return out;
}

template <class Numbers> std::uint64_t mixedNumbers(std::uint64_t state, const Numbers& numbers) noexcept {
    return mixed(state, std::as_bytes(std::span(numbers)));
}

} // namespace

std::uint64_t labelFingerprint(const LabelData& labels) noexcept {
    std::uint64_t out = mixedNumbers(kMultiplier, labels.grid.size);
    out = mixedNumbers(out, labels.grid.spacing);
    out = mixedNumbers(out, labels.grid.origin);
    out = mixedNumbers(out, labels.grid.direction);
    out = mixedNumbers(out, labels.values);
    return mixedNumbers(out, labels.indices);
}

} // namespace voxtact::cpu
