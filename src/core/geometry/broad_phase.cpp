// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/try.h"
#include "voxtact/data.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace voxtact {

namespace {

/// A box of the sweep: the axis of the sweep, and the two others.
struct Swept {
    double lo, hi;
    double lo1, hi1;
    double lo2, hi2;
    std::uint32_t box;
};

bool isEmpty(const Box& box) {
    // NaN compares false, too.
    return !(box.lo[0] <= box.hi[0] && box.lo[1] <= box.hi[1] && box.lo[2] <= box.hi[2]);
}

double centre(const Box& box, std::size_t axis) {
    return box.lo[axis] / 2 + box.hi[axis] / 2;
}

/// Sum, and sum of squares around a first value.
struct Spread {
    double sum = 0;
    double squares = 0;
};

/// The choice of the axis costs time, never a pair: infinite centres and overflow do no harm.
std::size_t widestAxis(std::initializer_list<std::span<const Box>> sets) {
    double widest = -1;
    std::size_t best = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Spread spread;
        double first = std::numeric_limits<double>::quiet_NaN();
        double count = 0;
        for (const std::span<const Box> boxes : sets) {
            for (const Box& box : boxes) {
                const double at = centre(box, axis);
                if (isEmpty(box) || !std::isfinite(at)) {
                    continue;
                }
                first = count == 0 ? at : first;
                spread.sum += at - first;
                spread.squares += (at - first) * (at - first);
                ++count;
            }
        }
        const double variance = count > 0 ? spread.squares / count - (spread.sum / count) * (spread.sum / count) : 0;
        if (variance > widest) {
            widest = variance;
            best = axis;
        }
    }
    return best;
}

std::vector<Swept> sweepOrder(std::span<const Box> boxes, std::size_t axis) {
    const std::size_t axis1 = (axis + 1) % 3;
    const std::size_t axis2 = (axis + 2) % 3;
    std::vector<Swept> order;
    order.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const Box& box = boxes[i];
        if (!isEmpty(box)) {
            order.push_back({box.lo[axis], box.hi[axis], box.lo[axis1], box.hi[axis1], box.lo[axis2], box.hi[axis2],
                             static_cast<std::uint32_t>(i)});
        }
    }
    std::sort(order.begin(), order.end(), [](const Swept& a, const Swept& b) { return a.lo < b.lo; });
    return order;
}

/// Finds the boxes that begin within a box, along the axis, and meet it.
class Meeting {
  public:
    explicit Meeting(std::size_t most) : met_(most) {}

    /// Returns those of `others` that meet `box`; they are sorted and begin no earlier. Valid until the next call.
    /// Branchless, which is twice as fast if many meet.
    std::span<const std::uint32_t> with(const Swept& box, std::span<const Swept> others) {
        std::size_t count = 0;
        for (std::size_t i = 0; i < others.size() && others[i].lo <= box.hi; ++i) {
            const Swept& other = others[i];
            const unsigned along1 = unsigned{box.lo1 <= other.hi1} & unsigned{other.lo1 <= box.hi1};
            const unsigned along2 = unsigned{box.lo2 <= other.hi2} & unsigned{other.lo2 <= box.hi2};
            met_[count] = other.box;
            count += along1 & along2;
        }
        return std::span(met_).first(count);
    }

  private:
    std::vector<std::uint32_t> met_; ///< as large as the maximum result
};

/// Sorts by counting the pairs of each first box, of which there are `boxes`; then the few of each by their second.
void sortPairs(std::vector<BoxPair>& pairs, std::size_t boxes) {
    std::vector<std::size_t> ends(boxes + 1, 0);
    for (const BoxPair& pair : pairs) {
        ++ends[pair.first + std::size_t{1}];
    }
    for (std::size_t i = 0; i < boxes; ++i) {
        ends[i + 1] += ends[i];
    }
    std::vector<BoxPair> sorted(pairs.size());
    for (const BoxPair& pair : pairs) {
        sorted[ends[pair.first]++] = pair;
    }
    // Each position now holds the start of the next one.
    std::size_t begin = 0;
    for (std::size_t i = 0; i < boxes; ++i) {
        std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
                  sorted.begin() + static_cast<std::ptrdiff_t>(ends[i]));
        begin = ends[i];
    }
    pairs = std::move(sorted);
}

bool overlap(const Box& a, const Box& b) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!(a.lo[axis] <= b.hi[axis] && b.lo[axis] <= a.hi[axis])) {
            return false;
        }
    }
    return !isEmpty(a) && !isEmpty(b);
}

/// With one box in a set, the order of the other set suffices, without sorting.
std::vector<BoxPair> pairsOfOne(std::span<const Box> left, std::span<const Box> right) {
    std::vector<BoxPair> pairs;
    for (std::size_t l = 0; l < left.size(); ++l) {
        for (std::size_t r = 0; r < right.size(); ++r) {
            if (overlap(left[l], right[r])) {
                pairs.push_back({static_cast<std::uint32_t>(l), static_cast<std::uint32_t>(r)});
            }
        }
    }
    return pairs;
}

