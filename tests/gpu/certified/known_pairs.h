// SPDX-License-Identifier: MIT
#pragma once

#include "certified/one_voxel.h"
#include "cpu/scenes/margin_cases.h"
#include "raw_vulkan.h"
#include "support/take.h"
#include "voxtact/detector.h"

#include <limits>
#include <span>
#include <vector>

namespace voxtact::test {

/// It refers to what it is given.
inline oracle::OraclePair pairOf(const KnownPlane& known) {
    return {known.mesh.view(), known.volume.view(), {known.points, known.domain, kDefaultTableSize}, {},
            identity(),        known.threshold};
}
inline oracle::OraclePair pairOf(const OneVoxel& one, const MeshData& mesh) {
    return {mesh.view(), one.image.view(), {one.points, {0, 255}, kDefaultTableSize}, {}, identity(), 0.5};
}

/// Poses on the device, which has them in single precision: so are `poses` afterwards.
class PosesOnDevice {
  public:
    PosesOnDevice(RawVulkan& raw, const Context& context, std::span<Mat4> poses)
        : memory_(raw.makeBuffer(std::span<const float>(rounded(poses)), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT)),
          buffer_(take(PoseBuffer::wrap(
              context, {.buffer = memory_.buffer, .stride = 64, .count = static_cast<std::uint32_t>(poses.size())}))) {}
    /// Makes one of them no pose.
    void spoil(std::size_t pose) {
        static_cast<float*>(memory_.mapped)[16 * pose] = std::numeric_limits<float>::quiet_NaN();
    }
    [[nodiscard]] const PoseBuffer& buffer() const { return buffer_; }

  private:
    static std::vector<float> rounded(std::span<Mat4> poses) {
        std::vector<float> floats;
        for (Mat4& pose : poses) {
            for (double& element : pose) {
                floats.push_back(static_cast<float>(element));
                element = static_cast<double>(floats.back());
            }
        }
        return floats;
    }

    RawVulkan::HostBuffer memory_;
    PoseBuffer buffer_;
};

} // namespace voxtact::test
