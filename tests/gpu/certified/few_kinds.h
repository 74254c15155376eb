// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <bit>
#include <cstdint>
#include <map>

namespace voxtact::test {

/// The images of a run. llvmpipe compiles a shader anew for each format and for which of an image's sides are powers of
/// two: 32 kinds, of which 300 cases have nearly all, and a second and more for each. So a run has one kind for each
/// type of voxels, the first that comes, with as many cases as of the others; which kinds these are is up to the seed.
class FewKindsOfImage {
  public:
    explicit FewKindsOfImage(std::uint64_t casesOfEach) : casesOfEach_(casesOfEach) {}

    /// Whether a case with such an image is to be run; it is then taken for run.
    bool take(const VolumeView& image) {
        const auto& size = image.grid.size;
        const unsigned kind = (std::has_single_bit(size[0]) ? 1U : 0U) | (std::has_single_bit(size[1]) ? 2U : 0U) |
                              (std::has_single_bit(size[2]) ? 4U : 0U);
        Type& type = types_.try_emplace(image.type, Type{kind, 0}).first->second;
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

} // namespace voxtact::test
