// SPDX-License-Identifier: MIT
#pragma once

#include "support/any_desc.h"
#include "support/take.h"
#include "voxtact/detector.h"
#include "vulkan/own/vulkan_device.h"

#include <gtest/gtest.h>

namespace voxtact::test {

inline constexpr ValueRange kBytes{0, 255};
inline constexpr ControlPoint kAllOpaque[] = {{0, 1}};

/// A device with validation and synchronization validation on, shared by the tests of one process.
struct TestDevice {
    device::VulkanInstance instance;
    device::VulkanDevice device;
    Context context;
    QueueAccess queue;
};

/// Makes the shared device, or says why there is none.
Result<TestDevice*> sharedDevice();

/// Every test that needs a device. Without one it is skipped, or fails where the tests run with --require-device. A
/// message of the validation layer fails the test during which it came.
class GpuTest : public testing::Test {
  protected:
    void SetUp() override;
    void TearDown() override;

    [[nodiscard]] TestDevice& gpu() const { return *device_; }
    [[nodiscard]] const Context& context() const { return device_->context; }
    [[nodiscard]] const QueueAccess& queue() const { return device_->queue; }

    Volume upload(const VolumeData& volume) const { return take(Volume::upload(context(), queue(), volume.view())); }
    Mesh upload(const MeshData& mesh) const { return take(Mesh::upload(context(), queue(), mesh.view())); }
    TransferFunction upload(std::span<const ControlPoint> points, const ValueRange& domain) const {
        return take(TransferFunction::upload(context(), queue(), {points, domain, kDefaultTableSize}));
    }
    [[nodiscard]] BlockingDetector detector(const AnyDesc& desc) const {
        return take(BlockingDetector::create(context(), desc, queue()));
    }
    /// One pair, by one method.
    [[nodiscard]] PairAnswer detectOne(const AnyDesc& desc, const BatchItem& item, const View& view,
                                       double threshold = 0.5) const;
    /// The survivors of one pair, which query and atomic must agree on.
    [[nodiscard]] std::uint64_t survivors(const Mesh& mesh, const Volume& volume, const TransferFunction& function,
                                          const View& view, double threshold = 0.5,
                                          const Mat4& world_from_object = identity()) const;

  private:
    TestDevice* device_ = nullptr;
    std::size_t messagesBefore_ = 0;
};

} // namespace voxtact::test
