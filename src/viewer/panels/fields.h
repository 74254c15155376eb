// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

/// Number fields. Typed numbers apply when the field loses focus or on Enter; Escape restores. Dragging applies
/// immediately. Each returns true if the number changed.
namespace voxtact::view {

[[nodiscard]] bool typeNumber(const char* label, double& number, const char* format);
[[nodiscard]] bool typeNumber(const char* label, int& number);
/// Three in a row; `speed`: by a point that they are dragged.
[[nodiscard]] bool dragNumbers(const char* label, Vec3& numbers, float speed, const char* format);
[[nodiscard]] bool slideNumber(const char* label, double& number, double least, double most, const char* format);
[[nodiscard]] bool slideNumber(const char* label, int& number, int least, int most, const char* format);

} // namespace voxtact::view
