// SPDX-License-Identifier: MIT
// Transfer functions, as text, as JSON and as a volume property of 3D Slicer, and the table made of what they say.
#include "file_folder.h"
#include "memory_file.h"
#include "voxtact/data.h"
#include "voxtact/io.h"

namespace {

void requireFunction(const std::filesystem::path& path) {
    using namespace voxtact;
    const auto points = io::readTransferFunction(path);
    if (!points) {
        fuzz::requireOneLine(points.error().text);
        return;
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
        return;
    }
    for (const float opacity : *table) {
        fuzz::require(opacity >= 0 && opacity <= 1, "an entry of the table is from 0 to 1");
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace fuzz = voxtact::fuzz;
    requireFunction(fuzz::fileOf(data, size));
    const std::filesystem::path property = fuzz::folder() / "f.vp";
    fuzz::write(property, {reinterpret_cast<const char*>(data), size});
    requireFunction(property);
    std::filesystem::remove(property);
    return 0;
}
