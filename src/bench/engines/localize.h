// SPDX-License-Identifier: MIT
#pragma once

#include "bench/engines/engine.h"
#include "bench/engines/obb_tree.h"
#include "exact/shared.h"

#include <functional>
#include <memory>
#include <vector>

namespace voxtact {

/// The paper's two ways to say which triangles touch: an occlusion query a triangle (section 3),
/// or one for the set of triangles in a leaf of an OBB tree (section 6).
enum class Localization {
    Polygon,    ///< each triangle of the mesh
    Leaf,       ///< each leaf of an OBB tree that meets the volume's box together with every node above it
    LeafBricks, ///< the same, where the box of each node in texture space must also hold something opaque
};

[[nodiscard]] const char* toString(Localization way) noexcept;

/// Host inputs of the methods that traverse a tree.
struct LocalizeAids {
    const ObbTree* tree = nullptr; ///< of the batch's mesh; for Leaf and LeafBricks
    /// For LeafBricks: false only where no sample of a box of texture space, within [0,1]^3, is opaque.
    std::function<bool(const Box& texture)> mayBeOpaque;
};

/// Finds the triangles of a pair with passing fragments in the projection `view`, one query per triangle. The reference
/// for the finer methods. Blocks. Needs occlusionQueryPrecise.
///
/// The trees are asked in double about what the device does in float: the volume's box, and those of the nodes, are
/// made larger by half a voxel. A triangle thinner than the rasteriser's sub-pixels can have a fragment whose
/// coordinate is extrapolated farther than that, in the volume while the triangle is not: it has a query by Polygon
/// only.
/// Copies share it. Thread-safety: none; one thread at a time.
class Localizer {
  public:
    [[nodiscard]] static Result<Localizer> create(const Context& context, Filter filter, const QueueAccess& queue);

    /// Runs a batch of one pair. Returns its triangles, by number, the queries, the tested nodes, and the times, from
    /// the tree's root to the results in host memory. Returns InvalidArgument if an aid is missing, or the tree has
    /// another number of triangles.
    [[nodiscard]] Result<lab::Pass> triangles(const Batch& batch, Localization way, const LocalizeAids& aids = {});

    struct State;

  private:
    explicit Localizer(std::shared_ptr<State> state) noexcept : state_(std::move(state)) {}
    std::shared_ptr<State> state_;
};

/// Lists the passing fragments of the device's rasteriser for a pair, to compare counts with another rasteriser
/// fragment by fragment. Blocks. Needs geometryShader and fragmentStoresAndAtomics. Copies share it. Thread-safety:
/// none; one thread at a time.
class FragmentTrace {
  public:
    [[nodiscard]] static Result<FragmentTrace> create(const Context& context, Filter filter, const QueueAccess& queue);

    /// Returns the passing fragments of a batch of one pair, sorted by triangle, y and x. OutOfMemory if there are more
    /// than the device can list.
    [[nodiscard]] Result<std::vector<shader::TracedFragment>> survivors(const Batch& batch);

    struct State;

  private:
    explicit FragmentTrace(std::shared_ptr<State> state) noexcept : state_(std::move(state)) {}
    std::shared_ptr<State> state_;
};

} // namespace voxtact
