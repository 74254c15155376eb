// SPDX-License-Identifier: MIT
// In place of fcl_peer.cpp where FCL was not found.
#include "lab/engines/fcl_peer.h"

namespace voxtact::lab {

struct FclVolume {};

std::string fclVersion() {
    return {};
}

std::shared_ptr<const FclVolume> makeFclVolume(const FclCells& /*cells*/, std::string& why) {
    why = "not built in";
    return nullptr;
}

FclPeer makeFclPeer(const FclVolume& /*volume*/, std::span<const float> /*positions*/,
                    std::span<const std::uint32_t> /*indices*/, FclScalar /*scalar*/) {
    return {};
}

FclDistance makeFclDistance(const FclVolume& /*volume*/, std::span<const float> /*positions*/,
                            std::span<const std::uint32_t> /*indices*/) {
    return {};
}

FclMotion makeFclMotion(const FclVolume& /*volume*/, std::span<const float> /*positions*/,
                        std::span<const std::uint32_t> /*indices*/) {
    return {};
}

} // namespace voxtact::lab
