// SPDX-License-Identifier: MIT
#pragma once

#include "io/mesh/gltf_accessor.h"
#include "io/mesh/gltf_scene.h"

namespace voxtact::io {

/// The matrices of a skin's joints: where each is, times its inverse bind matrix (the identity where the skin has
/// none).
[[nodiscard]] std::vector<Mat4> jointMatrices(GltfDocument& document, const GltfScene& scene, std::uint64_t skin);

/// Which joints move the vertices of one primitive, and how much.
class GltfSkinning {
  public:
    /// The primitive of `vertices` vertices has JOINTS_0 and WEIGHTS_0, or is refused; sets 1, 2, … where they are.
    GltfSkinning(GltfDocument& document, const GltfJson& attributes, std::uint64_t vertices,
                 const std::vector<Mat4>& joints);

    /// The weighted mean of the vertex's joint matrices.
    [[nodiscard]] Mat4 worldFromVertex(std::uint64_t vertex) const;

  private:
    struct Set {
        GltfAccessor joints;
        GltfAccessor weights;
    };
    std::vector<Set> sets_;
    const std::vector<Mat4>& matrices_;
};

} // namespace voxtact::io
