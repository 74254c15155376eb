// SPDX-License-Identifier: MIT
#pragma once

#include "cli/pairs/pair_run.h"
#include "core/batch/batch_pace.h"

/// Splits the pairs of the jobs into bounded windows, and selects those that an engine answers.
namespace voxtact::app {

/// Pairs per window: few compared with a device's pairs per second; 8 MB of matrices.
constexpr std::uint32_t kWindowPairs = 1U << 16U;

/// Some poses of a job. The object-space mesh at those that are `selected` comes near the volume; at the others nothing
/// can touch.
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

/// At most `count` pairs of jobs with one volume, in order: from pair `first` of the job `begin`, up to the job `end`.
/// `first` is 0 if the number of poses is unknown.
struct PairRange {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    std::uint64_t first = 0;
    std::uint64_t count = UINT64_MAX;
};

/// Goes through the pairs of a range.
class PairWindows {
  public:
    /// Both must outlive it.
    PairWindows(const PairOptions& options, PairInputs& inputs, const PairRange& range);

    /// The next window, without pairs when all are out.
    [[nodiscard]] Result<void> next(Window& window);

  private:
    PairInputs& inputs_;
    std::uint32_t job_;
    std::uint32_t end_;
    std::uint64_t first_;               ///< pose of the job with which it begins
    std::uint64_t left_;                ///< pairs
    std::optional<std::uint64_t> pose_; ///< the next one of the job; nothing: it has not begun
    BatchPace pace_;                    ///< of a source that may be slow
    Result<void> failure_;              ///< of the poses: told once those before it have been given
};

/// Selects of each item the poses at which the mesh's box comes near the volume: all poses where that does not follow
/// (--boundary clamp, and questions about more than a touch), and with --timing, which is about every pair. Adds to
/// near[job] how many come near.
[[nodiscard]] Result<void> selectPoses(const PairOptions& options, const PairInputs& inputs, const Grid& grid,
                                       Window& window, std::vector<std::uint64_t>& near);

} // namespace voxtact::app
