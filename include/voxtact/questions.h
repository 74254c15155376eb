// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/area.h"
#include "voxtact/distance.h"
#include "voxtact/motion.h"
#include "voxtact/overlap.h"
#include "voxtact/results.h"

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

/// Questions about pairs of a mesh at a pose and an image, as plain data for an engine (voxtact/cpu.h). Answers depend
/// only on the pair and the question. The table of facts has the ranges and defaults of all numbers; an engine refuses
/// values outside the ranges.
namespace voxtact {

/// Does the surface touch the opaque region? Certified: *yes* and *no* are proven.
struct Touch {
    double margin = 0; ///< mm: is anything opaque within this distance of the surface?
    /// Tests all poses within this uncertainty. Not with a margin; the answers have no witness points.
    std::optional<PoseTolerance> uncertainty{};
    /// Finds a witness point of each yes; slower. The witness point of an enclosed region is inside the mesh.
    bool witness = false;
    /// Includes the inside of the mesh, which must be closed: a mesh that encloses an opaque region is a yes.
    bool solid = false;
    double resolution = kDefaultResolution; ///< voxels, 2^-12 to 1: shorter pieces of triangles are not divided
    std::uint64_t maxSteps = 1U << 20U;     ///< iteration limit per pair, then undecided; at least 1
};

/// How many fragments pass, and where?
struct Count {
    Projection projection = Projection::View;                ///< how triangles become fragments
    Boundary boundary = Boundary::Auto;                      ///< outside the image; Auto: Range on the host engine
    Outputs outputs{};                                       ///< additional outputs; not with stopAtFirst
    bool stopAtFirst = false;                                ///< early exit: the count is 0 or 1, a lower bound
    std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel; ///< dominant-axis: per voxel side; 1 to 16
    double resolution = kDefaultResolution;                  ///< certified: as in Touch
    std::uint32_t maxContacts = 1U << 20U;                   ///< maximum number of contacts; a longer list is cut
};

/// How far is the surface from the opaque region?
struct Distance {
    double tolerance = kDefaultTolerance; ///< mm, at least 1e-6: stop when upper - lower is at most this
    double maximum = std::numeric_limits<double>::infinity(); ///< mm, above 0: stop when lower reaches this distance
    /// Labels to measure to, at most kMaxMeasuredLabels. Every item then needs labels on the grid of its volume, and
    /// the answer has labels instead of pairs. A label fills the closed boxes of its voxels, so a face between two
    /// labels belongs to both. The distance to a label that the map lacks is infinite.
    std::optional<std::vector<std::int32_t>> labels{};
    bool labelsAtAnyOpacity = false; ///< measures to the whole label; false: to its opaque part
    /// Includes the inside of the mesh, which must be closed: the distance to an enclosed opaque region is 0, with a
    /// witness point inside the mesh. Not with labels.
    bool solid = false;
    double resolution = kDefaultResolution; ///< as in Touch
    std::uint64_t maxSteps = 1U << 18U;     ///< iteration limit per pair, then the current bounds; at least 1
};

/// How much of the surface is in the opaque region?
struct Area {
    double tolerance = kDefaultAreaTolerance; ///< mm^2, at least 1e-9: stop when upper - lower is at most this
    /// Labels to measure in, at most kMaxMeasuredLabels, as in Distance. The area of a label that the map lacks is 0.
    std::optional<std::vector<std::int32_t>> labels{};
    /// Also measures the area of each triangle; not with labels. The tolerance applies to the area of the pair. Takes
    /// about 100 bytes per touching triangle until the batch is complete.
    bool triangles = false;
    double resolution = kDefaultResolution; ///< as in Touch
    /// Iteration limit per pair or label, at least 1; then returns the current bounds. Each iteration takes at most
    /// half a kilobyte of a thread's memory while its pair is measured.
    std::uint64_t maxSteps = 1U << 18U;
};

/// Shapes of a deforming mesh, one for each pose of an item: its vertices, as cpu::Mesh::update() takes them.
using ShapesOfPoses = std::span<const std::span<const double>>;

/// What happens between consecutive poses of each item? An item has one answer fewer than poses.
struct Motion {
    Interpolation interpolation = Interpolation::Screw; ///< kind of motion between the poses
    double resolution = kDefaultMotionResolution; ///< mm, at least 1e-6: maximum motion from toi_lower to toi_upper
    /// Shapes of deforming meshes, for each item: while the mesh moves as in poseBetween(), with the centre of the
    /// item's own mesh, its vertices move as in shapeBetween(). Empty: rigid. Read during the call only.
    std::span<const ShapesOfPoses> shapes{};
    double touchResolution = kDefaultResolution; ///< as Touch::resolution
    std::uint64_t maxSteps = 1U << 20U;          ///< iteration limit per segment, then the current bounds; at least 1
};

} // namespace voxtact
