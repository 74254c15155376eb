// SPDX-License-Identifier: MIT
#include "few_kinds.h"

#include <cstdlib>
#include <iostream>

namespace voxtact::test {

namespace {

ImageKind drawOtherKind() {
    std::uint64_t seed = std::random_device{}();
    if (const char* given = std::getenv("VOXTACT_TEST_KIND"); given != nullptr) {
        seed = std::strtoull(given, nullptr, 10);
    }
    std::cout << "VOXTACT_TEST_KIND=" << seed << "\n";
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
    static const ImageKind kOther = drawOtherKind();
    return kOther;
}

std::vector<ScalarType> fewTypes() {
    if (longTests()) {
        return {kVoxelTypes.begin(), kVoxelTypes.end()};
    }
    return {ScalarType::UInt8, otherKind().type};
}

FewKindsOfImage::FewKindsOfImage(std::uint64_t cases, ImageKinds kinds) {
    if (longTests()) {
        for (const ScalarType type : kVoxelTypes) {
            types_[type] = {};
        }
    } else {
        if (kinds == ImageKinds::Most) {
            for (const ScalarType type : kVoxelTypes) {
                types_[type].powersOfTwo = kUsualKind;
            }
        }
        types_[ScalarType::UInt8].powersOfTwo = kUsualKind;
        types_[otherKind().type].powersOfTwo = otherKind().powersOfTwo;
    }
    casesOfEach_ = cases / types_.size();
}

bool FewKindsOfImage::take(const VolumeView& volume, std::uint32_t tableSize) {
    // What makes the cases may never make that kind.
    constexpr std::uint64_t kPatience = 300;
    const auto found = types_.find(volume.type);
    if (found == types_.end() || found->second.cases == casesOfEach_) {
        return false;
    }
    Type& type = found->second;
    const unsigned kind = powersOfTwo(volume, tableSize);
    if (type.cases == 0 && type.others++ == kPatience) {
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
