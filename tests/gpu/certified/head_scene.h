// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/oracle.h"
#include "support/scenes.h"
#include "support/take.h"
#include "voxtact/cpu.h"
#include "voxtact/detector.h"
#include "voxtact/samples.h"

#include <array>
#include <random>
#include <vector>

namespace voxtact::test {

/// A scalpel, or what is larger, at some poses in and about a head.
struct Head {
    VolumeData head = take(makeBuiltinVolume("head:48"));
    std::array<ControlPoint, 2> points{ControlPoint{40, 0}, ControlPoint{80, 1}};
    MeshData data;
    Volume volume;
    TransferFunction function;
    Mesh mesh;
    cpu::Volume hostVolume = take(cpu::Volume::create(head.view()));
    cpu::TransferFunction hostFunction = take(cpu::TransferFunction::create({points, {0, 255}, kDefaultTableSize}));
    cpu::Mesh hostMesh = take(cpu::Mesh::create(data.view()));
    std::vector<Mat4> poses;
    BatchItem item{};

    Head(const Context& context, const QueueAccess& queue, MeshData given, std::size_t count, std::uint64_t seed,
         bool clusters = true, double spread = 1.2)
        : data(std::move(given)), volume(take(Volume::upload(context, queue, head.view(), {.bricks = true}))),
          function(take(TransferFunction::upload(context, queue, {points, {0, 255}, kDefaultTableSize}))),
          mesh(take(Mesh::upload(context, queue, data.view(), {.clusters = clusters}))) {
        std::mt19937_64 random(seed);
        poses = randomPoses(head.grid, count, spread, random);
        item = {&mesh, &volume, &function, poses};
    }
    [[nodiscard]] Batch batch() const { return {{&item, 1}, {}, kDefaultThreshold}; }
    [[nodiscard]] cpu::BatchItem hostItem() const { return {&hostMesh, &hostVolume, &hostFunction, poses}; }
    [[nodiscard]] oracle::OraclePair pair(std::size_t pose) const {
        return {data.view(), head.view(), {points, {0, 255}, kDefaultTableSize}, {}, poses[pose], kDefaultThreshold};
    }
};

} // namespace voxtact::test
