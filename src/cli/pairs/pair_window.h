// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_run.h"
#include "core/batch/batch_pace.h"

/// Splits the pairs of the jobs into bounded windows, and selects those that an engine answers.
namespace voxtact::app {

/// Pairs per window: a device answers them in a short time; 8 MB of matrices.
constexpr std::uint32_t kWindowPairs = 1U << 16U;

/// Poses of a job. At `selected` poses the mesh comes near the volume; at the others it cannot touch.
struct WindowItem {
    std::uint32_t job = 0;
    std::uint64_t firstPose = 0;
    std::vector<Mat4> poses;
    std::vector<Mat4> selected;
    std::vector<std::uint32_t> numbers; ///< of the selected ones, in `poses`
};

struct Window {
    std::vector<WindowItem> items;
    std::size_t pairs = 0; ///< of all items, selected or not
};

/// At most `count` consecutive pairs of jobs with one volume, from pair `first` of job `begin` to job `end`. `first` is
/// 0 if the number of poses is unknown.
struct PairRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint64_t first = 0;
    std::uint64_t count = UINT64_MAX;
};

/// Iterates over the pairs of a range.
class PairWindows {
  public:
    /// Both arguments must outlive the object.
    PairWindows(const PairOptions& options, PairInputs& inputs, const PairRange& range);

    /// Returns the next window; without pairs at the end.
    [[nodiscard]] Result<void> next(Window& window);

  private:
    PairInputs& inputs_;
    std::uint32_t job_;
    std::uint32_t end_;
    std::uint64_t first_;               ///< first pose of the first job
    std::uint64_t left_;                ///< remaining pairs
    std::optional<std::uint64_t> pose_; ///< next pose of the job; empty: not begun
    BatchPace pace_;                    ///< for slow pose sources
    Result<void> failure_;              ///< error of the pose source, returned after all earlier poses
};

/// Selects the poses of each item that bring the mesh's box near the volume. Selects all poses if a far mesh may count
/// (--boundary clamp, measuring questions), and with --timing. Adds the number of near poses to near[job].
[[nodiscard]] Result<void> selectPoses(const PairOptions& options, const PairInputs& inputs, const Grid& grid,
                                       Window& window, std::vector<std::uint64_t>& near);

} // namespace voxtact::app
