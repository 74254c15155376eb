// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/bounds.h"
#include "voxtact/data.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

/// The opaque volume inside a closed mesh: plain types, the same for every engine.
///
/// A point is inside the solid of a mesh if the winding number of the surface there is not 0 (Jacobson et al., "Robust
/// inside-outside segmentation using generalized winding numbers", 2013): overlapping closed parts are a union, and the
/// orientation does not matter. A mesh with holes has no inside and is refused; fillHoles() fills the holes. The
/// overlap of a pair is the volume of the opaque points inside the solid, in world mm^3. A point is opaque if it lies
/// in the volume's closed box and the opacity of the trilinear interpolant there reaches the threshold. The box extends
/// to the outer faces of the outermost voxels. Bounds hold for the given vertices and include all rounding. If
/// triangles of the mesh intersect, the intersections are rounded, and no proof bounds this rounding.
namespace voxtact {

/// Default tolerance, mm^3: maximum upper - lower.
inline constexpr double kDefaultOverlapTolerance = 1;
/// Maximum number of limits between bands of values.
inline constexpr std::size_t kMaxBandLimits = 64;

/// Share of a region inside the solid: of the opaque region of the image, or of its part with a label.
enum class Containment : std::uint32_t {
    None,      ///< no point is inside: proven
    Some,      ///< one point is inside and another is not: proven
    All,       ///< every point is inside, and at least one exists: proven
    Undecided, ///< not proven, because of rounding or the iteration limit
};
/// Returns "none", "some", "all" or "undecided", with static lifetime.
[[nodiscard]] VOXTACT_API const char* toString(Containment containment) noexcept;

/// The overlap of one pair.
struct PairOverlap {
    std::uint32_t pair = 0; ///< index of the pair in its batch
    std::uint32_t item = 0; ///< index of the BatchItem of the pair
    std::uint32_t pose = 0; ///< index of the pose in that item
    Bounds bounds;          ///< mm^3 of the opaque region inside the solid
    Bounds solid;           ///< mm^3 of the solid at its pose, inside and outside the image
    Containment inside{};   ///< share of the image's opaque region inside the solid
    StopReason end{};       ///< why the search stopped for `bounds`
};

/// The volume inside the solid of one pair with image values in one band, opaque or not. With n limits, band i ranges
/// from limit i-1 to below limit i. Band 0 has no lower limit, and band n no upper limit. Together, the bands fill the
/// part of the solid inside the image.
struct BandOverlap {
    std::uint32_t pair = 0; ///< index of the pair in its batch
    std::uint32_t item = 0; ///< index of the BatchItem of the pair
    std::uint32_t pose = 0; ///< index of the pose in that item
    std::uint32_t band = 0; ///< from 0 to the number of limits
    /// The lower limit; negative infinity for band 0.
    double from = -std::numeric_limits<double>::infinity();
    /// The upper limit, which is excluded; infinity for the last band.
    double below = std::numeric_limits<double>::infinity();
    Bounds bounds{};  ///< mm^3
    StopReason end{}; ///< why the search stopped
};

/// The overlap of one pair with the opaque part of a label: inside the boxes around the voxel centres for which
/// labelAt() returns the label. The overlaps with all labels add up to the overlap of the pair.
struct LabelOverlap {
    std::uint32_t pair = 0; ///< index of the pair in its batch
    std::uint32_t item = 0; ///< index of the BatchItem of the pair
    std::uint32_t pose = 0; ///< index of the pose in that item
    std::int32_t label = 0; ///< as in LabelData::values
    Bounds bounds;          ///< mm^3
    Containment inside{};   ///< share of the opaque part of that label inside the solid
    StopReason end{};       ///< why the search stopped for `bounds`
};

/// How much of the opaque region is inside a closed mesh, and of which values?
struct Overlap {
    double tolerance = kDefaultOverlapTolerance; ///< mm^3, at least 1e-9: stop when upper - lower is at most this
    std::vector<double> bandLimits{};            ///< ascending, finite, at most kMaxBandLimits; empty: no bands
    std::vector<std::int32_t> labels{};          ///< labels to measure in; every item needs labels on its volume's grid
    std::uint64_t maxSteps = 1U << 18U;          ///< iteration limit per sum, then the current bounds; at least 1
};

/// The answer for a batch.
struct OverlapAnswer {
    std::vector<PairOverlap> pairs;   ///< in the order of the batch
    std::vector<BandOverlap> bands;   ///< by pair, then by band; empty without bands
    std::vector<LabelOverlap> labels; ///< by pair, then in the requested order
    double wallMilliseconds = 0;      ///< duration of the whole call
};

/// Whether a mesh has an inside.
struct SolidFacts {
    std::uint32_t holes = 0;       ///< loops of edges at which the surface ends; 0: closed
    std::uint32_t openEdges = 0;   ///< edges of all holes together
    double longestHole = 0;        ///< object units: length of the longest loop
    std::uint32_t nonManifold = 0; ///< edges of more than two triangles; allowed if their triangles cancel out
    bool inward = false;           ///< the signed volume is negative: triangles face inwards, which does not matter
    /// Signed volume of the surface, object units^3: an estimate; meaningless for a mesh with holes.
    double signedVolume = 0;
};
/// Finds holes: directed edges that do not cancel out. Identifies vertices by coordinates, so a mesh without shared
/// vertices (STL) may be closed. Refuses meshes that checkMesh() refuses. O(triangles log triangles).
[[nodiscard]] VOXTACT_API Result<SolidFacts> checkSolid(const MeshView& mesh);
/// Returns the error text of a mesh with holes, with their number and size; empty for a closed mesh.
[[nodiscard]] VOXTACT_API std::string holesText(const SolidFacts& facts);

/// A mesh whose holes were filled.
struct FilledMesh {
    MeshData mesh;           ///< the given triangles in their order, then the added ones
    std::uint32_t holes = 0; ///< number of filled holes
    double area = 0;         ///< added area, object units^2
};
/// Fills each hole by a fan around the mean of its corners. Refuses meshes that checkMesh() refuses.
[[nodiscard]] VOXTACT_API Result<FilledMesh> fillHoles(const MeshView& mesh);

} // namespace voxtact
