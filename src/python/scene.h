// SPDX-License-Identifier: MIT
#pragma once

#include "answer.h"
#include "device_side.h"
#include "host_side.h"
#include "turn.h"

#include <memory>
#include <optional>

namespace voxtact::python {

/// What a scene is made of.
struct SceneDesc {
    std::shared_ptr<const Image> volume;
    OpacityDesc opacity;
    double threshold = kDefaultThreshold;
    std::shared_ptr<const LabelData> labels; ///< may be null
    std::shared_ptr<Device> device;          ///< null: the host engine
    std::uint32_t threads = 0;
};

/// A volume, what of it is opaque, and engines to ask. The side that was made first answers; the other one is made when
/// something needs it: pictures a device, clearances and edits the host, which has the edited voxels. Threads wait for
/// each other.
class Scene {
  public:
    explicit Scene(SceneDesc desc);

    /// It changes with the interpreter's lock held, by whoever's turn it is.
    [[nodiscard]] const SceneDesc& desc() const noexcept { return desc_; }
    /// Another after every change.
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

    // The interpreter's lock must not be held for any of these.
    void setOpacity(OpacityDesc opacity);
    void setThreshold(double threshold);
    void edit(const Edit& edit);
    [[nodiscard]] std::shared_ptr<Answer> detect(std::shared_ptr<const Request> request, const Question& question,
                                                 const Progress& progress);
    /// The same request with other outputs; nothing where the scene has changed since.
    [[nodiscard]] std::shared_ptr<Answer> again(const Answer& answer, const Outputs& outputs);
    /// Seconds that the engine alone takes for the whole request, in one call on the host, so many times: what the
    /// bench compares detect() with.
    [[nodiscard]] std::vector<double> engineSeconds(const Request& request, const Question& question,
                                                    std::uint32_t times);
    [[nodiscard]] std::shared_ptr<Clearances> clearance(std::shared_ptr<const Request> request,
                                                        const Distance& distance, const Progress& progress);
    /// By the device of a scene that has one.
    [[nodiscard]] std::shared_ptr<Clearances> clearanceByDevice(std::shared_ptr<const Request> request,
                                                                const ClearanceSearch& search,
                                                                std::optional<std::vector<std::int32_t>> labels,
                                                                bool labelsAtAnyOpacity, const Progress& progress);
    [[nodiscard]] std::shared_ptr<Clearances> labelClearance(std::shared_ptr<const Request> request,
                                                             const Distance& distance, std::vector<std::int32_t> labels,
                                                             const Progress& progress);
    /// `labels`: in each of these; `byTriangle`: and what each triangle has of it, without labels.
    [[nodiscard]] std::shared_ptr<Areas> area(std::shared_ptr<const Request> request, const Extent& extent,
                                              std::optional<std::vector<std::int32_t>> labels, bool byTriangle,
                                              const Progress& progress);
    /// By the host, or by the device of a scene that has one.
    [[nodiscard]] std::shared_ptr<Answer> within(const std::shared_ptr<const Request>& request, double margin,
                                                 bool byDevice, const Progress& progress);
    /// Of a request that checkWays() accepts; `progress` counts segments.
    [[nodiscard]] std::shared_ptr<Motions> motionByDevice(std::shared_ptr<const Request> request,
                                                          const MotionSearch& search, const Progress& progress);
    [[nodiscard]] std::shared_ptr<Motions> motion(std::shared_ptr<const Request> request, const Way& way,
                                                  const Progress& progress);
    /// By the host, or by the device of a scene that has one.
    [[nodiscard]] std::shared_ptr<Answer> around(const std::shared_ptr<const Request>& request,
                                                 const PoseTolerance& tolerance, bool byDevice,
                                                 const Progress& progress);
    /// Of a pose that need not be affine: that is looked at.
    [[nodiscard]] TrackedClearance track(cpu::ClearanceTracker& tracker, const Shape& mesh,
                                         const Mat4& world_from_object);
    /// One that is about labels needs a label map.
    [[nodiscard]] std::shared_ptr<Plan> plan(const PlanWish& wish);
    /// `device` is for a scene that has none.
    [[nodiscard]] Picture picture(const PictureWish& wish, const std::shared_ptr<Device>& device);
    void close();

  private:
    void checkOpen() const;
    [[nodiscard]] HostSide& host();
    [[nodiscard]] DeviceSide& onDevice(const std::shared_ptr<Device>& device);
    /// A yes or no of each pair, of the host's `ask(side, part)`.
    template <class Ask>
    [[nodiscard]] std::shared_ptr<Answer> yesOrNo(const std::shared_ptr<const Request>& request, std::size_t cost,
                                                  const Progress& progress, const Ask& ask);
    [[nodiscard]] std::shared_ptr<Answer> answered(std::shared_ptr<const Request> request, const Question& question,
                                                   const Progress& progress);

    SceneDesc desc_;
    bool open_ = true;
    std::atomic<std::uint64_t> revision_ = 0;
    bool edited_ = false; ///< the volume is the host's, not the one that was given
    Turns turns_;
    std::unique_ptr<HostSide> host_;
    OfThisProcess<DeviceSide> onDevice_;
};

void defineScene(py::module_& module);

} // namespace voxtact::python
