// SPDX-License-Identifier: MIT
#include "app/chunks/content_hash.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace voxtact::app {

namespace {

/// Odd, with about as many ones as zeros: fractions of the square roots of 2 and 3.
constexpr std::uint64_t kOne = 0x6a09e667f3bcc909;
constexpr std::uint64_t kTwo = 0xbb67ae8584caa73b;

std::uint64_t spread(std::uint64_t bits) noexcept {
    for (const std::uint64_t factor : {kOne, kTwo, kOne}) {
        bits ^= bits >> 31U;
        bits *= factor;
    }
    return bits ^ (bits >> 29U);
}

void appendHex(std::string& text, std::uint64_t bits) {
    constexpr std::string_view kDigits = "0123456789abcdef";
    for (unsigned shift = 64; shift > 0; shift -= 4) {
        text += kDigits[(bits >> (shift - 4)) & 15U];
    }
}

} // namespace

void ContentHash::addWord(std::uint64_t word) noexcept {
    // Each step can be undone: two states that differ stay different until another word differs.
    one_ = std::rotl((one_ ^ word) * kOne, 29);
    two_ = std::rotl((two_ + word) ^ one_, 37) * kTwo;
}

void ContentHash::add(std::string_view bytes) noexcept {
    const std::size_t held = length_ % kWord;
    length_ += bytes.size();
    if (held > 0) {
        const std::size_t taken = std::min(kWord - held, bytes.size());
        std::memcpy(rest_ + held, bytes.data(), taken);
        bytes.remove_prefix(taken);
        if (held + taken < kWord) {
            return;
        }
        std::uint64_t word = 0;
        std::memcpy(&word, rest_, kWord);
        addWord(word);
    }
    for (; bytes.size() >= kWord; bytes.remove_prefix(kWord)) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes.data(), kWord);
        addWord(word);
    }
    if (!bytes.empty()) {
        std::memcpy(rest_, bytes.data(), bytes.size());
    }
}

std::string ContentHash::hex() const {
    ContentHash whole = *this;
    std::uint64_t word = 0;
    std::memcpy(&word, rest_, length_ % kWord);
    whole.addWord(word);
    whole.addWord(length_);
    std::string text;
    appendHex(text, spread(whole.one_ ^ std::rotl(whole.two_, 17)));
    appendHex(text, spread(whole.two_ + whole.one_));
    return text;
}

std::string hashOf(std::string_view bytes) {
    ContentHash hash;
    hash.add(bytes);
    return hash.hex();
}

} // namespace voxtact::app
