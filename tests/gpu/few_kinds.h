// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/margin_cases.h"
#include "support/scenes.h"
#include "voxtact/data.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace voxtact::test {

/// A side of a volume, `least` to `most` voxels; no power of two where the tests are not in their long form (see
/// below).
inline std::uint32_t usualSide(std::mt19937_64& random, std::uint32_t least, std::uint32_t most) {
    for (;;) {
        const auto side = static_cast<std::uint32_t>(least + random() % (most - least + 1));
        if (longTests() || !std::has_single_bit(side)) {
            return side;
        }
    }
}

/// Types of voxels for a test in which they come by turns: all, or where the tests are not in their long form, bytes
/// and one other.
inline std::vector<ScalarType> fewTypes(std::mt19937_64& random) {
    std::vector<ScalarType> types(kVoxelTypes.begin(), kVoxelTypes.end());
    if (!longTests()) {
        types = {ScalarType::UInt8, types[1 + random() % 3]};
    }
    return types;
}

/// What the images of a run are, where the tests are not in their long form.
enum class ImageKinds {
    Few,  ///< of bytes of the usual kind, and of the first other type that comes, of the kind that comes first
    Most, ///< of all types of voxels; of the first type that comes, of the kind that comes first
};

/// The images of a run. llvmpipe compiles a shader anew for each format and for which of the sides of the volume and of
/// the table are powers of two: 64 kinds, of which 300 cases have nearly all, and seconds for each. So a run has few of
/// them, with as many cases of each. Of the usual kind no side of the volume is a power of two and the table's is, as
/// in most tests, so that much is compiled already; what has a side of 1, 2, 4 or 8 voxels is of another one. In the
/// long form each type of voxels has the kind that comes first. Which type and kind come first is up to the seed.
class FewKindsOfImage {
  public:
    /// As many as are wanted.
    explicit FewKindsOfImage(ImageKinds kinds) : FewKindsOfImage(std::numeric_limits<std::uint64_t>::max(), kinds) {}
    explicit FewKindsOfImage(std::uint64_t cases, ImageKinds kinds = ImageKinds::Few)
        : kinds_(kinds), most_(kinds == ImageKinds::Most || longTests() ? 4 : 2), casesOfEach_(cases / most_) {}

    /// Whether a case with such images is to be run; it is then taken for run.
    bool take(const VolumeView& volume, std::uint32_t tableSize) {
        constexpr unsigned kUsual = 8;
        const auto& size = volume.grid.size;
        const unsigned kind = (std::has_single_bit(size[0]) ? 1U : 0U) | (std::has_single_bit(size[1]) ? 2U : 0U) |
                              (std::has_single_bit(size[2]) ? 4U : 0U) | (std::has_single_bit(tableSize) ? kUsual : 0U);
        if (!types_.contains(volume.type) && !isWanted(volume.type)) {
            return false;
        }
        const bool any =
            longTests() || (kinds_ == ImageKinds::Most ? types_.empty() : volume.type != ScalarType::UInt8);
        Type& type = types_.try_emplace(volume.type, Type{any ? kind : kUsual, 0}).first->second;
        if (type.kind != kind || type.cases == casesOfEach_) {
            return false;
        }
        ++type.cases;
        ++taken_;
        return true;
    }
    /// The next of the scenes that `make()` makes that is to be run.
    template <class Make> auto next(Make make) {
        for (;;) {
            auto scene = make();
            if (take(scene.volume.view(), scene.tableSize)) {
                return scene;
            }
        }
    }
    /// Whether there were as many as there are to be.
    [[nodiscard]] bool isDone() const noexcept { return taken_ == most_ * casesOfEach_; }

  private:
    struct Type {
        unsigned kind;
        std::uint64_t cases;
    };
    /// Of a type that has not come yet.
    [[nodiscard]] bool isWanted(ScalarType type) const {
        const std::uint64_t others = types_.size() - types_.count(ScalarType::UInt8);
        return type == ScalarType::UInt8 || others + 1 < most_;
    }

    ImageKinds kinds_;
    std::uint64_t most_; ///< types
    std::uint64_t casesOfEach_;
    std::uint64_t taken_ = 0;
    std::map<ScalarType, Type> types_;
};

/// Looks at so many of the cases that `make(number)` makes, which have a `scene`, until something fails. Returns how
/// many there were.
template <class Make, class Look>
std::uint64_t forFewKinds(std::uint64_t cases, std::uint64_t seed, Make make, Look look,
                          ImageKinds kinds = ImageKinds::Few) {
    FewKindsOfImage few(cases, kinds);
    std::uint64_t looked = 0;
    for (std::uint64_t number = 0; !few.isDone() && !testing::Test::HasFailure(); ++number) {
        auto c = make(number);
        if (few.take(c.scene.volume.view(), c.scene.tableSize)) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", case " + std::to_string(number));
            ++looked;
            look(c, number);
        }
    }
    return looked;
}

} // namespace voxtact::test
