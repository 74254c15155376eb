// SPDX-License-Identifier: MIT
// Some of the scenarios on a real driver, below a validation layer that sees what the pretended one does not.
#include "gpu/gpu_fixture.h"
#include "scenarios.h"
#include "sweep.h"
#include "voxtact/render.h"

#include <cstdlib>
#include <optional>

namespace voxtact::test {
namespace {

/// A device may be lost once in the life of a context.
constexpr VkResult kSurvived[] = {VK_ERROR_OUT_OF_HOST_MEMORY, VK_ERROR_OUT_OF_DEVICE_MEMORY,
                                  VK_ERROR_INITIALIZATION_FAILED};

class RealSweep : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        const device::VulkanDevice& device = gpu().device;
        table_.emplace(gpu().instance.getInstanceProcAddr(),
                       [&device] { device.table().vkDeviceWaitIdle(device.handle()); });
        below_.load(gpu().instance.getInstanceProcAddr(), gpu().instance.handle(), device.handle(), false);
        stage_.emplace(Stage{*table_, device.contextDesc(), queue(), below_});
        stage_->context.getInstanceProcAddr = FaultTable::getInstanceProcAddr();
    }
    void TearDown() override {
        for (const std::string& left : table_ ? table_->ledger().alive() : std::vector<std::string>()) {
            ADD_FAILURE() << left;
        }
        GpuTest::TearDown();
    }

    [[nodiscard]] const Stage& stage() const { return *stage_; }
    /// Every `stride`-th point; all of them where VOXTACT_ALL_FAULTS is set.
    void expectEveryCallMayFail(const Scenario& scenario, std::size_t stride, std::span<const VkResult> results) {
        if (scenario.keepsObjects) {
            // They grow to their size once: a later pass makes fewer calls than the first.
            EXPECT_EQ(play(scenario, std::nullopt, stage()).complaints, std::vector<std::string>());
        }
        expectNoFailures(sweep(
            scenario.name, [&](const std::optional<Fault>& fault) { return play(scenario, fault, stage()); },
            std::getenv("VOXTACT_ALL_FAULTS") == nullptr ? stride : 1, results));
    }

  private:
    std::optional<FaultTable> table_;
    DeviceFunctions below_;
    std::optional<Stage> stage_;
};

/// Uploads of everything, and what came to the device of them.
std::string uploads(Play& play) {
    const Context context = play.quietly([&] { return Context::create(play.stage().context); });
    const QueueAccess& queue = play.stage().queue;
    const VolumeData voxels = someVoxels(ScalarType::Int16);
    const MeshData cube = makeCube(0.2, 0.8);
    const Volume volume =
        play.ask("Volume::upload", [&] { return Volume::upload(context, queue, voxels.view(), {.editable = true}); });
    const TransferFunction function =
        play.ask("TransferFunction::upload", [&] { return TransferFunction::upload(context, queue, ramp()); });
    const Mesh mesh =
        play.ask("Mesh::upload", [&] { return Mesh::upload(context, queue, cube.view(), {.clusters = true}); });
    const LabelData data = play.quietly([&] { return makeLabels(voxels.view()); });
    const LabelMap labels = play.ask("LabelMap::upload", [&] { return LabelMap::upload(context, queue, data); });
    return "uploaded";
}

// Primes, so that every kind of call meets every kind of fault.

TEST_F(RealSweep, Uploads) {
    expectEveryCallMayFail({.name = "uploads", .run = uploads}, 3, kFaults);
}

/// One detector for all faults, and all of its answers.
TEST_F(RealSweep, Asking) {
    Play before(stage());
    const Setting setting(before);
    BlockingDetector detector = before.quietly([&] {
        return BlockingDetector::create(
            setting.context,
            RasterDesc{.method = CountingMethod::Atomic,
                       .outputs = {.triangles = true, .contacts = true, .bounds = true, .labels = true}},
            stage().queue);
    });
    const auto ask = [&](Play& play) {
        std::string answers;
        for (const std::uint32_t pairs : {2U, 3U}) {
            const std::vector<Mat4> poses = somePoses(pairs, 0.01 * pairs);
            const BatchItem item = setting.item(poses);
            answers += textOf(play.ask("BlockingDetector::detect", [&] {
                return detector.detect({{&item, 1}, someView(), kThreshold});
            }));
        }
        return answers;
    };
    expectEveryCallMayFail({.name = "asking", .run = ask, .keepsObjects = true}, 1, kSurvived);
}

/// The same of a renderer.
TEST_F(RealSweep, Rendering) {
    Play before(stage());
    const Setting setting(before);
    BlockingRenderer blocking =
        before.quietly([&] { return BlockingRenderer::create(setting.context, stage().queue); });
    const auto render = [&](Play& play) {
        const RenderTransferFunction function = play.ask("RenderTransferFunction::upload", [&] {
            return RenderTransferFunction::upload(blocking.renderer(), stage().queue,
                                                  {.opacity = ramp(), .colours = {}, .step = 0.1});
        });
        Scene scene;
        scene.volume = &setting.volume;
        scene.transferFunction = &function;
        scene.mesh = &setting.mesh;
        scene.clip_from_world = someView().clip_from_world;
        std::string pictures;
        for (const VkExtent2D extent : {VkExtent2D{8, 6}, VkExtent2D{12, 4}}) {
            pictures +=
                textOf(play.ask("BlockingRenderer::render", [&] { return blocking.render(scene, extent); }).rgba);
        }
        return pictures;
    };
    expectEveryCallMayFail({.name = "rendering", .run = render, .keepsObjects = true}, 5, kSurvived);
}

} // namespace
} // namespace voxtact::test
