// SPDX-License-Identifier: MIT
#pragma once

#include "support/host_meters.h"
#include "support/scenes.h"
#include "support/take.h"
#include "voxtact/cpu.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace voxtact::test {

/// The count of one mesh at one pose.
inline std::uint64_t engineCount(const MeshView& mesh, const VolumeView& volume, const TransferFunctionDesc& function,
                                 const View& view, double threshold, const cpu::DetectorDesc& desc = {},
                                 const Mat4& world_from_object = identity()) {
    const cpu::Mesh meshOn = take(cpu::Mesh::create(mesh));
    const cpu::Volume volumeOn = take(cpu::Volume::create(volume));
    const cpu::TransferFunction functionOn = take(cpu::TransferFunction::create(function));
    cpu::Detector detector = take(cpu::Detector::create(desc));
    const cpu::BatchItem item{&meshOn, &volumeOn, &functionOn, std::span(&world_from_object, 1)};
    return take(detector.detect({std::span(&item, 1), view, threshold})).pairs.at(0).count;
}

} // namespace voxtact::test
