// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/random_scene.h"
#include "settings.h"
#include "support/c_calls.h"
#include "support/scenes.h"
#include "support/take.h"
#include "voxtact/cpu.h"

#include <utility>

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

/// Like vxt_ask().
[[nodiscard]] inline vxt_result askC(vxt_host_engine* engine, const char* question, const Settings& settings,
                                     const vxt_pairs* pairs, vxt_answer* answer) {
    return vxt_ask(engine, question, settings.data(), settings.size(), pairs, answer);
}

/// A closed mesh: a cube whose triangles all face outwards.
[[nodiscard]] inline MeshData closedCube(double lo, double hi) {
    MeshData cube = makeCube(lo, hi);
    for (const std::size_t triangle : {0, 1, 4, 5, 8, 9}) {
        std::swap(cube.indices[3 * triangle + 1], cube.indices[3 * triangle + 2]);
    }
    return cube;
}

/// A mesh that touches, one that does not, and a small one on the way, with a label that is not opaque anywhere.
[[nodiscard]] inline RandomScene plainScene() {
    RandomScene scene;
    scene.volume = makeBytes(millimetreGrid(16), [](auto x, auto...) { return x < 4 ? 255.0 : 0.0; });
    scene.points = {{100, 0}, {200, 1}};
    scene.domain = {0, 255};
    scene.mesh = makeCube(0, 2);
    scene.poses = {translation({5, 7, 7}), translation({2.3, 7, 7}), translation({9.2, 3, 4})};
    scene.view = {framingCamera(scene.volume.grid, 32, 32), 32, 32};
    return scene;
}
[[nodiscard]] inline VolumeData plainLabels() {
    return makeBytes(millimetreGrid(16), [](auto x, auto...) { return x >= 12 ? 4.0 : 0.0; });
}

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
    [[nodiscard]] Owned<vxt_answer> byC(vxt_host_engine& engine, const char* question, const Settings& settings,
                                        const RandomScene& scene) const {
        CPairs c;
        fill(c, scene);
        Owned<vxt_answer> answer = newAnswer();
        need(askC(&engine, question, settings, &c.pairs, answer.get()));
        return answer;
    }
};

} // namespace voxtact::test
