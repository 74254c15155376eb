// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <memory>

namespace voxtact {

/// What an object of voxtact is made of. There is nothing once the object was moved from: such a one may be assigned to
/// and destroyed, and nothing else.
template <class Impl> [[nodiscard]] Impl& live(const std::unique_ptr<Impl>& impl) noexcept {
    assert(impl != nullptr && "an object of voxtact that was moved from is used: assign to it first");
    return *impl;
}

} // namespace voxtact
