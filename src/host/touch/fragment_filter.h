// SPDX-License-Identifier: MIT
#pragma once

#include "exact/certified.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace voxtact::cpu {

/// Decides many fragments at a time with few comparisons: first by the range of the interpolant in the box of the
/// triangle's part in the cell, then by the corners of that part. Not thread-safe.
class FragmentFilter {
  public:
    static constexpr std::size_t kMost = 128;
    static constexpr std::size_t kMostLanes = 16;
    static_assert(kMost % kMostLanes == 0);

    struct Fragment {
        std::array<shader::VoxelPoint, 3> triangle{}; ///< finite
        float delta = 0;
        std::array<std::int32_t, 3> cell{};
        shader::CertifiedCorners corners;
        bool passes = false; ///< it is clear that certifiedClip() leaves something, if the cell is whole in the domain
    };

    [[nodiscard]] std::size_t count() const noexcept { return count_; }
    [[nodiscard]] bool full() const noexcept { return count_ == kMost; }
    /// The next fragment; expects room.
    void add(const Fragment& fragment) noexcept;
    /// Tests the fragments added since the last call, and empties the list.
    void test(const shader::CertifiedItem& item, const shader::OpacityBounds& bounds) noexcept;

    /// For the last tested fragments: true if certifiedBegin() leaves no polygon, or certifiedSettle() finds no opaque
    /// point.
    [[nodiscard]] bool isNone(std::size_t i) const noexcept { return lanes_.none[i] != 0; }
    /// certifiedSettle() finds it certain.
    [[nodiscard]] bool isCertain(std::size_t i) const noexcept { return lanes_.certain[i] != 0; }

    /// A lane per fragment.
    struct Lanes {
        template <class Number> using Each = std::array<Number, kMost>;

        std::array<std::array<Each<float>, 3>, 3> triangle{}; ///< by corner and axis
        Each<float> delta{};
        std::array<Each<std::int32_t>, 3> cell{};
        std::array<Each<float>, 8> stored{}; ///< at corner x + 2 y + 4 z
        Each<float> wideLo{};
        Each<float> wideHi{};
        // not 0: true
        Each<std::uint32_t> passes{};
        Each<std::uint32_t> none{};
        Each<std::uint32_t> certain{};
    };
    /// Some fragments, by index.
    struct Chosen {
        std::array<std::int32_t, kMost> number{};
        std::size_t count = 0;
    };

  private:
    Lanes lanes_;
    std::size_t count_ = 0;
};

/// Second half of a test: by the corners of the chosen fragments.
void cutFragments(const shader::CertifiedItem& item, const shader::OpacityBounds& bounds,
                  const FragmentFilter::Chosen& chosen, FragmentFilter::Lanes& lanes) noexcept;

} // namespace voxtact::cpu
