// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/bounds.h"
#include "voxtact/data.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

/// The opaque volume inside a closed mesh: plain types, the same for every engine.
///
/// A point is inside the solid of a mesh if the winding number of its surface is not 0 (Jacobson et al., "Robust
/// inside-outside segmentation using generalized winding numbers", 2013): overlapping closed parts are a union, and the
/// orientation does not matter. A mesh with holes has no inside and is refused, unless they are filled first
/// (fillHoles()). The overlap of a pair is the volume, in world mm^3, of the points inside the solid that are opaque. A
/// point is opaque if it lies in the volume's closed box, out to the outer faces of the outermost voxels, and the
/// opacity of the trilinear interpolant reaches the threshold there. Bounds hold for the given vertices and include all
/// rounding. If triangles of the mesh intersect, their intersections are rounded, and no proof bounds that rounding.
namespace voxtact {

/// Default tolerance, mm^3: maximum upper - lower.
inline constexpr double kDefaultOverlapTolerance = 1;
/// Maximum number of limits between bands of values.
inline constexpr std::size_t kMaxBandLimits = 64;

/// Share of a region inside the solid: of the opaque region of the image, or of its part with a label.
enum class Containment : std::uint32_t {
    None,      ///< no point is inside: proven
    Some,      ///< one point is inside and another is not: proven
    All,       ///< every point is inside, and there is one: proven
    Undecided, ///< rounding decides, or the iteration limit was reached
};
/// Returns "none", "some", "all" or "undecided", with static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(Containment containment) noexcept;

/// The overlap of one pair.
struct PairOverlap {
    std::uint32_t pair = 0; ///< number of the pair in its batch
    std::uint32_t item = 0; ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0; ///< number of the pose within that item
    Bounds bounds;          ///< mm^3 of the opaque region inside the solid
    Bounds solid;           ///< mm^3 of the solid at its pose, inside and outside the image
    Containment inside{};   ///< share of the image's opaque region inside the solid
    StopReason end{};       ///< why the search stopped for `bounds`
};

/// The volume inside the solid of one pair in which the image's value is in one band, opaque or not. Band i of n limits
/// ranges from limit i-1 to below limit i; the first band has no lower limit, and the last, number n, no upper one. All
/// bands together are the part of the solid in the image.
struct BandOverlap {
    std::uint32_t pair = 0; ///< number of the pair in its batch
    std::uint32_t item = 0; ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0; ///< number of the pose within that item
    std::uint32_t band = 0; ///< from 0 to the number of limits
    Bounds bounds;          ///< mm^3
    StopReason end{};       ///< why they are no nearer to each other
};

/// The overlap of one pair with the opaque part of a label: inside the boxes around the voxel centres for which
/// labelAt() returns the label. The overlaps with all labels add up to that of the pair.
struct LabelOverlap {
    std::uint32_t pair = 0; ///< number of the pair in its batch
    std::uint32_t item = 0; ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0; ///< number of the pose within that item
    std::int32_t label = 0; ///< as in LabelData::values
    Bounds bounds;          ///< mm^3
    Containment inside{};   ///< share of the opaque part of that label inside the solid
    StopReason end{};       ///< why `bounds` are no nearer to each other
};

/// How much of the opaque region is inside a closed mesh, and of which values?
struct Overlap {
    double tolerance = kDefaultOverlapTolerance; ///< mm^3, from 1e-9 on: stop when upper - lower is at most this
    std::vector<double> bandLimits{};            ///< ascending, finite, at most kMaxBandLimits; empty: no bands
    std::vector<std::int32_t> labels{};          ///< labels to measure in; every item needs labels on its volume's grid
    std::uint64_t maxSteps = 1U << 18U;          ///< iteration limit per sum, then the current bounds; at least 1
};

/// The answer for a batch.
struct OverlapAnswer {
    std::vector<PairOverlap> pairs;   ///< in the order of the batch
    std::vector<BandOverlap> bands;   ///< by pair, then by band; empty without bands
    std::vector<LabelOverlap> labels; ///< by pair, then in the requested order
    double wallMilliseconds = 0;      ///< of the whole call
};

/// Whether a mesh has an inside.
struct SolidFacts {
    std::uint32_t holes = 0;       ///< loops of edges at which the surface ends; 0: closed
    std::uint32_t openEdges = 0;   ///< edges of all holes together
    double longestHole = 0;        ///< object units: length of the longest loop
    std::uint32_t nonManifold = 0; ///< edges of more than two triangles; allowed if their triangles cancel out
    bool inward = false;           ///< the signed volume is negative: triangles face inwards, which does not matter
    /// Signed volume of the surface, object units^3, without bounds; meaningless for a mesh with holes.
    double signedVolume = 0;
};
/// Finds holes: directed edges that do not cancel out. Identifies vertices by their coordinates, so a mesh whose
/// triangles share no vertices (STL) may be closed. Refuses what checkMesh() refuses. O(triangles log triangles).
[[nodiscard]] VOXTACT_API Result<SolidFacts> checkSolid(const MeshView& mesh);
/// Returns the error text of a mesh with holes, with their number and size; empty for a closed mesh.
[[nodiscard]] VOXTACT_API std::string holesText(const SolidFacts& facts);

/// A mesh whose holes were filled.
struct FilledMesh {
    MeshData mesh;           ///< the given triangles in their order, then the added ones
    std::uint32_t holes = 0; ///< number of filled holes
    double area = 0;         ///< added area, object units^2
};
/// Fills each hole by a fan around the mean of its corners. Refuses what checkMesh() refuses.
[[nodiscard]] VOXTACT_API Result<FilledMesh> fillHoles(const MeshView& mesh);

} // namespace voxtact
