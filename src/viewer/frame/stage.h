// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/frame/beside_answers.h"
#include "viewer/frame/device_answers.h"
#include "viewer/frame/host_answers.h"
#include "viewer/frame/pictures.h"
#include "viewer/frame/slice_pass.h"
#include "viewer/model/files/progress.h"

namespace voxtact::view {

/// Inputs of a stage.
struct StageDesc {
    std::function<Lighting(const Grid&)> light; ///< of the fine picture
    std::function<void()> wake;                 ///< called from another thread when there is an answer
    Extent picture{16, 16};                     ///< pixels, for a start
    std::array<Extent, 3> slices{{{16, 16}, {16, 16}, {16, 16}}};
};

/// Objects of one volume and its meshes, on the device and on the host. Created on any thread while another stage is
/// shown; afterwards owned by the frames.
struct Stage {
    /// Uploads the volume of stages. LimitExceeded and OutOfMemory: it is too large for the device.
    [[nodiscard]] static Result<Volume> upload(const device::Session& session, const VolumeData& volume);
    /// Takes the volume of `state`. Waits for the device, and draws and answers once, so that everything is compiled.
    [[nodiscard]] static Result<std::unique_ptr<Stage>> create(const device::Session& session, const State& state,
                                                               Volume volume, const StageDesc& desc,
                                                               Progress& progress);

    // Destroyed in reverse order.
    std::unique_ptr<DeviceScene> scene;
    std::optional<DeviceAnswers> device;
    std::unique_ptr<BesideAnswers> beside;
    std::unique_ptr<HostAnswers> host;
    std::optional<Pictures> pictures;
    std::optional<SlicePass> slices;
};

} // namespace voxtact::view
