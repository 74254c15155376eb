// SPDX-License-Identifier: MIT
#pragma once

#include "embedder.h"
#include "play.h"
#include "support/any_desc.h"
#include "support/scenes.h"
#include "voxtact/detector.h"

#include <optional>

namespace voxtact::test {

/// A context with every object that a detector can be asked about, made while nothing fails.
struct Setting {
    explicit Setting(Play& play);

    /// Pairs of the mesh, the volume and the label map.
    [[nodiscard]] BatchItem item(std::span<const Mat4> poses) const;

    VolumeData volumeData; ///< 8 x 8 x 8 bytes over the unit cube
    MeshData meshData;
    Context context;
    Volume volume; ///< editable, with bricks
    TransferFunction function;
    Mesh mesh; ///< editable, with clusters
    LabelMap labels;
};

[[nodiscard]] VolumeData someVoxels(ScalarType type = ScalarType::UInt8);
/// Different poses in the unit cube.
[[nodiscard]] std::vector<Mat4> somePoses(std::uint32_t count, double first);
[[nodiscard]] View someView();
[[nodiscard]] TransferFunctionDesc ramp(double top = 255);
inline constexpr double kThreshold = 0.3;

/// An answer as text: equal where all but the wall clock is.
[[nodiscard]] std::string textOf(const BatchAnswer& answer);
[[nodiscard]] std::string textOf(std::span<const PairResult> results);
[[nodiscard]] std::string textOf(std::span<const std::uint8_t> bytes);

[[nodiscard]] std::vector<Scenario> sceneScenarios();  ///< contexts, uploads, wraps
[[nodiscard]] std::vector<Scenario> detectScenarios(); ///< every method, projection and output; lists and queries
[[nodiscard]] std::vector<Scenario> editScenarios();   ///< rings, edits, updates
[[nodiscard]] std::vector<Scenario> renderScenarios();

} // namespace voxtact::test
