// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <string>
#include <utility>

/// The Python module, on the public headers alone. Errors of voxtact are values; here they become exceptions, which
/// may be thrown with or without the interpreter's lock.
namespace voxtact::python {

/// An Error on its way to Python, where it is a voxtact.Error of the class that belongs to its code.
struct Failure {
    Error error;
};

/// The value of a result, or its error as a Failure.
template <class T> T take(Result<T> result) {
    if (!result.ok()) {
        throw Failure{std::move(result.error())};
    }
    return std::move(*result);
}
inline void take(const Result<void>& result) {
    if (!result.ok()) {
        throw Failure{result.error()};
    }
}

[[noreturn]] inline void refuse(ErrorCode code, std::string text) {
    throw Failure{Error{code, 0, std::move(text)}};
}
[[noreturn]] inline void refuseArgument(std::string text) {
    refuse(ErrorCode::InvalidArgument, std::move(text));
}

/// Lets Failures that leave a function of the module become exceptions.
void registerFailures();

} // namespace voxtact::python
