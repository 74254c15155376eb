// SPDX-License-Identifier: MIT
#pragma once

#include "oracle/oracle.h"
#include "support/take.h"
#include "voxtact/cpu.h"
#include "voxtact/detector.h"

#include <span>

namespace voxtact::test {

/// A scene on the device.
struct DeviceSide {
    Volume volume;
    TransferFunction function;
    Mesh mesh;

    DeviceSide(const Context& context, const QueueAccess& queue, const VolumeView& image,
               const TransferFunctionDesc& table, const MeshView& triangles, bool clusters)
        : volume(take(Volume::upload(context, queue, image, {.bricks = true}))),
          function(take(TransferFunction::upload(context, queue, table))),
          mesh(take(Mesh::upload(context, queue, triangles, {.clusters = clusters}))) {}

    [[nodiscard]] BatchItem item(std::span<const Mat4> poses) const { return {&mesh, &volume, &function, poses}; }
};

/// A scene on the host.
struct HostSide {
    cpu::Volume volume;
    cpu::TransferFunction function;
    cpu::Mesh mesh;

    HostSide(const VolumeView& image, const TransferFunctionDesc& table, const MeshView& triangles)
        : volume(take(cpu::Volume::create(image))), function(take(cpu::TransferFunction::create(table))),
          mesh(take(cpu::Mesh::create(triangles))) {}

    [[nodiscard]] cpu::BatchItem item(std::span<const Mat4> poses) const { return {&mesh, &volume, &function, poses}; }
};

/// The same scene on both.
struct Sides {
    DeviceSide device;
    HostSide host;

    Sides(const Context& context, const QueueAccess& queue, const VolumeView& image, const TransferFunctionDesc& table,
          const MeshView& triangles, bool clusters)
        : device(context, queue, image, table, triangles, clusters), host(image, table, triangles) {}

    [[nodiscard]] BatchItem item(std::span<const Mat4> poses) const { return device.item(poses); }
    [[nodiscard]] cpu::BatchItem hostItem(std::span<const Mat4> poses) const { return host.item(poses); }
};

/// One pair, examined by the device.
inline BatchAnswer askPair(BlockingDetector& detector, const Context& context, const QueueAccess& queue,
                           const oracle::OraclePair& pair, bool clusters) {
    const DeviceSide side(context, queue, pair.volume, pair.transferFunction, pair.mesh, clusters);
    const BatchItem item = side.item({&pair.world_from_object, 1});
    return take(detector.detect({{&item, 1}, {}, pair.threshold}));
}

/// One pair, examined by the host: `look` takes the batch.
template <class Look> auto onHost(const oracle::OraclePair& pair, Look look) {
    const HostSide side(pair.volume, pair.transferFunction, pair.mesh);
    const cpu::BatchItem item = side.item({&pair.world_from_object, 1});
    return look(cpu::Batch{{&item, 1}, {}, pair.threshold});
}

} // namespace voxtact::test
