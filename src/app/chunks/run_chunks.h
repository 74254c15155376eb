// SPDX-License-Identifier: MIT
#pragma once

#include "app/chunks/chunk_options.h"
#include "app/chunks/run_folder.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// `--shard`, `--resume` and `--chunk`: a run in chunks, which one process does or many do, and which goes on where it
/// was.
namespace voxtact::app {

/// An option that a run in chunks cannot have, and why.
struct Unfit {
    bool given = false;
    const char* option = "";
    const char* why = "";
};
/// Refuses options that mean nothing without --resume, and with it those that are unfit.
[[nodiscard]] Result<void> checkChunkOptions(const ChunkOptions& options, const OutputOptions& output,
                                             std::vector<Unfit> unfit);

/// The facts of a command's run but for its inputs: the program, and the options but for those that make no other run
/// (who does how much of it, and where its output goes) and those of `without`.
[[nodiscard]] RunFacts runFacts(const CLI::App& parser, const ChunkOptions& options, const OutputOptions& output,
                                std::vector<std::string> without = {});
/// The table of a run; `empty` has its columns and facts, and no rows.
[[nodiscard]] RunOutput tableOutput(io::Format format, const io::Table& empty);

/// Says which chunk is next. The default is a shard's own list; of the ranks of a cluster the first one deals.
class ChunkDealer {
  public:
    ChunkDealer() = default;
    ChunkDealer(const ChunkDealer&) = delete;
    ChunkDealer& operator=(const ChunkDealer&) = delete;
    virtual ~ChunkDealer() = default;

    /// Whether this process is the one that makes the folder, and merges.
    [[nodiscard]] virtual bool leads() const = 0;
    /// Once the leader has the folder; the others wait here for that.
    virtual void begin(const RunFolder* folder, const ChunkCut& cut) = 0;
    /// The next chunk; nothing: there are no more.
    [[nodiscard]] virtual std::optional<std::uint64_t> next() = 0;
    /// Rows that are done and did not come from next() here.
    [[nodiscard]] virtual std::uint64_t rowsElsewhere() const { return 0; }
    /// Waits until all have done what they were dealt; calls `tick` now and then.
    virtual void end(const std::function<void()>& tick) = 0;
};
/// From now on this one deals; it must outlive all runs. One process, one dealer.
void useDealer(ChunkDealer* dealer);

/// What a command says of a run.
struct ChunkedRun {
    std::string command; ///< "voxtact detect"
    ChunkOptions options;
    RunManifest manifest; ///< but the number of chunks
    ChunkCut cut;
    bool progress = false;
};

/// Where a chunk's parts go: a file for each output of the manifest, sealed by its first line.
struct ChunkFiles {
    const RunFolder& folder;
    std::uint64_t chunk = 0;

    /// The output of an option, or a part of it, which the manifest must have.
    [[nodiscard]] Result<ResultFile> create(const std::string& option, const std::string& part = {}) const;
};

/// Does a chunk: all of its files, committed. `rows`: how many rows of it are done, for progress. Where an interrupt
/// came it does none, and well.
using DoChunk = std::function<Result<void>(const ChunkRange& range, const ChunkFiles& files,
                                           const std::function<void(std::uint64_t)>& rows)>;

/// Does the chunks that are dealt to this process and are not there yet; with all of them there, and no shard asked
/// for, merges. What is to be said is added to `notes`.
[[nodiscard]] Outcome doChunks(ChunkedRun run, const DoChunk& doChunk, const MergePaths& paths,
                               std::vector<std::string>& notes);

/// Writes the outputs of a run whose chunks are all there and whole; refuses any other.
[[nodiscard]] Result<void> mergeRun(const RunFolder& folder, const MergePaths& paths);

} // namespace voxtact::app
