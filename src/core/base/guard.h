// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <exception>
#include <new>
#include <type_traits>

namespace voxtact {

/// Short enough for the small-string buffer: there may be no memory.
[[nodiscard]] inline Error noHostMemory() noexcept {
    return {ErrorCode::OutOfMemory, 0, "no host memory"};
}

/// Runs `body` (which returns a Result) and converts exceptions to an Error, so that none crosses the public boundary.
template <class Body> std::invoke_result_t<Body> guard(Body&& body) noexcept {
    try {
        return body();
    } catch (const std::bad_alloc&) {
        return noHostMemory();
    } catch (const std::exception& exception) {
        try {
            return Error{ErrorCode::Internal, 0, exception.what()};
        } catch (...) {
            return noHostMemory();
        }
    }
}

} // namespace voxtact
