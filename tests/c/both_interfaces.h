// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/random_scene.h"
#include "support/c_calls.h"
#include "support/take.h"
#include "voxtact/cpu.h"

namespace voxtact::test {

/// So many voxels per side of 1 mm each, the first one's centre at the origin.
inline Grid millimetreGrid(std::uint32_t side) {
    Grid grid;
    grid.size = {side, side, side};
    return grid;
}

[[nodiscard]] inline Owned<vxt_host_engine> newEngine(std::uint32_t threads = 1) {
    return made(vxt_host_engine_destroy, vxt_host_engine_create, threads);
}
[[nodiscard]] inline Owned<vxt_cancel> newCancel() {
    return made(vxt_cancel_destroy, vxt_cancel_create);
}

// One name for all questions.
#define VOXTACT_ASK(question)                                                                                          \
    inline vxt_result askC(vxt_host_engine* engine, const vxt_##question* asked, const vxt_pairs* pairs,               \
                           vxt_answer* answer) {                                                                       \
        return vxt_ask_##question(engine, asked, pairs, answer);                                                       \
    }
VOXTACT_ASK(touch)
VOXTACT_ASK(count)
VOXTACT_ASK(distance)
VOXTACT_ASK(area)
VOXTACT_ASK(motion)
#undef VOXTACT_ASK

/// A scene through both interfaces.
struct BothInterfaces {
    cpu::Volume volume;
    cpu::TransferFunction function;
    cpu::Mesh mesh;
    LabelData labels;
    Owned<vxt_host_volume> cVolumeHandle;
    Owned<vxt_host_transfer_function> cFunctionHandle;
    Owned<vxt_host_mesh> cMeshHandle;
    Owned<vxt_labels> cLabels;

    BothInterfaces(const RandomScene& scene, const VolumeData& labelImage)
        : volume(take(cpu::Volume::create(scene.volume.view()))),
          function(take(cpu::TransferFunction::create(scene.transferFunction()))),
          mesh(take(cpu::Mesh::create(scene.mesh.view()))), labels(take(makeLabels(labelImage.view()))),
          cVolumeHandle(made(vxt_host_volume_destroy, vxt_host_volume_create, at(cVolume(scene.volume)))),
          cFunctionHandle(made(vxt_host_transfer_function_destroy, vxt_host_transfer_function_create,
                               at(cFunction(cPoints(scene.points), scene.domain, scene.tableSize)))),
          cMeshHandle(made(vxt_host_mesh_destroy, vxt_host_mesh_create, at(cMesh(scene.mesh)))),
          cLabels(made(vxt_labels_destroy, vxt_labels_create, at(cVolume(labelImage)))) {}

    [[nodiscard]] cpu::BatchItem itemOf(const RandomScene& scene) const {
        return {&mesh, &volume, &function, scene.poses, &labels};
    }
    template <class Question>
    [[nodiscard]] auto byCpp(cpu::HostEngine& engine, const Question& question, const RandomScene& scene) const {
        const cpu::BatchItem item = itemOf(scene);
        return take(
            engine.ask(question, cpu::Batch{.items = {&item, 1}, .view = scene.view, .threshold = scene.threshold}));
    }

    /// The scene for C; valid as long as this, the scene and the view are. Stays where it is.
    struct CPairs {
        vxt_view view{};
        vxt_host_item item{};
        vxt_pairs pairs = sized<vxt_pairs>();
    };
    void fill(CPairs& out, const RandomScene& scene) const {
        out.view = cView(scene.view);
        out.item = {cMeshHandle.get(),          cVolumeHandle.get(), cFunctionHandle.get(),
                    scene.poses.data()->data(), scene.poses.size(),  cLabels.get()};
        out.pairs = {sizeof out.pairs, &out.item, 1, &out.view, scene.threshold, nullptr};
    }
    template <class Question>
    [[nodiscard]] Owned<vxt_answer> byC(vxt_host_engine& engine, const Question& question,
                                        const RandomScene& scene) const {
        CPairs c;
        fill(c, scene);
        Owned<vxt_answer> answer = newAnswer();
        need(askC(&engine, &question, &c.pairs, answer.get()));
        return answer;
    }
};

} // namespace voxtact::test
