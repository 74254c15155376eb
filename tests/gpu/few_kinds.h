// SPDX-License-Identifier: MIT
#pragma once

#include "support/scenes.h"
#include "voxtact/data.h"

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <map>
#include <string>

namespace voxtact::test {

/// The images of a run. llvmpipe compiles a shader anew for each format and for which of an image's sides are powers of
/// two: 32 kinds, of which 300 cases have nearly all, and seconds for each. So a run has one kind for each type of
/// voxels, with as many cases as of the others. The type that comes first has the kind that comes first; the others
/// have no side that is a power of two, as most images of tests, so that much is compiled already. In the long form all
/// have the first that comes. Which these are is up to the seed.
class FewKindsOfImage {
  public:
    explicit FewKindsOfImage(std::uint64_t casesOfEach) : casesOfEach_(casesOfEach) {}

    /// Whether a case with such an image is to be run; it is then taken for run.
    bool take(const VolumeView& image) {
        const auto& size = image.grid.size;
        const unsigned kind = (std::has_single_bit(size[0]) ? 1U : 0U) | (std::has_single_bit(size[1]) ? 2U : 0U) |
                              (std::has_single_bit(size[2]) ? 4U : 0U);
        const unsigned wanted = types_.empty() || longTests() ? kind : 0;
        Type& type = types_.try_emplace(image.type, Type{wanted, 0}).first->second;
        if (type.kind != kind || type.cases == casesOfEach_) {
            return false;
        }
        ++type.cases;
        return true;
    }

  private:
    struct Type {
        unsigned kind;
        std::uint64_t cases;
    };
    std::uint64_t casesOfEach_;
    std::map<ScalarType, Type> types_;
};

/// Looks at the cases that `make(number)` makes, which have a `scene`, `ofEach` of each type of voxels, until something
/// fails. Returns how many there were.
template <class Make, class Look>
std::uint64_t forFewKinds(std::uint64_t ofEach, std::uint64_t seed, Make make, Look look) {
    constexpr std::uint64_t kTypes = 4;
    FewKindsOfImage few(ofEach);
    std::uint64_t cases = 0;
    for (std::uint64_t number = 0; cases < kTypes * ofEach && !testing::Test::HasFailure(); ++number) {
        auto c = make(number);
        if (few.take(c.scene.volume.view())) {
            SCOPED_TRACE("seed " + std::to_string(seed) + ", case " + std::to_string(number));
            ++cases;
            look(c, number);
        }
    }
    return cases;
}

} // namespace voxtact::test
