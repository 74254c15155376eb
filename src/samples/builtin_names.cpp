// SPDX-License-Identifier: MIT
#include "core/base/guard.h"

#include "core/base/try.h"
#include "samples/builtin_name.h"
#include "voxtact/samples.h"

#include <charconv>
#include <cstddef>
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
        return Error{ErrorCode::InvalidArgument, 0,
                     "builtin " + std::string(kind) + " '" + std::string(name) + "': '" + std::string(digits) +
                         "' is not a number of " + std::string(numberOf)};
    }
    parsed.number = number;
    return parsed;
}

Result<MeshData> makeBuiltinMesh(std::string_view name) {
    return guard([&]() -> Result<MeshData> {
        Result<BuiltinName> parsed = parseBuiltinName("mesh", name, "triangles");
        VOXTACT_TRY(parsed);
        if (parsed->stem == "scalpel") {
            return makeScalpel(parsed->number.value_or(kScalpelTriangles));
        }
        if (parsed->stem == "ellipsoid") {
            return makeEllipsoid(parsed->number.value_or(kEllipsoidTriangles));
        }
        return Error{ErrorCode::InvalidArgument, 0, "unknown builtin mesh '" + parsed->stem + "': scalpel, ellipsoid"};
    });
}

} // namespace voxtact
