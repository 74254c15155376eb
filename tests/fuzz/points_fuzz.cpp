// SPDX-License-Identifier: MIT
// Files of points. The first byte says which ending the file has.
#include "file_folder.h"
#include "voxtact/io.h"

#include <array>
#include <cmath>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace voxtact;
    if (size == 0) {
        return 0;
    }
    constexpr std::array kNames{"p.txt", "p.fcsv", "p.mrk.json"};
    const std::filesystem::path path = fuzz::folder() / kNames[data[0] % kNames.size()];
    fuzz::write(path, {reinterpret_cast<const char*>(data) + 1, size - 1});
    const auto points = io::readPoints(path);
    std::filesystem::remove(path);
    if (!points) {
        fuzz::requireOneLine(points.error().text);
        return 0;
    }
    fuzz::require(!points->empty(), "a file that is read has a point");
    for (const io::NamedPoint& point : *points) {
        for (const double coordinate : point.position) {
            fuzz::require(std::isfinite(coordinate), "a point that is read is finite");
        }
    }
    return 0;
}
