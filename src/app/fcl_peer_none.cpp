// SPDX-License-Identifier: MIT
// In place of fcl_peer.cpp where FCL was not found.
#include "app/fcl_peer.h"

namespace voxtact::app {

namespace {

Error notBuiltIn() {
    return {ErrorCode::Unsupported, 0, "not built in"};
}

} // namespace

std::string fclVersion() {
    return {};
}

Result<FclVolume> FclVolume::create(const OpaqueCells& /*cells*/) {
    return notBuiltIn();
}

Result<std::unique_ptr<FclPeer>> FclVolume::peer(const MeshView& /*mesh*/, FclScalar /*scalar*/) const {
    return notBuiltIn();
}

} // namespace voxtact::app
