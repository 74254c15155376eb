// SPDX-License-Identifier: MIT
#pragma once

#include <cassert>
#include <memory>

namespace voxtact {

/// Returns the implementation of an object of voxtact. A moved-from object holds nothing: it may only be assigned to or
/// destroyed.
template <class Impl> [[nodiscard]] Impl& live(const std::unique_ptr<Impl>& impl) noexcept {
    assert(impl != nullptr && "an object of voxtact that was moved from is used: assign to it first");
    return *impl;
}

} // namespace voxtact
