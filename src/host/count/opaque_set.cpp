// SPDX-License-Identifier: MIT
#include "host/count/opaque_set.h"
#include "exact/exact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact::cpu {

namespace {

/// Finite floats numbered in their order; -0 and +0 are two neighbours.
std::int64_t orderOf(float value) {
    const auto bits = std::bit_cast<std::int32_t>(value);
    return bits >= 0 ? bits : -1 - std::int64_t{bits & 0x7fffffff};
}

float floatAt(std::int64_t order) {
    const auto bits = static_cast<std::uint32_t>(order >= 0 ? order : -1 - order);
    return std::bit_cast<float>(order >= 0 ? bits : bits | 0x80000000U);
}

constexpr float kMost = std::numeric_limits<float>::max();

/// The first order of [from, to) that satisfies an ascending predicate, or `to`.
template <class Predicate> std::int64_t firstThat(std::int64_t from, std::int64_t to, const Predicate& predicate) {
    while (from < to) {
        const std::int64_t middle = from + (to - from) / 2;
        if (predicate(middle)) {
            to = middle;
        } else {
            from = middle + 1;
        }
    }
    return from;
}

class Walk {
  public:
    Walk(std::span<const float> table, const shader::ItemConstants& constants)
        : table_(table), constants_(constants), from_(orderOf(-kMost)), end_(orderOf(kMost) + 1) {}

    std::vector<Interval> intervals() {
        for (std::size_t entry = 0; entry < table_.size(); ++entry) {
            const Verdict verdict = verdictOf(entry);
            if (verdict != Verdict::Mixed) {
                become(verdict == Verdict::Opaque, [&] { return startOf(entry); });
                continue;
            }
            mixed(startOf(entry), startOf(entry + 1));
        }
        become(false, [&] { return end_; });
        return std::move(out_);
    }

  private:
    enum class Verdict { Transparent, Opaque, Mixed };

    /// The margin covers the rounding of exactLerp(); values inside it are tested float by float.
    [[nodiscard]] Verdict verdictOf(std::size_t entry) const {
        constexpr float kMargin = 1e-5F;
        const float a = table_[entry];
        const float b = table_[std::min(entry + 1, table_.size() - 1)];
        if (std::max(a, b) < constants_.threshold - kMargin) {
            return Verdict::Transparent;
        }
        return std::min(a, b) > constants_.threshold + kMargin ? Verdict::Opaque : Verdict::Mixed;
    }

    /// Returns the first float whose lookup uses this entry or a later one.
    [[nodiscard]] std::int64_t startOf(std::size_t entry) const {
        const auto size = static_cast<int>(table_.size());
        return firstThat(from_, end_, [&](std::int64_t order) {
            return shader::exactEntry(floatAt(order), constants_.scalarScale, constants_.scalarBias, size).below >=
                   static_cast<int>(entry);
        });
    }

    void mixed(std::int64_t from, std::int64_t to) {
        if (from >= to) {
            return;
        }
        const auto opaque = [&](std::int64_t order) { return isOpaque(table_, constants_, floatAt(order)); };
        const bool first = opaque(from);
        become(first, [&] { return from; });
        if (opaque(to - 1) != first) {
            const std::int64_t change = firstThat(from, to, [&](std::int64_t order) { return opaque(order) != first; });
            become(!first, [&] { return change; });
        }
    }

    template <class Start> void become(bool opaque, const Start& startOfState) {
        if (opaque == opaque_) {
            return;
        }
        const std::int64_t start = startOfState();
        if (opaque) {
            opened_ = start;
        } else if (start > opened_) {
            out_.push_back({floatAt(opened_), floatAt(start - 1)});
        }
        opaque_ = opaque;
    }

    std::span<const float> table_;
    const shader::ItemConstants& constants_;
    std::int64_t from_;
    std::int64_t end_;
    std::int64_t opened_ = 0;
    bool opaque_ = false;
    std::vector<Interval> out_;
};

} // namespace

float opacityOf(std::span<const float> table, const shader::ItemConstants& constants, float stored) noexcept {
    const shader::ExactCell entry =
        shader::exactEntry(stored, constants.scalarScale, constants.scalarBias, static_cast<int>(table.size()));
    return shader::exactLerp(table[static_cast<std::size_t>(entry.below)], table[static_cast<std::size_t>(entry.above)],
                             entry.weight);
}

bool isOpaque(std::span<const float> table, const shader::ItemConstants& constants, float stored) noexcept {
    return opacityOf(table, constants, stored) >= constants.threshold;
}

OpaqueSet::OpaqueSet(std::span<const float> table, const shader::ItemConstants& constants)
    : valid_(std::isfinite(constants.scalarScale) && std::isfinite(constants.scalarBias)) {
    if (valid_) {
        intervals_ = Walk(table, constants).intervals();
    }
}

const Interval* OpaqueSet::lastFrom(float value) const noexcept {
    const auto after = std::upper_bound(intervals_.begin(), intervals_.end(), value,
                                        [](float v, const Interval& interval) { return v < interval.lo; });
    return after == intervals_.begin() ? nullptr : &*(after - 1);
}

bool OpaqueSet::meets(float lo, float hi) const noexcept {
    const Interval* last = lastFrom(hi);
    return last != nullptr && last->hi >= lo;
}

bool OpaqueSet::contains(float lo, float hi) const noexcept {
    const Interval* last = lastFrom(lo);
    return last != nullptr && last->hi >= hi;
}

} // namespace voxtact::cpu
