// SPDX-License-Identifier: MIT
// Transfer functions, as text and as JSON, and the table made of what they say.
#include "memory_file.h"
#include "voxtact/data.h"
#include "voxtact/io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace voxtact;
    const auto points = io::readTransferFunction(fuzz::fileOf(data, size));
    if (!points) {
        fuzz::requireOneLine(points.error().text);
        return 0;
    }
    fuzz::require(!points->empty(), "a file that is read has a point");
    for (std::size_t i = 0; i < points->size(); ++i) {
        const ControlPoint& point = (*points)[i];
        fuzz::require(point.opacity >= 0 && point.opacity <= 1, "an opacity is from 0 to 1");
        fuzz::require(i == 0 || point.value >= (*points)[i - 1].value, "values ascend");
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
