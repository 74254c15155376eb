// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
} // namespace CLI

namespace voxtact::app {

/// A part of the processes that do a run: number `index`, from 1, of `count`.
struct Shard {
    std::uint32_t index = 1;
    std::uint32_t count = 1;
};

constexpr std::uint32_t kDefaultChunk = 10000;

struct ChunkOptions {
    std::filesystem::path folder; ///< empty: the run is not in chunks
    std::optional<Shard> shard;
    std::optional<std::uint32_t> most;      ///< rows a chunk
    const char* rows = "rows";              ///< what these are, for --help and progress
    std::uint32_t standard = kDefaultChunk; ///< where `most` is not given

    [[nodiscard]] bool asked() const { return !folder.empty(); }
    [[nodiscard]] std::uint32_t chunk() const { return most.value_or(standard); }
};

void addChunkOptions(CLI::App& parser, ChunkOptions& options);

/// What is to be written once a run is whole: an option of its manifest, and where its file goes; an empty path is
/// standard output.
using MergePaths = std::vector<std::pair<std::string, std::filesystem::path>>;

} // namespace voxtact::app
