// SPDX-License-Identifier: MIT
#include "app/chunks/run_chunks.h"
#include "app/detect/pose_source.h"
#include "app/motion/motion_run.h"
#include "app/output/interrupt.h"
#include "app/output/standard_streams.h"
#include "core/base/try.h"

#include <algorithm>

namespace voxtact::app {

namespace {

/// So many segments are checked, and their rows written, before the next poses are read.
constexpr std::uint64_t kMostAtOnce = 4096;

/// Some neighbours of the poses; what the next ones have in common with the last is not read again.
class PoseWindow {
  public:
    explicit PoseWindow(PoseSource& source) : source_(source) {}

    /// `count` poses from number `first` on.
    [[nodiscard]] Result<std::span<const Mat4>> get(std::uint64_t first, std::uint64_t count) {
        const bool overlaps = first >= first_ && first < first_ + poses_.size();
        poses_.erase(poses_.begin(),
                     overlaps ? poses_.begin() + static_cast<std::ptrdiff_t>(first - first_) : poses_.end());
        first_ = first;
        if (poses_.size() < count) {
            VOXTACT_TRY(source_.begin(first + poses_.size()));
            std::vector<Mat4> more;
            VOXTACT_TRY(source_.next(count - poses_.size(), more));
            poses_.insert(poses_.end(), more.begin(), more.end());
        }
        return std::span<const Mat4>(poses_).first(count);
    }

  private:
    PoseSource& source_;
    std::vector<Mat4> poses_;
    std::uint64_t first_ = 0;
};

/// The run's rows: by volume, mesh, segment.
class MotionChunks {
  public:
    MotionChunks(const MotionOptions& options, const MotionInputs& inputs, MotionEngine& engine, PoseSource& source)
        : options_(options), inputs_(inputs), checking_(options, inputs, engine), poses_(source),
          segments_(*source.count() - 1) {}

    [[nodiscard]] ChunkCut cut() const {
        return {std::vector<std::uint64_t>(options_.volumes.size(), segments_ * options_.meshes.sources.size()),
                options_.chunks.chunk()};
    }
    [[nodiscard]] RunOutput output() const { return tableOutput(options_.output.format(), tableOf({}).table()); }
    [[nodiscard]] Result<void> write(const ChunkRange& range, const ChunkFiles& files,
                                     const std::function<void(std::uint64_t)>& progress) {
        if (volumeNumber_ != range.group) {
            volumeNumber_.reset();
            VOXTACT_TRY(checking_.setVolume(range.group));
            volumeNumber_ = range.group;
        }
        Result<ResultFile> file = files.create("--output");
        VOXTACT_TRY(file);
        io::TableWriter writer(file->stream(), options_.output.format());
        writer.omitHead();
        MotionEnds ends;
        for (std::uint64_t done = 0; done < range.count && !interrupted();) {
            const Result<std::uint64_t> some = writeSome(range.first + done, range.count - done, writer, ends);
            VOXTACT_TRY(some);
            done += *some;
            progress(done);
        }
        if (interrupted()) {
            return {};
        }
        VOXTACT_TRY(file->close());
        ends_.add(ends);
        return file->commit();
    }
    [[nodiscard]] const MotionEnds& ends() const noexcept { return ends_; }

  private:
    [[nodiscard]] MotionTable tableOf(std::span<const MotionRow> rows) const {
        return {options_.meshes.sources, options_.volumes, inputs_.labels, inputs_.labelNames, rows};
    }
    /// Of one mesh. How many rows.
    [[nodiscard]] Result<std::uint64_t> writeSome(std::uint64_t row, std::uint64_t most, io::TableWriter& writer,
                                                  MotionEnds& ends) {
        const std::uint64_t segment = row % segments_;
        const std::uint64_t count = std::min({most, segments_ - segment, kMostAtOnce});
        const Result<std::span<const Mat4>> poses = poses_.get(segment, count + 1);
        VOXTACT_TRY(poses);
        rows_.clear();
        VOXTACT_TRY(checking_.check(static_cast<std::uint32_t>(row / segments_), *poses, segment,
                                    [&](std::span<const MotionRow> rows) -> Result<void> {
                                        rows_.insert(rows_.end(), rows.begin(), rows.end());
                                        return {};
                                    }));
        ends.add(rows_);
        writer.add(tableOf(rows_).table());
        return count;
    }

    const MotionOptions& options_;
    const MotionInputs& inputs_;
    SegmentChecker checking_;
    PoseWindow poses_;
    std::uint64_t segments_; ///< of a mesh
    std::vector<MotionRow> rows_;
    std::optional<std::uint32_t> volumeNumber_;
    MotionEnds ends_;
};

} // namespace

Result<void> checkMotionChunks(const MotionOptions& options) {
    return checkChunkOptions(
        options.chunks, options.output,
        {{options.poses == "-", "--poses -", "who goes on with the run reads the poses again; put them into a file"},
         {options.timing, "--timing", "its chunks are done at different times, perhaps by different machines"},
         {options.device.validate, "--validate", "its messages decide on a whole run; validate a short one without"}});
}

Outcome runMotionChunks(const CLI::App& parser, const MotionOptions& options, const MotionInputs& inputs,
                        MotionEngine& engine, const std::vector<NamedPath>& reads) {
    Result<PoseSource> source = PoseSource::open(options.poses, true);
    VOXTACT_TRY(source);
    VOXTACT_TRY(checkPoseCount(options, source->count().value_or(0)));
    RunFacts facts = runFacts(parser, options.chunks, options.output);
    VOXTACT_TRY(addInputFacts(facts, reads));
    MotionChunks chunks(options, inputs, engine, *source);
    ChunkedRun run{
        "voxtact motion", options.chunks, {std::move(facts), {chunks.output()}, 0}, chunks.cut(), options.progress};
    std::vector<std::string> notes;
    Outcome outcome = doChunks(
        std::move(run),
        [&](const ChunkRange& range, const ChunkFiles& files, const std::function<void(std::uint64_t)>& progress) {
            return chunks.write(range, files, progress);
        },
        {{"--output", options.output.path}}, notes);
    chunks.ends().addTo(notes);
    for (const std::string& note : notes) {
        if (outcome.status == kExitDone) {
            printNote(note);
        }
    }
    return outcome;
}

} // namespace voxtact::app
