// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <string>
#include <utility>

namespace voxtact {

/// Returns InvalidArgument; `text` names the argument, the reason and the fix.
[[nodiscard]] inline Error refuse(std::string text) {
    return Error{ErrorCode::InvalidArgument, 0, std::move(text)};
}

} // namespace voxtact
