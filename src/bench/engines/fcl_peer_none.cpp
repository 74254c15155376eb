// SPDX-License-Identifier: MIT
// Instead of fcl_peer.cpp where FCL was not found.
#include "bench/engines/fcl_peer.h"

namespace voxtact::lab {

std::shared_ptr<const FclVolume> makeFclVolume(const FclCells& /*cells*/, std::string& why) {
    why = "not built in";
    return nullptr;
}

} // namespace voxtact::lab
