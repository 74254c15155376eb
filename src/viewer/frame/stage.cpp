// SPDX-License-Identifier: MIT
#include "viewer/frame/stage.h"

#include "core/base/try.h"
#include "core/method/method_table.h"
#include "vulkan/own/timed_submission.h"

namespace voxtact::view {

namespace {

/// Drivers compile at the first draw. These results are discarded.
Result<void> rehearse(const device::Session& session, const State& state, Stage& stage) {
    constexpr VkExtent2D kSmall{16, 16};
    constexpr Extent kShape{16, 16};
    for (const bool fine : {false, true}) {
        const Result<Picture> picture =
            stage.scene->blocking().render(stage.scene->scene(state, 0, fine, kShape).scene, kSmall);
        VOXTACT_TRY(picture);
    }
    Result<device::TimedSubmission> submission = device::TimedSubmission::create(session);
    VOXTACT_TRY(submission);
    const auto run = submission->run([&](VkCommandBuffer commands) -> Result<void> {
        stage.slices->record(commands, state);
        const LiveQuestion question{state.revision, state.document.edit, state.method};
        return rowOf(state.method.count).host ? Result<void>()
                                              : stage.device->record(commands, *stage.scene, question, 0);
    });
    // A method that cannot answer is reported when it is used.
    if (!run.ok() && run.error().code == ErrorCode::DeviceLost) {
        return run.error();
    }
    static_cast<void>(stage.device->collect(0, 0));
    return {};
}

} // namespace

Result<Volume> Stage::upload(const device::Session& session, const VolumeData& volume) {
    return Volume::upload(session.context, session.device.queueAccess(), volume.view(),
                          {.bricks = true, .editable = true});
}

Result<std::unique_ptr<Stage>> Stage::create(const device::Session& session, const State& state, Volume volume,
                                             const StageDesc& desc, Progress& progress) {
    auto stage = std::make_unique<Stage>();
    VOXTACT_TRY(progress.begin("building the host engine"));
    Result<std::unique_ptr<HostAnswers>> host = HostAnswers::create(state, desc.wake);
    VOXTACT_TRY(host);
    stage->host = std::move(*host);
    VOXTACT_TRY(progress.begin("uploading meshes and tables"));
    Result<std::unique_ptr<DeviceScene>> scene =
        DeviceScene::create(session, state, std::move(volume), desc.light(state.volume.grid));
    VOXTACT_TRY(scene);
    stage->scene = std::move(*scene);
    const auto detectors = std::make_shared<Detectors>(session.context, stage->scene->labels() != nullptr);
    stage->device.emplace(session, *stage->scene, detectors);
    Result<std::unique_ptr<BesideAnswers>> beside = BesideAnswers::create(session, *stage->scene, detectors, desc.wake);
    VOXTACT_TRY(beside);
    stage->beside = std::move(*beside);
    VOXTACT_TRY(progress.begin("compiling shaders"));
    Result<Pictures> pictures = Pictures::create(session, stage->scene->renderer(), desc.picture);
    VOXTACT_TRY(pictures);
    stage->pictures.emplace(std::move(*pictures));
    Result<SlicePass> slices = SlicePass::create(session, stage->scene->volume());
    VOXTACT_TRY(slices);
    stage->slices = std::move(*slices);
    VOXTACT_TRY(stage->slices->resize(desc.slices));
    VOXTACT_TRY(rehearse(session, state, *stage));
    return stage;
}

} // namespace voxtact::view
