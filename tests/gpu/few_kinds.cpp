// SPDX-License-Identifier: MIT
#include "few_kinds.h"

#include <utility>

namespace voxtact::test {

unsigned powersOfTwo(const VolumeView& volume, std::uint32_t tableSize) {
    unsigned bits = std::has_single_bit(tableSize) ? kUsualKind : 0U;
    for (unsigned axis = 0; axis < 3; ++axis) {
        bits |= std::has_single_bit(volume.grid.size[axis]) ? 1U << axis : 0U;
    }
    return bits;
}

FewKindsOfImage::FewKindsOfImage(std::uint64_t cases) : firstIsOfAnyKind_(!longTests()) {
    for (const ScalarType type : {ScalarType::UInt8, ScalarType::Int16, ScalarType::UInt16, ScalarType::Float32}) {
        if (longTests()) {
            types_[type] = {};
        } else {
            types_[type].powersOfTwo = kUsualKind;
        }
    }
    casesOfEach_ = cases / types_.size();
}

bool FewKindsOfImage::take(const VolumeView& volume, std::uint32_t tableSize) {
    constexpr std::uint64_t kPatience = 300;
    const unsigned kind = powersOfTwo(volume, tableSize);
    if (std::exchange(firstIsOfAnyKind_, false)) {
        types_[volume.type].powersOfTwo = kind;
    }
    const auto found = types_.find(volume.type);
    if (found == types_.end() || found->second.cases == casesOfEach_) {
        return false;
    }
    Type& type = found->second;
    if (type.cases == 0 && type.tries++ == kPatience) {
        type.powersOfTwo = kind;
    }
    if (type.powersOfTwo.value_or(kind) != kind) {
        return false;
    }
    type.powersOfTwo = kind;
    ++type.cases;
    ++taken_;
    return true;
}

} // namespace voxtact::test
