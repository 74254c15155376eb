// SPDX-License-Identifier: MIT
// What leaves a device when a measurement ends before its time: everything.
#include "bench/engines/scene.h"
#include "scenarios.h"
#include "sweep.h"

#include <gmock/gmock.h>

#include <new>

namespace voxtact::test {
namespace {

/// Puts everything of a scene on the device of a play, and then runs out of memory.
void measureAndThrow(Play& play, const lab::Scene& scene) {
    const Setting setting(play);
    const lab::DeviceStay stay(scene);
    const QueueAccess queue = play.stage().queue;
    lab::VolumePart& volume = *scene.volume;
    const LabelData labels = play.quietly([&] { return makeLabels(setting.volumeData.view()); });
    volume.device.emplace(
        play.quietly([&] { return Volume::upload(setting.context, queue, setting.volumeData.view()); }));
    volume.deviceFunction.emplace(
        play.quietly([&] { return TransferFunction::upload(setting.context, queue, ramp()); }));
    volume.deviceLabels.emplace(play.quietly([&] { return LabelMap::upload(setting.context, queue, labels); }));
    scene.mesh->device.emplace(
        play.quietly([&] { return Mesh::upload(setting.context, queue, setting.meshData.view()); }));
    throw std::bad_alloc();
}

TEST(DeviceStay, AnExceptionLeavesNothingOnTheDevice) {
    const lab::Scene scene{std::make_shared<lab::VolumePart>(), std::make_shared<lab::MeshPart>(), {}, {}, {}, {}};
    const auto scenario = [&](Play& play) {
        EXPECT_THROW(measureAndThrow(play, scene), std::bad_alloc);
        return std::string();
    };
    EXPECT_THAT(playDry({"a stay", scenario}, {}).complaints, testing::IsEmpty());
    EXPECT_FALSE(scene.volume->device || scene.volume->deviceFunction || scene.volume->deviceLabels ||
                 scene.mesh->device);
}

} // namespace
} // namespace voxtact::test
