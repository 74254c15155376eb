// SPDX-License-Identifier: MIT
#pragma once

#include "device/session.h"
#include "gpu/memory.h"
#include "voxtact/scene.h"

#include <span>

namespace voxtact::lab {

/// Poses in mapped memory, as floats, where a command buffer reads them: what DetectorDesc::devicePoses asks for.
/// Thread-safety: none. The session must outlive it.
class MappedPoses {
  public:
    /// Room for so many, at least one.
    [[nodiscard]] static Result<MappedPoses> create(const device::Session& session, std::uint32_t count);

    /// The first of them, no more than there is room for. Nothing that reads them may be in flight.
    [[nodiscard]] Result<void> write(std::span<const Mat4> poses);
    [[nodiscard]] const PoseBuffer& poses() const noexcept { return poses_; }

  private:
    MappedPoses(ContextImpl& context, Buffer buffer, PoseBuffer poses) noexcept
        : context_(&context), buffer_(std::move(buffer)), poses_(std::move(poses)) {}

    ContextImpl* context_;
    Buffer buffer_;
    PoseBuffer poses_;
};

} // namespace voxtact::lab
