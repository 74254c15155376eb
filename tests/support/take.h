// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <stdexcept>
#include <utility>

namespace voxtact::test {

/// Returns the value of a Result; throws its error text, which fails the test.
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
