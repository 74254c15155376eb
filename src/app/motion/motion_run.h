// SPDX-License-Identifier: MIT
#pragma once

#include "app/chunks/chunk_options.h"
#include "app/motion/motion_engine.h"
#include "app/motion/motion_table.h"
#include "app/options/inputs.h"
#include "app/options/open_session.h"
#include "app/options/output_paths.h"
#include "app/output/progress.h"
#include "core/batch/batch_pace.h"

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// What the parts of `voxtact motion` share.
namespace voxtact::app {

struct MotionOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    std::filesystem::path poses;
    std::filesystem::path labels;
    std::filesystem::path labelNames;
    std::string interpolation = "screw";
    double resolution = kDefaultMotionResolution;
    std::string count = "cpu"; ///< "cpu" or "compute"
    std::optional<std::uint32_t> threads;
    DeviceChoice device;
    bool timing = false;
    bool progress = true;
    OutputOptions output;
    ChunkOptions chunks;
};

struct MotionInputs {
    std::vector<ControlPoint> points;
    std::vector<Mat4> poses; ///< none where they are read as they are needed
    std::optional<LabelData> labels;
    std::map<std::int32_t, std::string> labelNames;
};

/// Refuses fewer than two.
[[nodiscard]] Result<void> checkPoseCount(const MotionOptions& options, std::uint64_t poses);

/// Checks the segments of some meshes and volumes.
class SegmentChecker {
  public:
    /// All must outlive it.
    SegmentChecker(const MotionOptions& options, const MotionInputs& inputs, MotionEngine& engine)
        : options_(options), inputs_(inputs), engine_(engine) {}

    /// Reads a volume with its transfer function; what is checked from then on is about it.
    [[nodiscard]] Result<void> setVolume(std::uint32_t number);

    /// The rows of the segments between poses of which the first has the number `firstPose`, some at a time; fewer
    /// where an interrupt comes, which ends what is under way, too. Refuses poses between which there is no rigid
    /// motion before any row. Ends where `visit` fails.
    [[nodiscard]] Result<void> check(std::uint32_t mesh, std::span<const Mat4> poses, std::uint64_t firstPose,
                                     const std::function<Result<void>(std::span<const MotionRow>)>& visit);
    /// That it took so far.
    [[nodiscard]] double milliseconds() const noexcept { return milliseconds_; }

  private:
    /// More segments than are checked before their rows are written.
    static constexpr std::uint32_t kMostAtOnce = 256;

    /// Whether each segment is half a turn.
    [[nodiscard]] Result<std::vector<bool>> checkRigid(std::span<const Mat4> poses, std::uint64_t firstPose) const;

    const MotionOptions& options_;
    const MotionInputs& inputs_;
    MotionEngine& engine_;
    std::uint32_t volume_ = 0; ///< its number
    BatchPace pace_{kMostAtOnce, false};
    double milliseconds_ = 0;
};

/// How many segments ended with less than was asked for, and how many may not go the way that was meant.
struct MotionEnds {
    std::uint64_t grazing = 0;
    std::uint64_t cut = 0;
    std::uint64_t halfTurns = 0;
    std::uint32_t firstHalfTurn = 0; ///< its segment

    void add(std::span<const MotionRow> rows);
    void add(const MotionEnds& more);
    void addTo(std::vector<std::string>& notes) const;
};

/// Refuses what a run in chunks cannot have.
[[nodiscard]] Result<void> checkMotionChunks(const MotionOptions& options);
/// The run in chunks. `reads`: all files that the options name.
[[nodiscard]] Outcome runMotionChunks(const CLI::App& parser, const MotionOptions& options, const MotionInputs& inputs,
                                      MotionEngine& engine, const std::vector<NamedPath>& reads);

} // namespace voxtact::app
