// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::io {

/// A unit of length by its name in a header: "mm", "um", "microns", "inch", ...
struct LengthUnit {
    double millimetres = 1;
    std::string unknown{}; ///< the name, where it is none that is known: millimetres are taken then

    bool operator==(const LengthUnit&) const = default;
};

/// Returns none if the name is empty or "?".
[[nodiscard]] std::optional<LengthUnit> lengthUnit(std::string_view name);

/// Says that lengths are taken to millimetres, or that the unit is not known.
void noteUnit(const LengthUnit& unit, std::vector<std::string>& notes);

} // namespace voxtact::io
