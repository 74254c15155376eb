// SPDX-License-Identifier: MIT
#pragma once

#include "app/chunks/chunk_cut.h"
#include "app/chunks/chunk_options.h"
#include "app/chunks/run_manifest.h"
#include "app/chunks/sealed_file.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

/// The folder where a run in chunks comes together: a manifest, files of chunks, files that are locks.
namespace voxtact::app {

enum class ChunkState { Missing, Whole, Damaged };

/// Thread-safety: none; one thread at a time. Processes may share a folder.
class RunFolder {
  public:
    /// Makes the folder, or goes on with it: refuses one that has something else, another run, or a shard that another
    /// process is doing. It is locked while this lives. A manifest that is damaged is written anew where some chunk is
    /// this run's, or there is nothing yet.
    [[nodiscard]] static Result<RunFolder> open(const std::filesystem::path& path, const RunManifest& manifest,
                                                const std::optional<Shard>& shard);
    /// The same without making or locking it: for a process whose leader has done that.
    [[nodiscard]] static Result<RunFolder> join(const std::filesystem::path& path, const RunManifest& manifest);
    /// For who reads what there is.
    [[nodiscard]] static Result<RunFolder> read(const std::filesystem::path& path);
    RunFolder(RunFolder&&) noexcept;
    RunFolder& operator=(RunFolder&&) noexcept;
    ~RunFolder();

    /// The manifest that is in the folder.
    [[nodiscard]] const RunManifest& manifest() const noexcept { return manifest_; }
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    /// Whether open() found the manifest damaged, and has written it anew.
    [[nodiscard]] bool isWrittenAnew() const noexcept { return isWrittenAnew_; }

    /// Where an output's part of a chunk is, and the first line of that file.
    [[nodiscard]] std::filesystem::path chunkPath(std::uint64_t chunk, const RunOutput& output) const;
    [[nodiscard]] std::string chunkLine(std::uint64_t chunk, const RunOutput& output) const;
    /// Reads all of it.
    [[nodiscard]] ChunkState stateOf(std::uint64_t chunk) const;
    /// How many chunks have all of their files, whoever did them. Reads none.
    [[nodiscard]] std::uint64_t chunksThere() const;
    /// The shards that processes have begun here.
    [[nodiscard]] std::vector<Shard> shards() const;

  private:
    class Lock;

    RunFolder(std::filesystem::path path, RunManifest manifest);
    [[nodiscard]] Result<void> lock(const std::optional<Shard>& shard);
    /// Returns whether the manifest was damaged, and is written anew.
    [[nodiscard]] Result<bool> writeAnewIfDamaged() const;
    [[nodiscard]] Result<bool> writeAnew() const;
    /// Whether a file is named as one of this run's chunks.
    [[nodiscard]] bool isChunk(const std::string& name) const;

    std::filesystem::path path_;
    RunManifest manifest_;
    std::string id_;
    std::vector<Lock> locks_;
    bool isWrittenAnew_ = false;
};

/// The chunks of a shard: neighbours, so that a volume is read by few. [first, end).
[[nodiscard]] std::pair<std::uint64_t, std::uint64_t> chunksOf(const Shard& shard, std::uint64_t chunks);

/// "'DIR'", for a message.
[[nodiscard]] std::string folderText(const std::filesystem::path& path);

} // namespace voxtact::app
