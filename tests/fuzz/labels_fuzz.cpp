// SPDX-License-Identifier: MIT
// Segmentations: NRRD by its first word, else one DICOM file.
#include "file_folder.h"
#include "fuzz.h"
#include "voxtact/io.h"

#include <filesystem>
#include <fstream>
#include <string_view>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace voxtact;
    const std::string_view content(reinterpret_cast<const char*>(data), size);
    const auto path = fuzz::folder() / (content.starts_with("NRRD") ? "input.seg.nrrd" : "input.dcm");
    std::ofstream(path, std::ios::binary).write(content.data(), static_cast<std::streamsize>(size));
    Grid grid;
    grid.size = {20, 16, 6};
    grid.spacing = {0.5, 0.8, 2.5};
    grid.origin = {-3, 4, 7};
    const auto file = io::readLabels(path, {.grid = grid});
    if (!file) {
        fuzz::requireOneLine(file.error().text);
        fuzz::require(file.error().code != ErrorCode::Internal, "bad input is no bug of ours");
        return 0;
    }
    fuzz::require(checkGrid(file->labels.grid).ok(), "a label map has a grid");
    fuzz::require(file->labels.indices.size() == voxelCount(file->labels.grid), "each voxel has a label");
    for (const std::uint16_t index : file->labels.indices) {
        fuzz::require(index < file->labels.values.size(), "each label has a number");
    }
    for (const std::string& note : file->notes) {
        fuzz::requireOneLine(note);
    }
    return 0;
}
