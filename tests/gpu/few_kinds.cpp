// SPDX-License-Identifier: MIT
#include "few_kinds.h"

#include <cstdlib>
#include <iostream>
#include <utility>

namespace voxtact::test {

namespace {

std::uint64_t seedOfKind() {
    const char* given = std::getenv("VOXTACT_TEST_KIND");
    return given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device{}();
}

ImageKind drawKind(std::uint64_t seed) {
    for (std::uint64_t number = 0;; ++number) {
        const CertifiedCase c = makeClearanceCase(seed, number);
        const VolumeView volume = c.scene.volume.view();
        if (volume.type != ScalarType::UInt8) {
            return {volume.type, powersOfTwo(volume, c.scene.tableSize)};
        }
    }
}

} // namespace

unsigned powersOfTwo(const VolumeView& volume, std::uint32_t tableSize) {
    unsigned bits = std::has_single_bit(tableSize) ? kUsualKind : 0U;
    for (unsigned axis = 0; axis < 3; ++axis) {
        bits |= std::has_single_bit(volume.grid.size[axis]) ? 1U << axis : 0U;
    }
    return bits;
}

ImageKind otherKind() {
    static const std::uint64_t kSeed = seedOfKind();
    static const ImageKind kOther = drawKind(kSeed);
    std::cout << "VOXTACT_TEST_KIND=" << kSeed << "\n"; // each time: what a test printed is all that is shown of it
    return kOther;
}

std::vector<ScalarType> fewTypes() {
    if (longTests()) {
        return {kVoxelTypes.begin(), kVoxelTypes.end()};
    }
    return {ScalarType::UInt8, otherKind().type};
}

FewKindsOfImage::FewKindsOfImage(std::uint64_t cases, ImageKinds kinds)
    : firstIsOfAnyKind_(kinds == ImageKinds::Most && !longTests()) {
    if (longTests()) {
        for (const ScalarType type : kVoxelTypes) {
            types_[type] = {};
        }
    } else if (kinds == ImageKinds::Most) {
        for (const ScalarType type : kVoxelTypes) {
            types_[type].powersOfTwo = kUsualKind;
        }
    } else {
        const ImageKind other = otherKind();
        types_[ScalarType::UInt8].powersOfTwo = kUsualKind;
        types_[other.type].powersOfTwo = other.powersOfTwo;
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
