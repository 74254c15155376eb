// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <exception>
#include <new>
#include <type_traits>

namespace voxtact {

/// Runs `body` (which returns a Result) and turns whatever it throws into an Error, so that nothing crosses the
/// public boundary.
template <class Body> std::invoke_result_t<Body> guard(Body&& body) noexcept {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::OutOfMemory, 0, "out of host memory"};
    } catch (const std::exception& exception) {
        return Error{ErrorCode::Internal, 0, exception.what()};
    }
}

} // namespace voxtact
