// SPDX-License-Identifier: MIT
#pragma once

#include "view/frame/device_scene.h"
#include "voxtact/detector.h"

#include <map>

namespace voxtact::view {

/// Answers of the device: recorded into a frame, and read when the frame is done.
class DeviceAnswers {
  public:
    [[nodiscard]] static Result<DeviceAnswers> create(const device::Session& session, const DeviceScene& scene);
    /// The ways to answer of this device, and of the host.
    [[nodiscard]] static std::vector<MethodChoice> choices(const Context& context);

    /// Into a frame whose slot's last use is done.
    [[nodiscard]] Result<void> record(VkCommandBuffer commands, DeviceScene& scene, const State& state,
                                      std::uint32_t slot);
    /// Of a slot's frame, which is done; nothing where it asked nothing.
    [[nodiscard]] std::optional<Result<LiveAnswer>> collect(std::uint32_t slot, double wallMilliseconds);

  private:
    struct Asked {
        std::uint64_t revision = 0;
        std::vector<Instrument> instruments;
    };
    explicit DeviceAnswers(const device::Session& session) : session_(&session) {}

    const device::Session* session_;
    std::map<std::pair<CountingMethod, Projection>, Detector> detectors_;
    std::vector<Results> results_;
    std::array<std::optional<Asked>, kFramesInFlight> asked_;
};

} // namespace voxtact::view
