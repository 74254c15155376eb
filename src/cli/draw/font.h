// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace voxtact::app {

/// A TrueType file; written by embed_bytes.cmake.
extern const unsigned char kFont[];
extern const std::size_t kFontBytes;

} // namespace voxtact::app
