// SPDX-License-Identifier: MIT
#pragma once

#include "host/count/reference.h"
#include "voxtact/cpu.h"

#include <random>

namespace voxtact::test {

/// A volume, a transfer function, a mesh, a camera and poses, with everything that is rare in practice made likely.
struct RandomScene {
    VolumeData volume;
    std::vector<ControlPoint> points;
    ValueRange domain;
    std::uint32_t tableSize = kDefaultTableSize;
    MeshData mesh;
    View view;
    std::vector<Mat4> poses;
    double threshold = kDefaultThreshold;
    bool rangeTest = true;

    [[nodiscard]] TransferFunctionDesc transferFunction() const { return {points, domain, tableSize}; }
    [[nodiscard]] std::vector<cpu::ReferenceCounts> reference() const;
};

[[nodiscard]] RandomScene makeRandomScene(std::mt19937_64& random, std::size_t poses);
/// The same with a threshold above 0: a threshold of 0 is the default in C.
[[nodiscard]] RandomScene makeRandomSceneForC(std::mt19937_64& random, std::size_t poses);

/// A scene whose mesh is one triangle in and about the volume, with a corner that is finite, and far away.
[[nodiscard]] RandomScene makeFarCornerScene(std::mt19937_64& random, std::size_t poses);

[[nodiscard]] VolumeData randomVolume(std::mt19937_64& random);
[[nodiscard]] MeshData randomMesh(std::mt19937_64& random, const Grid& grid);
[[nodiscard]] View randomView(std::mt19937_64& random, const Grid& grid);

/// Below `end`.
[[nodiscard]] std::size_t below(std::mt19937_64& random, std::size_t end);
[[nodiscard]] bool chance(std::mt19937_64& random, double probability);

} // namespace voxtact::test
