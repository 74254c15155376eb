// SPDX-License-Identifier: MIT
#include "app/chunks/frames.h"
#include "app/chunks/run_chunks.h"
#include "app/output/standard_streams.h"
#include "app/output/target_path.h"
#include "core/base/try.h"

#include <algorithm>
#include <cerrno>
#include <ostream>
#include <system_error>

namespace voxtact::app {

namespace {

/// Standard output takes what comes, part by part: a run need not fit into memory.
class Sink {
  public:
    [[nodiscard]] static Result<Sink> create(const std::filesystem::path& path) {
        Sink sink;
        if (!path.empty() && path != "-") {
            Result<io::OutputFile> file = io::OutputFile::create(path);
            VOXTACT_TRY(file);
            sink.file_ = std::move(*file);
        }
        return sink;
    }
    void write(std::string_view text) {
        if (file_) {
            file_->stream().write(text.data(), static_cast<std::streamsize>(text.size()));
        } else if (failure_.ok()) {
            failure_ = writeStandardOutput(text);
        }
    }
    /// Whether all went well so far.
    [[nodiscard]] Result<void> state() { return file_ && !file_->stream() ? file_->close() : failure_; }
    [[nodiscard]] Result<void> close() { return file_ ? file_->close() : failure_; }
    /// Null: standard output.
    [[nodiscard]] io::OutputFile* file() noexcept { return file_ ? &*file_ : nullptr; }

  private:
    Sink() = default;

    std::optional<io::OutputFile> file_;
    Result<void> failure_;
};

/// "shards 3/7 and 5/7": those that have begun here and have not all of their chunks.
std::string shardsText(const RunFolder& folder, const std::vector<std::uint64_t>& missing) {
    std::string text;
    std::size_t named = 0;
    constexpr std::size_t kMostNamed = 8;
    for (const Shard& shard : folder.shards()) {
        const auto [begin, end] = chunksOf(shard, folder.manifest().chunks);
        const auto first = std::lower_bound(missing.begin(), missing.end(), begin);
        if (first == missing.end() || *first >= end) {
            continue;
        }
        if (++named > kMostNamed) {
            return text + ", ...";
        }
        text += (text.empty() ? "of shard " : ", ") + std::to_string(shard.index) + "/" + std::to_string(shard.count);
    }
    return text;
}

/// All chunks are there and whole. Nothing is written before that is known.
Result<void> checkChunks(const RunFolder& folder) {
    std::vector<std::uint64_t> missing;
    std::vector<std::uint64_t> damaged;
    for (std::uint64_t chunk = 0; chunk < folder.manifest().chunks; ++chunk) {
        const ChunkState state = folder.stateOf(chunk);
        if (state != ChunkState::Whole) {
            (state == ChunkState::Missing ? missing : damaged).push_back(chunk);
        }
    }
    if (missing.empty() && damaged.empty()) {
        return {};
    }
    const auto text = [&](const std::vector<std::uint64_t>& which, const std::string& what) {
        const std::string shards = shardsText(folder, which);
        return std::to_string(which.size()) + " of " + std::to_string(folder.manifest().chunks) + " chunks are " +
               what + (shards.empty() ? ", the first is number " + std::to_string(which.front()) : " (" + shards + ")");
    };
    return Error{ErrorCode::File, 0,
                 "cannot merge " + folderText(folder.path()) + ": " +
                     (damaged.empty() ? "" : text(damaged, "damaged or cannot be read")) +
                     (damaged.empty() || missing.empty() ? "" : ", and ") +
                     (missing.empty() ? "" : text(missing, "missing")) +
                     "; run the same commands again with --resume, they do only these"};
}

Error changed(const RunFolder& folder, std::uint64_t chunk) {
    return {ErrorCode::File, 0,
            "cannot merge " + folderText(folder.path()) + ": chunk " + std::to_string(chunk) +
                " changed while it was read, or can be read no more"};
}

/// Hands out what an output has of a chunk.
Result<void> readChunk(const RunFolder& folder, std::uint64_t chunk, const RunOutput& output,
                       const std::function<void(std::string_view)>& take) {
    const SealState state = readSealed(folder.chunkPath(chunk, output), folder.chunkLine(chunk, output), take);
    return state == SealState::Whole ? Result<void>() : changed(folder, chunk);
}

/// Adds a part of a file, or all of it.
Result<void> writeOutput(const RunFolder& folder, const RunOutput& output, Sink& sink) {
    sink.write(output.head);
    for (std::uint64_t chunk = 0; chunk < folder.manifest().chunks; ++chunk) {
        if (chunk > 0) {
            sink.write(output.between);
        }
        VOXTACT_TRY(readChunk(folder, chunk, output, [&](std::string_view part) { sink.write(part); }));
        VOXTACT_TRY(sink.state());
    }
    sink.write(output.tail);
    return sink.state();
}

/// Adds a file for each target.
Result<void> writeTargets(const RunFolder& folder, const RunOutput& output, const std::filesystem::path& path,
                          std::vector<Sink>& files) {
    std::size_t begun = 0;
    FrameReader reader({[&]() -> Result<void> {
                            if (begun == output.targets.size()) {
                                return Error{ErrorCode::Format, 0, "it has more files than targets"};
                            }
                            Result<Sink> sink = Sink::create(targetPath(path, output.targets[begun++]));
                            VOXTACT_TRY(sink);
                            files.push_back(std::move(*sink));
                            return {};
                        },
                        [&](std::string_view part) {
                            files.back().write(part);
                            return files.back().state();
                        },
                        [&] { return files.back().close(); }});
    for (std::uint64_t chunk = 0; chunk < folder.manifest().chunks; ++chunk) {
        Result<void> done;
        VOXTACT_TRY(readChunk(folder, chunk, output,
                              [&](std::string_view part) { done = done.ok() ? reader.add(part) : done; }));
        VOXTACT_TRY(done);
    }
    return begun == output.targets.size() && reader.isBetween() ? Result<void>()
                                                                : changed(folder, folder.manifest().chunks - 1);
}

/// The files of an option, whole, under temporary names.
Result<void> writeFiles(const RunFolder& folder, const std::string& option, const std::filesystem::path& path,
                        std::vector<Sink>& files) {
    const std::vector<const RunOutput*> parts = folder.manifest().outputsOf(option);
    if (parts.empty()) {
        return {};
    }
    if (!parts.front()->targets.empty()) {
        return writeTargets(folder, *parts.front(), path, files);
    }
    Result<Sink> sink = Sink::create(path);
    VOXTACT_TRY(sink);
    for (const RunOutput* part : parts) {
        VOXTACT_TRY(writeOutput(folder, *part, *sink));
    }
    VOXTACT_TRY(sink->close());
    files.push_back(std::move(*sink));
    return {};
}

} // namespace

Result<void> mergeRun(const RunFolder& folder, const MergePaths& paths) {
    VOXTACT_TRY(checkChunks(folder));
    // Files first, each whole before one gets its name; what is on standard output cannot be taken back.
    std::vector<Sink> files;
    const auto isFile = [](const std::filesystem::path& path) { return !path.empty() && path != "-"; };
    for (const bool file : {true, false}) {
        for (const auto& [option, path] : paths) {
            if (isFile(path) == file) {
                VOXTACT_TRY(writeFiles(folder, option, path, files));
            }
        }
    }
    std::vector<io::OutputFile*> all;
    for (auto sink = files.rbegin(); sink != files.rend(); ++sink) {
        if (sink->file() != nullptr) {
            all.push_back(sink->file());
        }
    }
    return io::OutputFile::commitAll(all);
}

} // namespace voxtact::app
