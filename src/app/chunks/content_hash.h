// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace voxtact::app {

/// 128 bits of bytes: the same for the same bytes, however they come. It finds what was damaged or exchanged, by chance
/// or by mistake; it does not resist somebody who wants two contents to have one hash.
class ContentHash {
  public:
    void add(std::string_view bytes) noexcept;
    [[nodiscard]] std::uint64_t length() const noexcept { return length_; }
    /// Of all that was added: 32 hexadecimal digits.
    [[nodiscard]] std::string hex() const;

  private:
    void addWord(std::uint64_t word) noexcept;

    static constexpr std::size_t kWord = sizeof(std::uint64_t);

    std::uint64_t one_ = 0x243f6a8885a308d3; // digits of pi
    std::uint64_t two_ = 0x13198a2e03707344;
    std::uint64_t length_ = 0;
    unsigned char rest_[kWord] = {}; ///< what does not fill a word
};

[[nodiscard]] std::string hashOf(std::string_view bytes);

} // namespace voxtact::app
