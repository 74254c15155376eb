// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/oracle_scenes.h"

#include <span>

namespace voxtact::test {

/// A scene that the engine has.
struct HeldScene {
    explicit HeldScene(const OracleScene& scene)
        : mesh(take(cpu::Mesh::create(scene.mesh.view()))), volume(take(cpu::Volume::create(scene.volume.view()))),
          function(take(cpu::TransferFunction::create({scene.points, scene.domain, scene.tableSize}))),
          pose(scene.world_from_object), item{&mesh, &volume, &function, std::span(&pose, 1)}, batch{
                                                                                                   std::span(&item, 1),
                                                                                                   {},
                                                                                                   scene.threshold} {}
    HeldScene(const HeldScene&) = delete;
    HeldScene& operator=(const HeldScene&) = delete;

    cpu::Mesh mesh;
    cpu::Volume volume;
    cpu::TransferFunction function;
    Mat4 pose;
    cpu::BatchItem item;
    cpu::Batch batch;
};

} // namespace voxtact::test
