// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/try.h"
#include "samples/builtin_name.h"
#include "voxtact/samples.h"

#include <charconv>
#include <cstddef>
#include <optional>
#include <string>
#include <system_error>

namespace voxtact {

Result<BuiltinName> parseBuiltinName(std::string_view kind, std::string_view name, std::string_view numberOf) {
    BuiltinName parsed;
    const std::size_t colon = name.find(':');
    parsed.stem = name.substr(0, colon);
    if (colon == std::string_view::npos) {
        return parsed;
    }
    const std::string_view digits = name.substr(colon + 1);
    const char* const end = digits.data() + digits.size();
    std::uint32_t number = 0;
    const std::from_chars_result read = std::from_chars(digits.data(), end, number);
    if (digits.empty() || read.ptr != end || read.ec != std::errc{}) {
        return refuse("builtin " + std::string(kind) + " '" + std::string(name) + "': '" + std::string(digits) +
                      "' is not a number of " + std::string(numberOf));
    }
    parsed.number = number;
    return parsed;
}

namespace {

constexpr std::string_view kNeedle = "needle";

/// Parses all of a text.
std::optional<double> numberIn(std::string_view text) {
    double out = 0;
    const std::from_chars_result read = std::from_chars(text.data(), text.data() + text.size(), out);
    return !text.empty() && read.ptr == text.data() + text.size() && read.ec == std::errc{} ? std::optional(out)
                                                                                            : std::nullopt;
}

/// `sizes`: what comes after the first colon.
Result<MeshData> needleOf(std::string_view name, std::string_view sizes) {
    const std::size_t colon = sizes.find(':');
    const std::optional<double> diameter = numberIn(sizes.substr(0, colon));
    const std::optional<double> length =
        colon == std::string_view::npos ? std::nullopt : numberIn(sizes.substr(colon + 1));
    if (!diameter || !length) {
        return refuse("builtin mesh '" + std::string(name) +
                      "': it is not needle:DIAMETER:LENGTH with two numbers, mm");
    }
    return makeNeedle(*diameter, *length);
}

} // namespace

Result<MeshData> makeBuiltinMesh(std::string_view name) {
    return guard([&]() -> Result<MeshData> {
        if (name == kNeedle) {
            return makeNeedle(kNeedleDiameter, kNeedleLength);
        }
        if (name.starts_with(kNeedle) && name[kNeedle.size()] == ':') {
            return needleOf(name, name.substr(kNeedle.size() + 1));
        }
        Result<BuiltinName> parsed = parseBuiltinName("mesh", name, "triangles");
        VOXTACT_TRY(parsed);
        if (parsed->stem == "scalpel") {
            return makeScalpel(parsed->number.value_or(kScalpelTriangles));
        }
        if (parsed->stem == "ellipsoid") {
            return makeEllipsoid(parsed->number.value_or(kEllipsoidTriangles));
        }
        return refuse("unknown builtin mesh '" + parsed->stem + "': scalpel, ellipsoid, needle");
    });
}

} // namespace voxtact
