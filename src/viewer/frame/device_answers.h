// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/frame/device_scene.h"
#include "voxtact/detector.h"

#include <map>
#include <mutex>

namespace voxtact::view {

/// The device's detectors, each created at first use, at a stable address. Thread-safety: all functions are safe from
/// any thread.
class Detectors {
  public:
    Detectors(const Context& context, bool labels) : context_(&context), labels_(labels) {}

    /// Returns null if it does not exist yet.
    [[nodiscard]] const Detector* find(const MethodChoice& method) const;
    /// Creates it if needed, which may be slow.
    [[nodiscard]] Result<const Detector*> get(const MethodChoice& method);

  private:
    using Key = std::pair<CountingMethod, Projection>;
    const Context* context_;
    bool labels_; ///< whether they count labels
    mutable std::mutex mutex_;
    std::map<Key, Detector> detectors_;
};

/// Answers of the device: recorded into a frame, and read when the frame is done.
class DeviceAnswers {
  public:
    DeviceAnswers(const device::Session& session, const DeviceScene& scene, std::shared_ptr<Detectors> detectors);
    /// Returns the methods of this device and of the host.
    [[nodiscard]] static std::vector<MethodChoice> choices(const Context& context);

    /// True if record() finds a detector for it.
    [[nodiscard]] bool ready(const MethodChoice& method) const { return detectors_->find(method) != nullptr; }
    /// Records into a frame whose slot's last use is complete. Requires DeviceScene::recording().
    [[nodiscard]] Result<void> record(VkCommandBuffer commands, const DeviceScene& scene, const LiveQuestion& question,
                                      std::uint32_t slot);
    /// Returns the answer of a slot's completed frame; empty without a question.
    [[nodiscard]] std::optional<Result<LiveAnswer>> collect(std::uint32_t slot, double wallMilliseconds);

  private:
    struct Asked {
        std::uint64_t revision = 0;
        std::vector<Instrument> instruments;
        bool certified = false;
    };

    std::shared_ptr<Detectors> detectors_;
    ResultsDesc desc_;
    /// Of detectors that are not certified, and of certified ones; each made when it is first needed.
    std::array<std::array<std::optional<Results>, kFramesInFlight>, 2> results_;
    std::array<std::optional<Asked>, kFramesInFlight> asked_;
};

} // namespace voxtact::view
