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
/// A point is inside the solid of a mesh where the winding number of its surface is not 0 (Jacobson et al., "Robust
/// inside-outside segmentation using generalized winding numbers", 2013): closed parts that overlap are a union, and a
/// mesh that is oriented inwards is the same solid. A mesh with holes has no inside and is refused, unless they are
/// filled first (fillHoles()). The overlap of a pair is the volume in world mm^3 of the points that are inside the
/// solid, in the volume's closed box out to the outermost voxels' faces, and opaque: where the trilinear interpolant's
/// opacity reaches the threshold. Bounds hold for the given vertices and
/// include all rounding. If triangles of the mesh intersect, where they are cut is rounded, and no proof bounds that
/// rounding.
namespace voxtact {

/// Default tolerance, mm^3: maximum upper - lower.
inline constexpr double kDefaultOverlapTolerance = 1;
/// Maximum number of limits between bands of values.
inline constexpr std::size_t kMaxBandLimits = 64;

/// How much of a region is inside the solid: of all that is opaque in the image, or of the part that has a label.
enum class Containment : std::uint32_t {
    None,      ///< no point of it; certain
    Some,      ///< a point of it is inside and another is not; certain
    All,       ///< every point of it, and there is one; certain
    Undecided, ///< rounding does not let it be said, or the steps that were allowed are used up
};
/// "none", "some", "all" or "undecided"; static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(Containment containment) noexcept;

/// The overlap of one pair.
struct PairOverlap {
    std::uint32_t pair = 0; ///< number of the pair in its batch
    std::uint32_t item = 0; ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0; ///< number of the pose within that item
    Bounds bounds;          ///< mm^3 of the opaque region inside the solid
    Bounds solid;           ///< mm^3 of the solid itself at its pose, inside and outside of the image
    Containment inside{};   ///< how much of the opaque region of the image is inside
    StopReason end{};       ///< why `bounds` are no nearer to each other
};

/// The volume inside the solid of one pair where the image's value is in one band, opaque or not. Band i of n limits is
/// from limit i-1 on to below limit i; the first band has no lower limit and the last, number n, no upper one. All
/// bands together are the part of the solid that is in the image.
struct BandOverlap {
    std::uint32_t pair = 0; ///< number of the pair in its batch
    std::uint32_t item = 0; ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0; ///< number of the pose within that item
    std::uint32_t band = 0; ///< from 0 to the number of limits
    Bounds bounds;          ///< mm^3
    StopReason end{};       ///< why they are no nearer to each other
};

/// The overlap of one pair with the opaque part of a label: in the boxes around its voxels' centres, where
/// labelAt() says that label. The overlaps with all labels together are the pair's.
struct LabelOverlap {
    std::uint32_t pair = 0; ///< number of the pair in its batch
    std::uint32_t item = 0; ///< number of the BatchItem that the pair came from
    std::uint32_t pose = 0; ///< number of the pose within that item
    std::int32_t label = 0; ///< as in LabelData::values
    Bounds bounds;          ///< mm^3
    Containment inside{};   ///< how much of the opaque part of that label is inside the solid
    StopReason end{};       ///< why `bounds` are no nearer to each other
};

/// How much of the opaque region is inside a closed mesh, and of which values?
struct Overlap {
    double tolerance = kDefaultOverlapTolerance; ///< mm^3, from 1e-9 on: how near to each other bounds are brought
    std::vector<double> bandLimits{};            ///< ascending, finite, at most kMaxBandLimits; empty: no bands
    std::vector<std::int32_t> labels{};          ///< every item then needs labels on the grid of its volume
    std::uint64_t maxSteps = 1U << 18U;          ///< a sum that takes more is left with the bounds it has; at least 1
};

/// The answer for a batch.
struct OverlapAnswer {
    std::vector<PairOverlap> pairs;   ///< in the order of the batch
    std::vector<BandOverlap> bands;   ///< by pair, then by band; empty where no band was asked for
    std::vector<LabelOverlap> labels; ///< by pair, then in the order that they were asked for
    double wallMilliseconds = 0;      ///< of the whole call
};

/// Whether a mesh has an inside.
struct SolidFacts {
    std::uint32_t holes = 0;       ///< loops of edges where the surface ends; 0: it is closed
    std::uint32_t openEdges = 0;   ///< edges of all holes together
    double longestHole = 0;        ///< object units: length of the longest loop
    std::uint32_t nonManifold = 0; ///< edges of more than two triangles; allowed where their triangles cancel out
    bool inward = false;           ///< the signed volume is negative: the triangles face inwards, which changes nothing
    /// Signed volume of the surface, object units^3, no bound; of a mesh with holes it has no meaning.
    double signedVolume = 0;
};
/// Looks for holes: directed edges that do not cancel out. Vertices are told apart by their coordinates, so that a mesh
/// whose triangles share no vertices (STL) may be closed. Refuses what checkMesh() refuses. O(triangles log triangles).
[[nodiscard]] VOXTACT_API Result<SolidFacts> checkSolid(const MeshView& mesh);
/// The error text of a mesh with holes, with their number and size; empty where there is none.
[[nodiscard]] VOXTACT_API std::string holesText(const SolidFacts& facts);

/// A mesh without holes, and what that took.
struct FilledMesh {
    MeshData mesh;           ///< the triangles of the given mesh in their order, then those that were added
    std::uint32_t holes = 0; ///< how many were filled
    double area = 0;         ///< object units^2 that were added
};
/// Fills each hole by a fan around the mean of its corners. Refuses what checkMesh() refuses.
[[nodiscard]] VOXTACT_API Result<FilledMesh> fillHoles(const MeshView& mesh);

} // namespace voxtact
