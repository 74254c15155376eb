// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <stdexcept>
#include <utility>

namespace voxtact::test {

/// What a Result holds; an exception with its text where that is an error, which fails the test.
template <class T> T take(Result<T> result) {
    if (!result.ok()) {
        throw std::runtime_error(result.error().text);
    }
    return std::move(*result);
}
inline void take(const Result<void>& result) {
    if (!result.ok()) {
        throw std::runtime_error(result.error().text);
    }
}

} // namespace voxtact::test
