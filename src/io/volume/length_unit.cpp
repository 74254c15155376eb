// SPDX-License-Identifier: MIT
#include "io/volume/length_unit.h"
#include "core/base/text.h"
#include "io/errors.h"
#include "io/text/text_lines.h"

#include <algorithm>
#include <array>

namespace voxtact::io {

namespace {

struct NamedUnit {
    double millimetres;
    std::array<std::string_view, 7> names;
};

// The micro sign has two characters.
constexpr std::array<NamedUnit, 6> kUnits{{
    {1, {"mm", "millimeter", "millimeters", "millimetre", "millimetres"}},
    {1e3, {"m", "meter", "meters", "metre", "metres"}},
    {10, {"cm", "centimeter", "centimeters", "centimetre", "centimetres"}},
    {1e-3, {"um", "\xC2\xB5m", "\xCE\xBCm", "micron", "microns", "micrometer", "micrometers"}},
    {1e-6, {"nm", "nanometer", "nanometers", "nanometre", "nanometres"}},
    {25.4, {"in", "inch", "inches"}},
}};

} // namespace

std::optional<LengthUnit> lengthUnit(std::string_view name) {
    name = trimmed(name);
    if (name.empty() || name == "?" || name == "???") {
        return std::nullopt;
    }
    // But for Mm, which is not mm, and M.
    const std::string wanted = name == "Mm" || name == "M" ? std::string(name) : lowered(std::string(name));
    for (const NamedUnit& known : kUnits) {
        if (std::find(known.names.begin(), known.names.end(), wanted) != known.names.end()) {
            return LengthUnit{known.millimetres, {}};
        }
    }
    return LengthUnit{1, std::string(name)};
}

void noteUnit(const LengthUnit& unit, std::vector<std::string>& notes) {
    if (!unit.unknown.empty()) {
        notes.push_back("the file's unit of length, " + inQuotes(unit.unknown) +
                        ", is none that is known; millimetres are taken");
    } else if (unit.millimetres != 1) {
        notes.push_back("the file's unit of length is " + number(unit.millimetres) +
                        " mm; its lengths are taken to millimetres");
    }
}

} // namespace voxtact::io
