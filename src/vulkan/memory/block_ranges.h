// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace voxtact {

/// The free and the taken ranges of a block of memory, in bytes. Best fit.
class BlockRanges {
  public:
    explicit BlockRanges(std::uint64_t size);

    /// Takes the smallest free range that has room for `size`, which is not 0, and returns where it begins. Nothing
    /// where there is no such range. May throw std::bad_alloc; nothing is taken then.
    [[nodiscard]] std::optional<std::uint64_t> take(std::uint64_t size, std::uint64_t alignment);
    /// Frees a range that was taken. Allocates nothing, so that it cannot fail.
    void giveBack(std::uint64_t begin) noexcept;
    /// Whether nothing is taken.
    [[nodiscard]] bool empty() const noexcept { return taken_ == 0; }

  private:
    using FreeRanges = std::set<std::pair<std::uint64_t, std::uint64_t>>; ///< size and begin
    struct Range {
        std::uint64_t size = 0;
        FreeRanges::node_type spare{}; ///< of a taken range: its place in FreeRanges, for when it is given back

        [[nodiscard]] bool free() const noexcept { return spare.empty(); }
    };
    using Ranges = std::map<std::uint64_t, Range>; ///< by their begin; together they are the whole block

    /// Cuts the first `size` bytes off a free range, where that leaves two.
    void cut(std::uint64_t begin, std::uint64_t size);
    /// Changes the size of a free range.
    void resize(Ranges::iterator range, std::uint64_t size) noexcept;

    Ranges ranges_;
    FreeRanges free_;
    std::size_t taken_ = 0;
};

} // namespace voxtact
