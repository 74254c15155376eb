// SPDX-License-Identifier: MIT
#include "lab/engines/mapped_poses.h"

#include "core/base/try.h"
#include "gpu/context_impl.h"

#include <algorithm>
#include <array>

namespace voxtact::lab {

Result<MappedPoses> MappedPoses::create(const device::Session& session, std::uint32_t count) {
    ContextImpl& context = session.context.impl();
    Result<Buffer> buffer = makeBuffer(context, count * sizeof(std::array<float, 16>),
                                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, MemoryUse::Upload, "mapped poses");
    VOXTACT_TRY(buffer);
    Result<PoseBuffer> poses = PoseBuffer::wrap(session.context, {.buffer = buffer->get(), .count = count});
    VOXTACT_TRY(poses);
    return MappedPoses(context, std::move(*buffer), std::move(*poses));
}

Result<void> MappedPoses::write(std::span<const Mat4> poses) {
    auto* at = static_cast<float*>(buffer_.mapped);
    for (const Mat4& pose : poses) {
        at = std::ranges::transform(pose, at, [](double element) { return static_cast<float>(element); }).out;
    }
    return flush(*context_, buffer_);
}

} // namespace voxtact::lab
