// SPDX-License-Identifier: MIT
#include "app/detect/side_files.h"

#include "app/detect/detect_files.h"

namespace voxtact::app {

namespace {

template <void (*Write)(std::ostream&, const DetectOptions&)>
void withoutInputs(std::ostream& out, const DetectOptions& options, const DetectInputs& /*inputs*/) {
    Write(out, options);
}

using Path = const std::filesystem::path&;

constexpr std::array<SideFileFacts, kSideFiles> kTable{{
    {SideFile::Triangles, "--triangles", [](const DetectOptions& given) -> Path { return given.extra.triangles; },
     withoutInputs<writeTriangleHeader>, "", false},
    {SideFile::Closest, "--closest", [](const DetectOptions& given) -> Path { return given.distance.closest; },
     writeClosestHeader, ".csv", true},
    {SideFile::LabelClearance, "--label-clearance",
     [](const DetectOptions& given) -> Path { return given.distance.labels; }, withoutInputs<writeLabelClearanceHeader>,
     "", false},
    {SideFile::LabelArea, "--label-area", [](const DetectOptions& given) -> Path { return given.distance.labelAreas; },
     withoutInputs<writeLabelAreaHeader>, "", false},
    {SideFile::TriangleArea, "--triangle-area",
     [](const DetectOptions& given) -> Path { return given.distance.triangleAreas; },
     withoutInputs<writeTriangleAreaHeader>, "", false},
}};
static_assert([] {
    for (std::size_t i = 0; i < kSideFiles; ++i) {
        if (kTable[i].file != static_cast<SideFile>(i)) {
            return false;
        }
    }
    return true;
}());

} // namespace

const std::array<SideFileFacts, kSideFiles>& sideFileTable() noexcept {
    return kTable;
}

MergePaths sideFiles(const DetectOptions& options) {
    MergePaths paths;
    for (const SideFileFacts& side : kTable) {
        paths.emplace_back(side.option, side.path(options));
    }
    return paths;
}

} // namespace voxtact::app
