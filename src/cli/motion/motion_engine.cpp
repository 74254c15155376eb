// SPDX-License-Identifier: MIT
#include "cli/motion/motion_engine.h"
#include "cli/output/interrupt.h"
#include "core/base/try.h"

namespace voxtact::app {

Result<MotionEngine> MotionEngine::create(const Motion& question, std::uint32_t threads,
                                          std::span<const MeshData> meshes) {
    Result<cpu::HostEngine> engine = cpu::HostEngine::create(threads);
    VOXTACT_TRY(engine);
    std::vector<cpu::Mesh> made;
    for (const MeshData& data : meshes) {
        Result<cpu::Mesh> mesh = cpu::Mesh::create(data.view());
        VOXTACT_TRY(mesh);
        made.push_back(std::move(*mesh));
    }
    return MotionEngine(question, std::move(*engine), std::move(made));
}

Result<void> MotionEngine::setVolume(const VolumeView& volume, const TransferFunctionDesc& function) {
    Result<cpu::Volume> made = cpu::Volume::create(volume);
    VOXTACT_TRY(made);
    Result<cpu::TransferFunction> table = cpu::TransferFunction::create(function);
    VOXTACT_TRY(table);
    scene_.emplace(std::move(*made), std::move(*table));
    return {};
}

Result<MotionAnswer> MotionEngine::check(std::uint32_t mesh, std::span<const Mat4> poses, double threshold) {
    const cpu::BatchItem item{&meshes_[mesh], &scene_->first, &scene_->second, poses};
    return engine_.ask(question_, {.items = std::span(&item, 1), .threshold = threshold, .cancel = &interruptFlag()});
}

} // namespace voxtact::app
