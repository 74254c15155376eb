// SPDX-License-Identifier: MIT
#pragma once

#include "c/errors.h"

/// Functions of a part that this build of the library does not have: they are there, so that the interface is the same,
/// and refuse.
namespace voxtact::c {

[[nodiscard]] inline vxt_result absent(const char* why) noexcept {
    return call([&] { refuse(ErrorCode::Unsupported, why); });
}

/// For a function that creates an object.
template <class Handle> [[nodiscard]] vxt_result absent(const char* why, Handle** out) noexcept {
    if (out != nullptr) {
        *out = nullptr;
    }
    return absent(why);
}

} // namespace voxtact::c
