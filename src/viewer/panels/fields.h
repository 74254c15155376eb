// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

/// Fields for numbers. What is typed is taken when its field is left or Enter is pressed, and Escape leaves what was
/// there: half a number is none. What is dragged is taken at once. Each says whether there is another number.
namespace voxtact::view {

[[nodiscard]] bool typeNumber(const char* label, double& number, const char* format);
[[nodiscard]] bool typeNumber(const char* label, int& number);
/// Three in a row; `speed`: by a point that they are dragged.
[[nodiscard]] bool dragNumbers(const char* label, Vec3& numbers, float speed, const char* format);
[[nodiscard]] bool slideNumber(const char* label, double& number, double least, double most, const char* format);
[[nodiscard]] bool slideNumber(const char* label, int& number, int least, int most, const char* format);

} // namespace voxtact::view
