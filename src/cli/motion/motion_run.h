// SPDX-License-Identifier: MIT
#pragma once

#include "cli/motion/motion_engine.h"
#include "cli/motion/motion_table.h"
#include "cli/options/inputs.h"
#include "cli/options/output_paths.h"
#include "cli/options/shard.h"
#include "cli/output/progress.h"
#include "core/batch/batch_pace.h"

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// Common parts of `voxtact motion`.
namespace voxtact::app {

struct MotionOptions {
    std::vector<std::string> volumes;
    MeshOptions meshes;
    TransferFunctionOptions transferFunction;
    ViewOptions view; ///< its poses
    LabelOptions labels;
    std::string interpolation = "screw";
    double resolution = kDefaultMotionResolution;
    std::uint32_t threads = 0; ///< 0: one per processor
    bool summary = false;
    bool timing = false;
    bool progress = true;
    bool resample = false;
    OutputOptions output;
    Shard shard;
};

struct MotionInputs {
    std::vector<Box> bounds;       ///< of the meshes, object space
    std::vector<char> isResampled; ///< of each volume, once it has been read
    std::vector<ControlPoint> points;
    std::vector<Mat4> poses;
    std::optional<LabelData> labels;
    std::map<std::int32_t, std::string> labelNames;
};

/// Checks the segments of all meshes and volumes.
class SegmentChecker {
  public:
    /// All arguments must outlive the checker.
    SegmentChecker(const MotionOptions& options, MotionInputs& inputs, MotionEngine& engine)
        : options_(options), inputs_(inputs), engine_(engine) {}

    /// Reads a volume with its transfer function, for the following queries.
    [[nodiscard]] Result<void> setVolume(std::uint32_t number);

    /// Visits the rows of the segments between poses, in batches; `firstPose` is the index of the first pose. An
    /// interrupt ends it early, also during a segment. Refuses poses without a rigid motion between them before any
    /// row. Ends if `visit` fails.
    [[nodiscard]] Result<void> check(std::uint32_t mesh, std::span<const Mat4> poses, std::uint64_t firstPose,
                                     const std::function<Result<void>(std::span<const MotionRow>)>& visit);
    /// Returns the duration so far.
    [[nodiscard]] double milliseconds() const noexcept { return milliseconds_; }
    /// Returns notes on meshes that no pose brings near a volume.
    [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

  private:
    /// Maximum segments checked before their rows are written.
    static constexpr std::uint32_t kMaxAtOnce = 256;

    /// Returns for each segment whether it is half a turn.
    [[nodiscard]] Result<std::vector<bool>> checkRigid(std::span<const Mat4> poses, std::uint64_t firstPose) const;
    void noteFar(std::uint32_t mesh, std::span<const Mat4> poses);

    const MotionOptions& options_;
    MotionInputs& inputs_;
    MotionEngine& engine_;
    std::uint32_t volume_ = 0; ///< its index
    Grid grid_;                ///< of the volume
    std::vector<std::string> notes_;
    BatchPace pace_{kMaxAtOnce, false};
    double milliseconds_ = 0;
};

/// Counts answers, segments that are not decided to the resolution, and half turns.
struct MotionEnds {
    std::uint64_t segments = 0;
    std::uint64_t touches = 0;
    std::uint64_t undecided = 0;
    std::uint64_t firstTouch = 0; ///< the first segment that touches
    std::uint64_t grazing = 0;
    std::uint64_t cut = 0;
    std::uint64_t halfTurns = 0;
    std::uint32_t firstHalfTurn = 0; ///< its segment

    void add(std::span<const MotionRow> rows);
    void addTo(std::vector<std::string>& notes) const;
    /// Returns the line of --summary.
    [[nodiscard]] std::string summary() const;
};

} // namespace voxtact::app
