// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <string>
#include <utility>

namespace voxtact {

/// What a caller gave cannot be used; `text` says which argument, why, and what to do.
[[nodiscard]] inline Error refuse(std::string text) {
    return Error{ErrorCode::InvalidArgument, 0, std::move(text)};
}

} // namespace voxtact
