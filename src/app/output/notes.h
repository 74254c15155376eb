// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

namespace voxtact::app {

/// From now on notes go there instead of to standard error; nothing: to standard error again. Calls come from the
/// thread that prints; one process, one place.
void useNotes(std::function<void(const std::string& text)> take);

} // namespace voxtact::app
