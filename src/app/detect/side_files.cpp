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
    {"--triangles", [](const DetectOptions& given) -> Path { return given.extra.triangles; },
     withoutInputs<writeTriangleHeader>, "", false},
    {"--closest", [](const DetectOptions& given) -> Path { return given.distance.closest; }, writeClosestHeader, ".csv",
     true},
    {"--label-clearance", [](const DetectOptions& given) -> Path { return given.distance.labels; },
     withoutInputs<writeLabelClearanceHeader>, "", false},
    {"--label-area", [](const DetectOptions& given) -> Path { return given.distance.labelAreas; },
     withoutInputs<writeLabelAreaHeader>, "", false},
    {"--triangle-area", [](const DetectOptions& given) -> Path { return given.distance.triangleAreas; },
     withoutInputs<writeTriangleAreaHeader>, "", false},
}};
static_assert(static_cast<std::size_t>(SideFile::TriangleArea) + 1 == kSideFiles);

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
