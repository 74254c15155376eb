// SPDX-License-Identifier: MIT
#pragma once

#include "device/session.h"
#include "voxtact/data.h"
#include "voxtact/motion.h"

#include <memory>
#include <span>
#include <vector>

namespace voxtact::app {

/// What checks motions of some meshes: the host, or a device.
class MotionEngine {
  public:
    MotionEngine() = default;
    MotionEngine(const MotionEngine&) = delete;
    MotionEngine& operator=(const MotionEngine&) = delete;
    virtual ~MotionEngine() = default;

    /// The one before ends first: two may be too much.
    virtual void dropVolume() noexcept = 0;
    /// What meshes are put to from now on. Nothing of either need outlive the call.
    [[nodiscard]] virtual Result<void> setVolume(const VolumeView& volume, const TransferFunctionDesc& function) = 0;
    /// The segments between the poses of a mesh, by its number. Cancelled after an interrupt.
    [[nodiscard]] virtual Result<MotionAnswer> check(std::uint32_t mesh, std::span<const Mat4> poses,
                                                     double threshold) = 0;
};

/// `threads`: as in cpu::MotionDesc.
[[nodiscard]] Result<std::unique_ptr<MotionEngine>> hostMotionEngine(const MotionSearch& search, std::uint32_t threads,
                                                                     std::span<const MeshData> meshes);
/// The session must outlive it.
[[nodiscard]] Result<std::unique_ptr<MotionEngine>>
deviceMotionEngine(const MotionSearch& search, const device::Session& session, std::span<const MeshData> meshes);

} // namespace voxtact::app
