// SPDX-License-Identifier: MIT
#pragma once

#include "edits.h"
#include "motions.h"
#include "plans.h"
#include "process.h"
#include "request.h"
#include "voxtact/cpu.h"

#include <map>
#include <memory>

namespace voxtact::python {

/// Of a scene without a device.
[[noreturn]] void refuseWithoutDevice(CountingMethod method);

/// A part of a request.
struct Part {
    const Request& request;
    std::size_t first = 0;
    std::size_t count = 0;
};

/// A scene on the host engine. One call at a time.
class HostSide {
  public:
    HostSide(const VolumeView& volume, const OpacityDesc& opacity, std::uint32_t threads);

    void setOpacity(const OpacityDesc& opacity);
    void edit(const Edit& edit);
    /// As they are after all edits; `given` is what the side was made from.
    [[nodiscard]] std::vector<std::byte> voxels(const VolumeView& given) const;
    [[nodiscard]] BatchAnswer detect(const Part& part, const Question& question, double threshold,
                                     const LabelData* labels);
    [[nodiscard]] ClearanceAnswer measure(const Part& part, const Distance& distance, double threshold);
    [[nodiscard]] LabelClearanceAnswer measureLabels(const Part& part, const Distance& distance, double threshold,
                                                     const LabelData* labels, const std::vector<std::int32_t>& asked);
    [[nodiscard]] AreaAnswer measure(const Part& part, const Extent& extent, double threshold);
    [[nodiscard]] TriangleAreaAnswer measureTriangles(const Part& part, const Extent& extent, double threshold);
    [[nodiscard]] LabelAreaAnswer measureLabels(const Part& part, const Extent& extent, double threshold,
                                                const LabelData* labels, const std::vector<std::int32_t>& asked);
    [[nodiscard]] BatchAnswer within(const Part& part, double margin, double threshold);
    /// `part` counts segments.
    [[nodiscard]] MotionAnswer move(const Part& part, const Way& way, double threshold);
    [[nodiscard]] BatchAnswer around(const Part& part, const PoseTolerance& tolerance, double threshold);
    [[nodiscard]] TrackedClearance track(cpu::ClearanceTracker& tracker, const Shape& mesh,
                                         const Mat4& world_from_object, double threshold) const;
    /// `labels` may be null where the wish is not about labels.
    [[nodiscard]] PlanAnswer plan(const PlanWish& wish, double threshold, const LabelData* labels);
    /// That a call runs on.
    [[nodiscard]] std::uint32_t threads() const noexcept { return threads_; }

  private:
    [[nodiscard]] cpu::Detector& detectorFor(const Question& question, std::uint32_t threads);
    [[nodiscard]] cpu::ClearanceMeter& meterFor(const Distance& distance);
    [[nodiscard]] cpu::AreaMeter& meterFor(const Extent& extent);
    [[nodiscard]] cpu::MotionChecker& checkerFor(const Way& way);
    [[nodiscard]] std::vector<cpu::BatchItem> itemsOf(const Part& part, const LabelData* labels) const;
    /// Whether it takes no longer than waking others does.
    [[nodiscard]] static bool isLittle(const Part& part, const Question& question) noexcept;

    cpu::Volume volume_;
    cpu::TransferFunction function_;
    std::uint32_t threads_; ///< known once: asking the system takes longer than an answer
    // They have threads.
    std::map<std::pair<Question::Key, std::uint32_t>, OfThisProcess<cpu::Detector>> detectors_;
    std::map<Distance::Key, OfThisProcess<cpu::ClearanceMeter>> meters_;
    std::map<Extent::Key, OfThisProcess<cpu::AreaMeter>> areaMeters_;
    std::map<Way::Key, OfThisProcess<cpu::MotionChecker>> checkers_;
};

} // namespace voxtact::python
