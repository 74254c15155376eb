// SPDX-License-Identifier: MIT
#include "app/chunks/run_chunks.h"

#include "app/output/interrupt.h"
#include "app/output/progress.h"
#include "app/version.h"
#include "core/base/text_stream.h"
#include "core/base/try.h"
#include "core/base/whole_path.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>

namespace voxtact::app {

namespace {

/// Each is a file or more, in one folder.
constexpr std::uint64_t kMostChunks = 10'000'000;

ChunkDealer* dealer = nullptr;

/// A shard's chunks one after the other, so that poses are read once.
class OwnList : public ChunkDealer {
  public:
    explicit OwnList(const std::optional<Shard>& shard) : shard_(shard.value_or(Shard{})) {}

    [[nodiscard]] bool leads() const override { return true; }
    void begin(const RunFolder* /*folder*/, const ChunkCut& cut) override {
        std::tie(next_, end_) = chunksOf(shard_, cut.chunks());
    }
    [[nodiscard]] std::optional<std::uint64_t> next() override {
        return next_ < end_ ? std::optional(next_++) : std::nullopt;
    }
    void end(const std::function<void()>& /*tick*/) override {}

  private:
    Shard shard_;
    std::uint64_t next_ = 0;
    std::uint64_t end_ = 0;
};

std::optional<Shard> parseShard(std::string_view text) {
    Shard shard;
    const char* const end = text.data() + text.size();
    const auto [slash, badIndex] = std::from_chars(text.data(), end, shard.index);
    if (badIndex != std::errc() || slash == end || *slash != '/') {
        return std::nullopt;
    }
    const auto [rest, badCount] = std::from_chars(slash + 1, end, shard.count);
    return badCount == std::errc() && rest == end && shard.index >= 1 && shard.index <= shard.count
               ? std::optional(shard)
               : std::nullopt;
}

/// How many chunks a process did, found, and found damaged.
struct Tally {
    std::uint64_t done = 0;
    std::uint64_t found = 0;
    std::uint64_t damaged = 0;
};

class Doing {
  public:
    Doing(const ChunkedRun& run, const RunFolder& folder, const DoChunk& doChunk, ChunkDealer& dealing)
        : run_(run), folder_(folder), doChunk_(doChunk), dealing_(dealing),
          // Of all that this process may do, or see others do.
          progress_(run.progress && dealing.leads(), run.command + ": " + run.options.rows, rowsOf(run)) {}

    [[nodiscard]] Result<void> all() {
        while (!interrupted()) {
            const std::optional<std::uint64_t> chunk = dealing_.next();
            if (!chunk) {
                break;
            }
            VOXTACT_TRY(one(run_.cut.at(*chunk)));
        }
        dealing_.end([&] { show(0); });
        return {};
    }
    [[nodiscard]] const Tally& tally() const noexcept { return tally_; }

  private:
    static std::uint64_t rowsOf(const ChunkedRun& run) {
        const auto [begin, end] = chunksOf(run.options.shard.value_or(Shard{}), run.cut.chunks());
        std::uint64_t rows = 0;
        for (std::uint64_t chunk = begin; chunk < end; ++chunk) {
            rows += run.cut.at(chunk).count;
        }
        return rows;
    }

    [[nodiscard]] Result<void> one(const ChunkRange& range) {
        const ChunkState state = folder_.stateOf(range.number);
        if (state == ChunkState::Whole) {
            ++tally_.found;
        } else {
            tally_.damaged += state == ChunkState::Damaged ? 1 : 0;
            VOXTACT_TRY(doChunk_(range, {folder_, range.number}, [&](std::uint64_t rows) { show(rows); }));
            tally_.done += interrupted() ? 0 : 1;
        }
        rows_ += range.count;
        show(0);
        return {};
    }

    /// With so many rows of the chunk that is being done.
    void show(std::uint64_t rows) { progress_.update(rows_ + rows + dealing_.rowsElsewhere()); }

