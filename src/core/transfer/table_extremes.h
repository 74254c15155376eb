// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxtact {

/// The greatest and the least of any run of entries of a transfer function's table, in two look-ups each: a sparse
/// table (Bender and Farach-Colton, "The LCA problem revisited", 2000). A NaN is taken for minus infinity: what it has
/// a part in is never opaque.
class TableExtremes {
  public:
    TableExtremes() = default;
    explicit TableExtremes(std::span<const float> table);

    /// The levels K of a table of N entries, each for runs of 2^k: floor(log2(N)) + 1.
    [[nodiscard]] static std::uint32_t levelsOf(std::size_t entries) noexcept;
    [[nodiscard]] std::uint32_t levels() const noexcept { return levelsOf(entries_); }
    /// As the device has it: the greatest of entries i to i + 2^k - 1 at [k * N + i], the least at [(K + k) * N + i].
    /// Runs that leave the table end with it. Level 0 of the greatest is the table.
    [[nodiscard]] std::span<const float> values() const noexcept { return values_; }
    /// The greatest of entries `first` to `last`, both of them in the table and included.
    [[nodiscard]] float greatest(std::uint32_t first, std::uint32_t last) const noexcept;
    [[nodiscard]] float least(std::uint32_t first, std::uint32_t last) const noexcept;

  private:
    std::uint32_t entries_ = 0;
    std::vector<float> values_;
};

} // namespace voxtact
