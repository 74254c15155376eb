// SPDX-License-Identifier: MIT
#pragma once

#include "support/scenes.h"
#include "voxtact/data.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <random>
#include <string>

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

/// Which of the sides of a volume and of a table are powers of two, as bits.
unsigned powersOfTwo(const VolumeView& volume, std::uint32_t tableSize);
/// Of the usual kind no side of the volume is a power of two and the table's is, as in most tests, so that much is
/// compiled already.
inline constexpr unsigned kUsualKind = 8;

/// The images of a run. llvmpipe compiles a shader again for each format and for which of the sides of the volume and
/// of the table are powers of two: 64 kinds, of which 300 cases have nearly all, and seconds for each. So a run has all
/// types of voxels, with as many cases of each where a number of cases is asked for: the type that comes first of the
/// kind that comes first, the others of the usual one. In the long form each type has the kind that comes first.
class FewKindsOfImage {
  public:
    explicit FewKindsOfImage(std::uint64_t cases = std::numeric_limits<std::uint64_t>::max());

    /// Whether a case with such images is to be run; it is then taken for run. After 300 images of a type, none of
    /// which is of the kind that its images are to have, they have the kind of the next: what makes the cases may never
    /// make that kind.
    bool take(const VolumeView& volume, std::uint32_t tableSize);
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
    [[nodiscard]] bool isDone() const noexcept { return taken_ == types_.size() * casesOfEach_; }

  private:
    struct Type {
        std::optional<unsigned> powersOfTwo; ///< the first that comes, where there is none
        std::uint64_t cases = 0;
        std::uint64_t tries = 0; ///< until the first that was taken
    };

    bool firstIsOfAnyKind_;
    std::map<ScalarType, Type> types_;
    std::uint64_t casesOfEach_;
    std::uint64_t taken_ = 0;
};

/// Looks at so many of the cases that `make(number)` makes, which have a `scene`, until something fails. Returns how
/// many there were.
template <class Make, class Look>
std::uint64_t forFewKinds(std::uint64_t cases, std::uint64_t seed, Make make, Look look) {
    FewKindsOfImage few(cases);
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