Result<void> checkCount(std::size_t boxes) {
    constexpr std::uint64_t kMost = std::uint64_t{1} << 32U;
    if (boxes > kMost) {
        return Error{ErrorCode::LimitExceeded, 0,
                     std::to_string(boxes) + " boxes are more than 32 bits can number (" + std::to_string(kMost) + ")"};
    }
    return {};
}

// Directed rounding by error terms: exact operations stay exact, so boxes that touch still touch.

/// Below that the error term of a product may underflow itself.
constexpr double kSmallestProduct = 0x1p-960;

/// `value` is the rounding of an exact number that differs from it by `error`.
double roundedDown(double value, double error) {
    if (value == kInfinity) {
        return std::numeric_limits<double>::max();
    }
    // Not `error < 0`: near the largest numbers the error term is NaN.
    return error >= 0 ? value : std::nextafter(value, -kInfinity);
}

double productDown(double a, double b) {
    if (a == 0 || b == 0) {
        return 0; // of an infinite side too
    }
    if (std::isinf(a) || std::isinf(b)) {
        return a * b;
    }
    const double product = a * b;
    return roundedDown(product, std::abs(product) < kSmallestProduct ? -1.0 : std::fma(a, b, -product));
}

double sumDown(double a, double b) {
    if (std::isinf(a) || std::isinf(b)) {
        return a + b;
    }
    // Knuth's TwoSum.
    const double sum = a + b;
    const double ofB = sum - a;
    return roundedDown(sum, (a - (sum - ofB)) + (b - ofB));
}

/// Returns the minimum of a row of the matrix over the box. The maximum is the negated minimum of the negated row.
double leastOf(const Mat4& b_from_a, std::size_t row, const Box& box, double sign) {
    double least = sign * b_from_a[12 + row];
    for (std::size_t column = 0; column < 3; ++column) {
        const double element = sign * b_from_a[4 * column + row];
        least = sumDown(least, productDown(element, element < 0 ? box.hi[column] : box.lo[column]));
    }
    return least;
}

} // namespace

Result<std::vector<BoxPair>> overlappingPairs(std::span<const Box> boxes) {
    return guard([&]() -> Result<std::vector<BoxPair>> {
        VOXTACT_TRY(checkCount(boxes.size()));
        const std::vector<Swept> order = sweepOrder(boxes, widestAxis({boxes}));
        Meeting meeting(order.size());
        std::vector<BoxPair> pairs;
        for (std::size_t i = 0; i < order.size(); ++i) {
            const std::uint32_t box = order[i].box;
            for (const std::uint32_t other : meeting.with(order[i], std::span(order).subspan(i + 1))) {
                pairs.push_back({std::min(box, other), std::max(box, other)});
            }
        }
        sortPairs(pairs, boxes.size());
        return pairs;
    });
}

Result<std::vector<BoxPair>> overlappingPairs(std::span<const Box> left, std::span<const Box> right) {
    return guard([&]() -> Result<std::vector<BoxPair>> {
        for (const std::size_t boxes : {left.size(), right.size()}) {
            VOXTACT_TRY(checkCount(boxes));
        }
        if (left.size() == 1 || right.size() == 1) {
            return pairsOfOne(left, right);
        }
        const std::size_t axis = widestAxis({left, right});
        const std::vector<Swept> lefts = sweepOrder(left, axis);
        const std::vector<Swept> rights = sweepOrder(right, axis);
        Meeting meeting(std::max(lefts.size(), rights.size()));
        std::vector<BoxPair> pairs;
        // The box that begins first meets those of the other set that begin within it.
        std::size_t l = 0;
        std::size_t r = 0;
        while (l < lefts.size() && r < rights.size()) {
            if (lefts[l].lo <= rights[r].lo) {
                for (const std::uint32_t other : meeting.with(lefts[l], std::span(rights).subspan(r))) {
                    pairs.push_back({lefts[l].box, other});
                }
                ++l;
            } else {
                for (const std::uint32_t other : meeting.with(rights[r], std::span(lefts).subspan(l))) {
                    pairs.push_back({other, rights[r].box});
                }
                ++r;
            }
        }
        sortPairs(pairs, left.size());
        return pairs;
    });
}

Box transformBox(const Mat4& b_from_a, const Box& box) noexcept {
    const bool finite = std::all_of(b_from_a.begin(), b_from_a.end(), [](double e) { return std::isfinite(e); });
    if (isEmpty(box) || !finite) {
        return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    }
    Box out;
    for (std::size_t row = 0; row < 3; ++row) {
        out.lo[row] = leastOf(b_from_a, row, box, 1);
        out.hi[row] = 0 - leastOf(b_from_a, row, box, -1);
    }
    return out;
}

} // namespace voxtact
