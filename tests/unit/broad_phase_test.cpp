// SPDX-License-Identifier: MIT
// Sweep and prune against all pairs; boxes under a matrix.
#include "support/scenes.h"
#include "support/special.h"
#include "voxtact/data.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

using testing::ElementsAre;

constexpr double kLargest = std::numeric_limits<double>::max();

bool shareAPoint(const Box& a, const Box& b) {
    bool share = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        // A closed interval that ends before it begins has no points.
        const double lo = a.lo[axis] >= b.lo[axis] ? a.lo[axis] : b.lo[axis];
        share = share && a.lo[axis] <= a.hi[axis] && b.lo[axis] <= b.hi[axis] && lo <= a.hi[axis] && lo <= b.hi[axis];
    }
    return share;
}

std::vector<BoxPair> allPairs(std::span<const Box> boxes) {
    std::vector<BoxPair> pairs;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
            if (shareAPoint(boxes[i], boxes[j])) {
                pairs.push_back({i, j});
            }
        }
    }
    return pairs;
}

std::vector<BoxPair> allPairs(std::span<const Box> left, std::span<const Box> right) {
    std::vector<BoxPair> pairs;
    for (std::uint32_t i = 0; i < left.size(); ++i) {
        for (std::uint32_t j = 0; j < right.size(); ++j) {
            if (shareAPoint(left[i], right[j])) {
                pairs.push_back({i, j});
            }
        }
    }
    return pairs;
}

enum class Kind { Uniform, Clustered, Flat, Lattice, Identical, Huge, Broken, Count };

double lattice(std::mt19937_64& random) {
    return std::floor(uniform(random, 0, 12));
}

Box randomBox(std::mt19937_64& random, Kind kind) {
    Box box;
    const double size = std::pow(10, uniform(random, -3, 0));
    const double cluster = std::floor(uniform(random, 0, 5)) * 10;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        switch (kind) {
        case Kind::Uniform:
            box.lo[axis] = uniform(random, -3, 3);
            break;
        case Kind::Clustered:
            box.lo[axis] = cluster + uniform(random, -0.5, 0.5);
            break;
        case Kind::Flat: // points, segments and rectangles, of which many share coordinates
            box.lo[axis] = lattice(random) / 4;
            box.hi[axis] = box.lo[axis] + (uniform(random, 0, 1) < 0.5 ? 0 : 1);
            continue;
        case Kind::Lattice: // unit boxes that touch
            box.lo[axis] = lattice(random);
            box.hi[axis] = box.lo[axis] + 1;
            continue;
        case Kind::Identical:
            box.hi[axis] = 1;
            continue;
        case Kind::Huge: {
            constexpr double kEnds[] = {-kInfinity, -kLargest, -1e300, 0, 1e300, kLargest, kInfinity};
            const auto first = static_cast<std::size_t>(uniform(random, 0, 7));
            box.lo[axis] = kEnds[first];
            box.hi[axis] = kEnds[first + static_cast<std::size_t>(uniform(random, 0, static_cast<double>(7 - first)))];
            continue;
        }
        default:
            box.lo[axis] = uniform(random, 0, 1);
            break;
        }
        box.hi[axis] = box.lo[axis] + uniform(random, 0, size);
        if (kind == Kind::Broken && uniform(random, 0, 1) < 0.1) {
            (uniform(random, 0, 1) < 0.5 ? box.lo : box.hi)[axis] = uniform(random, 0, 1) < 0.5 ? kNan : 0.5;
        }
    }
    return box;
}

std::vector<Box> randomBoxes(std::mt19937_64& random, std::size_t count, Kind kind) {
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < count; ++i) {
        boxes.push_back(randomBox(random, kind));
    }
    return boxes;
}

TEST(BroadPhase, FindsWhatAllPairsFind) {
    std::mt19937_64 random(testSeed());
    std::size_t found = 0;
    for (int round = 0; round < 40; ++round) {
        for (int kind = 0; kind < static_cast<int>(Kind::Count); ++kind) {
            const auto count = static_cast<std::size_t>(uniform(random, 0, round % 2 == 0 ? 8 : 120));
            const std::vector<Box> boxes = randomBoxes(random, count, static_cast<Kind>(kind));
            const std::vector<BoxPair> expected = allPairs(boxes);
            ASSERT_EQ(overlappingPairs(boxes).value(), expected) << "kind " << kind;
            const auto half = static_cast<std::size_t>(uniform(random, 0, static_cast<double>(count + 1)));
            const std::span left = std::span(boxes).first(half);
            const std::span right = std::span(boxes).subspan(half);
            ASSERT_EQ(overlappingPairs(left, right).value(), allPairs(left, right)) << "kind " << kind;
            ASSERT_EQ(overlappingPairs(right, left).value(), allPairs(right, left)) << "kind " << kind;
            const std::span one = left.first(std::min<std::size_t>(left.size(), 1));
            ASSERT_EQ(overlappingPairs(one, right).value(), allPairs(one, right)) << "kind " << kind;
            ASSERT_EQ(overlappingPairs(right, one).value(), allPairs(right, one)) << "kind " << kind;
            found += expected.size();
        }
    }
    EXPECT_GT(found, 1000U);
}

TEST(BroadPhase, ThousandsOfBoxes) {
    std::mt19937_64 random(testSeed());
    std::vector<Box> boxes = randomBoxes(random, 3000, Kind::Uniform);
    const std::vector<Box> others = randomBoxes(random, 2000, Kind::Clustered);
    boxes.insert(boxes.end(), others.begin(), others.end());
    EXPECT_EQ(overlappingPairs(boxes).value(), allPairs(boxes));
    EXPECT_EQ(overlappingPairs(boxes, others).value(), allPairs(boxes, others));
}

