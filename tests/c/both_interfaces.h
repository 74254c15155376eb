// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/random_scene.h"
#include "support/c_calls.h"
#include "support/take.h"
#include "voxtact/cpu.h"

#include <stdexcept>

namespace voxtact::test {

/// So many voxels per side of 1 mm each, the first one's centre at the origin.
inline Grid millimetreGrid(std::uint32_t side) {
    Grid grid;
    grid.size = {side, side, side};
    return grid;
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
          cVolumeHandle(made<vxt_host_volume>(vxt_host_volume_destroy,
                                              [&](auto out) {
                                                  const vxt_volume_view view = cVolume(scene.volume);
                                                  return vxt_host_volume_create(&view, out);
                                              })),
          cFunctionHandle(made<vxt_host_transfer_function>(vxt_host_transfer_function_destroy,
                                                           [&](auto out) {
                                                               const auto points = cPoints(scene.points);
                                                               const auto desc =
                                                                   cFunction(points, scene.domain, scene.tableSize);
                                                               return vxt_host_transfer_function_create(&desc, out);
                                                           })),
          cMeshHandle(made<vxt_host_mesh>(vxt_host_mesh_destroy,
                                          [&](auto out) {
                                              const vxt_mesh_view view = cMesh(scene.mesh);
                                              return vxt_host_mesh_create(&view, out);
                                          })),
          cLabels(made<vxt_labels>(vxt_labels_destroy, [&](auto out) {
              const vxt_volume_view view = cVolume(labelImage);
              return vxt_labels_create(&view, out);
          })) {}

    [[nodiscard]] BatchAnswer byCpp(cpu::Detector& detector, const RandomScene& scene) const {
        const cpu::BatchItem item{&mesh, &volume, &function, scene.poses, &labels};
        return take(detector.detect({std::span(&item, 1), scene.view, scene.threshold}));
    }

    /// What of the C interface has the scene; valid as long as this, the scene and the view are.
    struct CBatch {
        vxt_view view{};
        vxt_host_item item = vxt_host_item_init();
        vxt_host_batch batch = vxt_host_batch_init();
    };
    void fill(CBatch& out, const RandomScene& scene) const {
        out.view = cView(scene.view);
        out.item.mesh = cMeshHandle.get();
        out.item.volume = cVolumeHandle.get();
        out.item.transfer_function = cFunctionHandle.get();
        out.item.world_from_object = scene.poses.data()->data();
        out.item.pose_count = scene.poses.size();
        out.item.labels = cLabels.get();
        out.batch.items = &out.item;
        out.batch.item_count = 1;
        out.batch.view = &out.view;
        out.batch.threshold = scene.threshold;
    }
    [[nodiscard]] BatchAnswer byC(vxt_host_detector& detector, const RandomScene& scene) const {
        CBatch c;
        fill(c, scene);
        const Owned<vxt_answer> answer = newAnswer();
        need(vxt_host_detector_detect(&detector, &c.batch, answer.get()));
        return answerOf(*answer);
    }
};

} // namespace voxtact::test
