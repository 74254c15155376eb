// SPDX-License-Identifier: MIT
#include "app/motion/motion_engine.h"
#include "app/output/interrupt.h"
#include "core/base/try.h"
#include "voxtact/cpu.h"
#include "voxtact/detector.h"

#include <optional>

namespace voxtact::app {

namespace {

class HostMotions final : public MotionEngine {
  public:
    HostMotions(cpu::MotionChecker checker, std::vector<cpu::Mesh> meshes)
        : checker_(std::move(checker)), meshes_(std::move(meshes)) {}

    void dropVolume() noexcept override { scene_.reset(); }
    Result<void> setVolume(const VolumeView& volume, const TransferFunctionDesc& function) override {
        Result<cpu::Volume> made = cpu::Volume::create(volume);
        VOXTACT_TRY(made);
        Result<cpu::TransferFunction> table = cpu::TransferFunction::create(function);
        VOXTACT_TRY(table);
        scene_.emplace(std::move(*made), std::move(*table));
        return {};
    }
    Result<MotionAnswer> check(std::uint32_t mesh, std::span<const Mat4> poses, double threshold) override {
        const cpu::BatchItem item{&meshes_[mesh], &scene_->first, &scene_->second, poses};
        return checker_.check({.items = std::span(&item, 1), .threshold = threshold, .cancel = &interruptFlag()});
    }

  private:
    cpu::MotionChecker checker_;
    std::vector<cpu::Mesh> meshes_;
    std::optional<std::pair<cpu::Volume, cpu::TransferFunction>> scene_;
};

class DeviceMotions final : public MotionEngine {
  public:
    DeviceMotions(const device::Session& session, BlockingDetector detector, std::vector<Mesh> meshes)
        : session_(session), detector_(std::move(detector)), meshes_(std::move(meshes)) {}

    void dropVolume() noexcept override { scene_.reset(); }
    Result<void> setVolume(const VolumeView& volume, const TransferFunctionDesc& function) override {
        const QueueAccess queue = session_.device.queueAccess();
        Result<Volume> made = Volume::upload(session_.context, queue, volume, {.bricks = true});
        VOXTACT_TRY(made);
        Result<TransferFunction> table = TransferFunction::upload(session_.context, queue, function);
        VOXTACT_TRY(table);
        scene_.emplace(std::move(*made), std::move(*table));
        return {};
    }
    Result<MotionAnswer> check(std::uint32_t mesh, std::span<const Mat4> poses, double threshold) override {
        const BatchItem item{&meshes_[mesh], &scene_->first, &scene_->second, poses};
        Result<BatchAnswer> answer = detector_.detect({.items = std::span(&item, 1), .threshold = threshold});
        VOXTACT_TRY(answer);
        return MotionAnswer{std::move(answer->motions), answer->wallMilliseconds};
    }

  private:
    const device::Session& session_;
    BlockingDetector detector_;
    std::vector<Mesh> meshes_;
    std::optional<std::pair<Volume, TransferFunction>> scene_;
};

} // namespace

Result<std::unique_ptr<MotionEngine>> hostMotionEngine(const MotionSearch& search, std::uint32_t threads,
                                                       std::span<const MeshData> meshes) {
    Result<cpu::MotionChecker> checker = cpu::MotionChecker::create(
        {.threads = threads, .interpolation = search.interpolation, .resolution = search.resolution});
    VOXTACT_TRY(checker);
    std::vector<cpu::Mesh> made;
    for (const MeshData& data : meshes) {
        Result<cpu::Mesh> mesh = cpu::Mesh::create(data.view());
        VOXTACT_TRY(mesh);
        made.push_back(std::move(*mesh));
    }
    return std::unique_ptr<MotionEngine>(std::make_unique<HostMotions>(std::move(*checker), std::move(made)));
}

Result<std::unique_ptr<MotionEngine>> deviceMotionEngine(const MotionSearch& search, const device::Session& session,
                                                         std::span<const MeshData> meshes) {
    const QueueAccess queue = session.device.queueAccess();
    Result<BlockingDetector> detector = BlockingDetector::create(session.context,
                                                                 {.method = CountingMethod::Compute,
                                                                  .projection = Projection::Conservative,
                                                                  .stopAtFirst = true,
                                                                  .motion = search},
                                                                 queue);
    VOXTACT_TRY(detector);
    std::vector<Mesh> made;
    for (const MeshData& data : meshes) {
        Result<Mesh> mesh = Mesh::upload(session.context, queue, data.view(), {.clusters = true});
        VOXTACT_TRY(mesh);
        made.push_back(std::move(*mesh));
    }
    return std::unique_ptr<MotionEngine>(
        std::make_unique<DeviceMotions>(session, std::move(*detector), std::move(made)));
}

} // namespace voxtact::app
