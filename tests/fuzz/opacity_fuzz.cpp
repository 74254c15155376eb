// SPDX-License-Identifier: MIT
// The list of --opacity, and the table made of what it says.
#include "fuzz.h"
#include "voxtact/data.h"
#include "voxtact/io.h"

#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace voxtact;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto points = io::parseOpacity(text);
    if (!points) {
        fuzz::requireOneLine(points.error().text);
        return 0;
    }
    fuzz::require(!points->empty(), "a list that is read has a point");
    for (const ControlPoint& point : *points) {
        fuzz::require(point.opacity >= 0 && point.opacity <= 1, "an opacity is from 0 to 1");
    }
    const auto table = sampleTable({.points = *points, .domain = {-1000, 3000}, .tableSize = 16});
    if (!table) {
        fuzz::requireOneLine(table.error().text);
        return 0;
    }
    for (const float opacity : *table) {
        fuzz::require(opacity >= 0 && opacity <= 1, "an entry of the table is from 0 to 1");
    }
    return 0;
}