TEST(BroadPhase, TouchingIsOverlapping) {
    const std::vector<Box> boxes{{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{2.0000001, 0, 0}, {3, 3, 3}}};
    EXPECT_THAT(overlappingPairs(boxes).value(), ElementsAre(BoxPair{0, 1}));
    EXPECT_TRUE(overlappingPairs({}).value().empty());
    EXPECT_TRUE(overlappingPairs(boxes, {}).value().empty());
    EXPECT_TRUE(overlappingPairs({}, boxes).value().empty());
    const std::vector<Box> inverted{{{0, 0, 0}, {3, -1, 3}}};
    EXPECT_TRUE(overlappingPairs(boxes, inverted).value().empty());
}

double randomElement(std::mt19937_64& random) {
    return uniform(random, -1, 1) * std::pow(10, std::floor(uniform(random, -8, 8)));
}

TEST(BoxesUnderAMatrix, AreRoundedOutward) {
    std::mt19937_64 random(testSeed());
    std::size_t rounded = 0;
    for (int round = 0; round < 20000; ++round) {
        Mat4 matrix = identity();
        for (std::size_t element = 0; element < 16; ++element) {
            matrix[element] = element % 4 == 3 ? matrix[element] : randomElement(random);
        }
        Box box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double a = randomElement(random);
            const double b = randomElement(random);
            box.lo[axis] = std::min(a, b);
            box.hi[axis] = std::max(a, b);
        }
        const Box out = transformBox(matrix, box);
        for (std::size_t row = 0; row < 3; ++row) {
            long double lo = matrix[12 + row];
            long double hi = lo;
            long double size = std::abs(lo);
            for (std::size_t column = 0; column < 3; ++column) {
                const long double element = matrix[4 * column + row];
                lo += std::min(element * box.lo[column], element * box.hi[column]);
                hi += std::max(element * box.lo[column], element * box.hi[column]);
                size += std::abs(element) * std::max(std::abs(box.lo[column]), std::abs(box.hi[column]));
            }
            // The error of long double itself is 2^-11 of the one that is looked for.
            const long double slack = size * 0x1p-61L;
            ASSERT_LE(out.lo[row], lo + slack);
            ASSERT_GE(out.hi[row], hi - slack);
            ASSERT_GE(out.lo[row], lo - size * 0x1p-49L) << "too wide";
            ASSERT_LE(out.hi[row], hi + size * 0x1p-49L) << "too wide";
            rounded += out.lo[row] != static_cast<double>(lo) ? 1U : 0U;
        }
    }
    EXPECT_GT(rounded, 1000U) << "nothing had to be rounded";
}

TEST(BoxesUnderAMatrix, AreExactWhereTheNumbersAre) {
    const Box box{{0, 1, 2}, {3, 4, 5}};
    EXPECT_THAT(transformBox(identity(), box).lo, ElementsAre(0, 1, 2));
    EXPECT_THAT(transformBox(identity(), box).hi, ElementsAre(3, 4, 5));
    Mat4 turned = translation({10, 20, 30}); // x to y, y to -x
    turned[0] = turned[5] = 0;
    turned[1] = 1;
    turned[4] = -1;
    EXPECT_THAT(transformBox(turned, box).lo, ElementsAre(6, 20, 32));
    EXPECT_THAT(transformBox(turned, box).hi, ElementsAre(9, 23, 35));
}

TEST(BoxesUnderAMatrix, UnderflowAndOverflowGoOutward) {
    Mat4 tiny = identity();
    tiny[0] = 1e-200;
    const Box small = transformBox(tiny, {{-1e-200, 0, 0}, {1e-200, 1, 1}});
    EXPECT_LT(small.lo[0], 0);
    EXPECT_GT(small.hi[0], 0);
    Mat4 large = translation({kLargest, 0, 0});
    large[0] = 1e200;
    const Box far = transformBox(large, {{1e200, 0, 0}, {1e200, 1, 1}});
    EXPECT_EQ(far.lo[0], kLargest);
    EXPECT_EQ(far.hi[0], kInfinity);
    const Box everything = transformBox(identity(), {{-kInfinity, 0, 0}, {kInfinity, 1, 1}});
    EXPECT_EQ(everything.lo[0], -kInfinity);
    EXPECT_EQ(everything.hi[0], kInfinity);
    EXPECT_EQ(everything.hi[1], 1);
}

TEST(BoxesUnderAMatrix, EmptyStaysEmpty) {
    const std::vector<Box> everything{{{-kInfinity, -kInfinity, -kInfinity}, {kInfinity, kInfinity, kInfinity}}};
    const auto overlapsNothing = [&](const Box& box) {
        return overlappingPairs(everything, std::span(&box, 1)).value().empty();
    };
    EXPECT_TRUE(overlapsNothing(transformBox(identity(), {{0, 2, 0}, {1, 1, 1}})));
    EXPECT_TRUE(overlapsNothing(transformBox(identity(), {{0, 0, 0}, {1, 1, kNan}})));
    Mat4 broken = identity();
    broken[6] = kNan;
    EXPECT_TRUE(overlapsNothing(transformBox(broken, {{0, 0, 0}, {1, 1, 1}})));
    EXPECT_FALSE(overlapsNothing(transformBox(identity(), {{0, 0, 0}, {1, 1, 1}})));
}

} // namespace
} // namespace voxtact::test
