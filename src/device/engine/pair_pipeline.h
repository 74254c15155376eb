// SPDX-License-Identifier: MIT
#pragma once

#include "core/batch/batch_pace.h"
#include "voxtact/detector.h"
#include "vulkan/own/vulkan_device.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

namespace voxtact::device {

/// The answer for one pair and the time of its submission divided by the pairs in it.
struct TimedAnswer {
    std::uint32_t item = 0; ///< number in the span given to run()
    std::uint32_t pose = 0; ///< number in that item's poses
    PairAnswer answer;
    std::optional<double> gpuMilliseconds; ///< nothing where the queue has no timestamps, or they are no time
    double wallMilliseconds = 0;           ///< from the start of recording to the results in host memory
};

struct PipelineDesc {
    std::uint32_t frames = 1; ///< submissions in flight; 1: submit and wait
    std::uint32_t pairsPerSubmission = 1;
    bool timestamps = false;
    OutputRoom room{}; ///< of a submission
};

/// Any number of pairs, a bounded number at a time: the next submission is recorded while others are on the device.
/// Thread-safety: none; one thread at a time.
class PairPipeline {
  public:
    /// What happens meanwhile. Only the first may not be empty.
    struct Events {
        std::function<void(const TimedAnswer&)> pair;
        /// After all pairs of a submission: the answers in addition to their counts, where there is room for them, and
        /// the counters of a detector that has them; `pair` counts from the first of these.
        std::function<void(const BatchAnswer&)> submission{};
        /// Asked before each submission: true, and no more are made.
        std::function<bool()> stop{};
        /// How many pairs a submission has, at most PipelineDesc::pairsPerSubmission. Null: as many as that.
        BatchPace* pace = nullptr;
    };

    /// The device, the context and the detector must outlive it.
    [[nodiscard]] static Result<PairPipeline> create(const VulkanDevice& device, const Context& context,
                                                     const Detector& detector, const PipelineDesc& desc);
    PairPipeline(PairPipeline&&) noexcept;
    PairPipeline& operator=(PairPipeline&&) noexcept;
    ~PairPipeline();

    /// All pairs of the batch, which may be larger than a submission. Waits for all; answers come in order.
    [[nodiscard]] Result<void> run(const Batch& batch, const Events& events);

    struct State;

  private:
    explicit PairPipeline(std::unique_ptr<State> state) noexcept;
    std::unique_ptr<State> state_;
};

} // namespace voxtact::device
