// SPDX-License-Identifier: MIT
#pragma once

#include "io/mesh/gltf_document.h"

namespace voxtact::io {

/// A mesh where its scene puts it.
struct GltfPlacement {
    std::uint64_t mesh = 0;
    std::optional<std::uint64_t> node; ///< none for a mesh that lies in no node
    Mat4 world_from_node = identity();
};

/// The nodes of a document, each under at most one other.
class GltfScene {
  public:
    explicit GltfScene(const GltfDocument& document);

    /// The meshes of the scene that the file names as its own, in the order of its nodes. A file that names none has
    /// the first; without scenes, all nodes are in it, and without nodes all meshes. `notes` says which.
    [[nodiscard]] std::vector<GltfPlacement> placements(std::vector<std::string>& notes) const;

    [[nodiscard]] const Mat4& worldFromNode(std::uint64_t node) const;

  private:
    void takeTree();
    void takeTransforms();
    [[nodiscard]] std::vector<std::uint64_t> roots(std::vector<std::string>& notes) const;

    const GltfDocument& document_;
    std::vector<std::vector<std::uint64_t>> children_;
    std::vector<bool> isChild_;
    std::vector<Mat4> world_from_node_;
};

} // namespace voxtact::io