    const ChunkedRun& run_;
    const RunFolder& folder_;
    const DoChunk& doChunk_;
    ChunkDealer& dealing_;
    Progress progress_;
    Tally tally_;
    std::uint64_t rows_ = 0;
};

std::string chunksText(std::uint64_t count) {
    return std::to_string(count) + (count == 1 ? " chunk" : " chunks");
}

/// What there is in addition to the error, for who asks what is lost.
Error withWhatIsThere(Error error, const RunFolder& folder) {
    if (error.code == ErrorCode::File) {
        error.text += "; " + chunksText(folder.chunksThere()) + " in " + folderText(folder.path()) +
                      " stay as they are, and the same command goes on from there";
    }
    return error;
}

void addNotes(const RunFolder& folder, const Tally& tally, std::vector<std::string>& notes) {
    if (folder.isWrittenAnew()) {
        notes.push_back("the manifest in " + folderText(folder.path()) + " was damaged and is written anew");
    }
    if (tally.damaged > 0) {
        notes.push_back(chunksText(tally.damaged) + " in " + folderText(folder.path()) +
                        (tally.damaged == 1 ? " was" : " were") + " damaged and done again");
    }
    if (tally.found > 0) {
        notes.push_back(chunksText(tally.found) + " of " + std::to_string(tally.found + tally.done) + " in " +
                        folderText(folder.path()) + (tally.found == 1 ? " was" : " were") + " there already");
    }
}

} // namespace

void addChunkOptions(CLI::App& parser, ChunkOptions& options) {
    addPath(parser, "--resume", options.folder,
            "a folder for the run in chunks, which is made: a run that was ended goes on with what is there; many "
            "processes may share one");
    addText(
        parser, "--shard",
        [&options](const std::string& text) -> std::optional<std::string> {
            options.shard = parseShard(text);
            return options.shard
                       ? std::nullopt
                       : std::optional<std::string>("is not I/N, two whole numbers below 2^32 with I from 1 to N");
        },
        "with --resume: does only the I-th of N parts of the run, and writes no output; voxtact merge does, once all "
        "parts are there",
        "I/N");
    addWholeNumber(
        parser, "--chunk", [&options](std::uint32_t rows) { options.most = rows; }, {.least = 1},
        std::string("with --resume: ") + options.rows +
            " a chunk, at most; what is done again after an end is less than that",
        options.standard);
}

Result<void> checkChunkOptions(const ChunkOptions& options, const OutputOptions& output, std::vector<Unfit> unfit) {
    if (!options.asked()) {
        for (const auto& [given, option] :
             {std::pair(options.shard.has_value(), "--shard"), std::pair(options.most.has_value(), "--chunk")}) {
            if (given) {
                return badArgument(option + std::string(": it is about a run in chunks; give its folder by --resume"));
            }
        }
        return {};
    }
    unfit.push_back({output.formatName == "text", "--format text",
                     "the columns are as wide as the rows before; choose csv or json"});
    unfit.push_back({options.shard && !output.path.empty(), "--output",
                     "a shard writes no output; give it to voxtact merge, which does"});
    unfit.push_back({!output.path.empty() && realPath(output.path) == realPath(options.folder), "--output",
                     "it is the run's folder; each needs a path of its own"});
    for (const Unfit& entry : unfit) {
        if (entry.given) {
            return badArgument(entry.option + std::string(": not with ") +
                               (options.shard ? "--shard and --resume: " : "--resume: ") + entry.why);
        }
    }
    return {};
}

RunFacts runFacts(const CLI::App& parser, const ChunkOptions& options, const OutputOptions& output,
                  std::vector<std::string> without) {
    // Two of them are facts as they are used: the default, given, is the default.
    RunFacts facts{{"command", parser.get_name()},
                   {"version", std::string(programVersion()) + " " + gitRevision()},
                   {"--format", output.format() == io::Format::Json ? "json" : "csv"},
                   {"--chunk", std::to_string(options.chunk())}};
    for (const char* option : {"--resume", "--shard", "--chunk", "--output", "--format", "--threads", "--batch",
                               "--progress", "--cache", "--device"}) {
        without.emplace_back(option);
    }
    addOptionFacts(facts, parser, without);
    return facts;
}

RunOutput tableOutput(io::Format format, const io::Table& empty) {
    TextStream head;
    TextStream tail;
    io::TableWriter(head, format).add(empty);
    io::TableWriter(tail, format).end();
    return {"--output", "", head.str(), format == io::Format::Json ? "," : "", tail.str()};
}

void useDealer(ChunkDealer* other) {
    dealer = other;
}

Result<ResultFile> ChunkFiles::create(const std::string& option, const std::string& part) const {
    const std::vector<RunOutput>& outputs = folder.manifest().outputs;
    const auto found = std::find_if(outputs.begin(), outputs.end(), [&](const RunOutput& output) {
        return output.option == option && output.part == part;
    });
    return ResultFile::createSealed(folder.chunkPath(chunk, *found), folder.chunkLine(chunk, *found));
}

Outcome doChunks(ChunkedRun run, const DoChunk& doChunk, const MergePaths& paths, std::vector<std::string>& notes) {
    if (run.cut.chunks() > kMostChunks) {
        return badArgument("--chunk: this run would have " + std::to_string(run.cut.chunks()) +
                           " chunks, more than a folder should have files; give a larger number");
    }
    run.manifest.chunks = run.cut.chunks();
    OwnList own(run.options.shard);
    ChunkDealer& dealing = dealer != nullptr ? *dealer : own;
    std::optional<RunFolder> folder;
    if (dealing.leads()) {
        Result<RunFolder> opened = RunFolder::open(run.options.folder, run.manifest, run.options.shard);
        VOXTACT_TRY(opened);
        folder = std::move(*opened);
        dealing.begin(&*folder, run.cut);
    } else {
        dealing.begin(nullptr, run.cut);
        Result<RunFolder> joined = RunFolder::join(run.options.folder, run.manifest);
        VOXTACT_TRY(joined);
        folder = std::move(*joined);
    }
    Doing doing(run, *folder, doChunk, dealing);
    if (const Result<void> done = doing.all(); !done.ok()) {
        return withWhatIsThere(done.error(), *folder);
    }
    if (interrupted()) {
        return interruptOutcome(chunksText(folder->chunksThere()) + " in " + folderText(folder->path()) +
                                " are done, and the same command goes on from there");
    }
    addNotes(*folder, doing.tally(), notes);
    if (run.options.shard || !dealing.leads()) {
        return {};
    }
    VOXTACT_TRY(mergeRun(*folder, paths));
    return {};
}

} // namespace voxtact::app
