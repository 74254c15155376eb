// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/cpu.h"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace voxtact::app {

/// Checks motions of some meshes, on the host.
class MotionEngine {
  public:
    /// `threads`: 0: one per processor.
    [[nodiscard]] static Result<MotionEngine> create(const Motion& question, std::uint32_t threads,
                                                     std::span<const MeshData> meshes);

    /// Frees the previous volume first: memory may not suffice for two.
    void dropVolume() noexcept { scene_.reset(); }
    /// Sets the volume for the following queries. The arguments need not outlive the call.
    [[nodiscard]] Result<void> setVolume(const VolumeView& volume, const TransferFunctionDesc& function);
    /// Checks the segments between the poses of a mesh, by its index. Cancelled after an interrupt.
    [[nodiscard]] Result<MotionAnswer> check(std::uint32_t mesh, std::span<const Mat4> poses, double threshold);

  private:
    MotionEngine(const Motion& question, cpu::HostEngine engine, std::vector<cpu::Mesh> meshes)
        : question_(question), engine_(std::move(engine)), meshes_(std::move(meshes)) {}

    Motion question_;
    cpu::HostEngine engine_;
    std::vector<cpu::Mesh> meshes_;
    std::optional<std::pair<cpu::Volume, cpu::TransferFunction>> scene_;
};

} // namespace voxtact::app
