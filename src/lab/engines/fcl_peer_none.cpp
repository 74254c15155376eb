// SPDX-License-Identifier: MIT
// In place of fcl_peer.cpp where FCL was not found.
#include "lab/engines/fcl_peer.h"

namespace voxtact::lab {

std::shared_ptr<const FclVolume> makeFclVolume(const FclCells& /*cells*/, std::string& why) {
    why = "not built in";
    return nullptr;
}

} // namespace voxtact::lab
