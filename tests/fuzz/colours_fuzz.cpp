// SPDX-License-Identifier: MIT
// The colours of a transfer function in JSON.
#include "memory_file.h"
#include "voxtact/data.h"
#include "voxtact/io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace voxtact;
    const auto colours = io::readColours(fuzz::fileOf(data, size));
    if (!colours) {
        fuzz::requireOneLine(colours.error().text);
        return 0;
    }
    for (std::size_t i = 0; i < colours->size(); ++i) {
        const ColourPoint& point = (*colours)[i];
        for (const double channel : point.colour) {
            fuzz::require(channel >= 0 && channel <= 1, "a channel is from 0 to 1");
        }
        fuzz::require(i == 0 || point.value >= (*colours)[i - 1].value, "values ascend");
    }
    return 0;
}
