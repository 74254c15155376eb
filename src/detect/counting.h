// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/methods.h"

namespace voxtact {

[[nodiscard]] inline bool countsByQuery(CountingMethod method) noexcept {
    return method == CountingMethod::Query || method == CountingMethod::QueryAny;
}

} // namespace voxtact
