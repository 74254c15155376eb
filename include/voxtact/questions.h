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

/// Questions about pairs of a mesh at a pose and an image, as plain data: an engine answers them (voxtact/cpu.h). What
/// an engine answers depends on nothing but the pair and the question. Ranges and defaults of all numbers are in the
/// table of facts; an engine refuses what is outside.
namespace voxtact {

/// Does the surface touch the opaque region? Certified: *yes* and *no* are proven.
struct Touch {
    double margin = 0; ///< mm: is anything opaque at most that far from the surface?
    /// At any pose that is off by at most this? Not with a margin; the answers have no witness points.
    std::optional<PoseTolerance> uncertainty{};
    /// Finds a witness point of each yes, which takes longer. Of an enclosed region it is inside the mesh.
    bool witness = false;
    /// The inside of the mesh, which must be closed, touches too: a mesh that encloses an opaque region is a yes.
    bool solid = false;
    double resolution = kDefaultResolution; ///< voxels, 2^-12 to 1: pieces of triangles are not divided below it
    std::uint64_t maxSteps = 1U << 20U;     ///< of the search of one pair; then it is undecided; at least 1
};

/// How many fragments pass, and where?
struct Count {
    Projection projection = Projection::View; ///< how triangles become fragments
    Boundary boundary = Boundary::Auto;       ///< of the image; the host engine always tests the range for Auto
    Outputs outputs{};                        ///< what is asked for in addition; not with stopAtFirst
    bool stopAtFirst = false;                 ///< the count is then 0 or 1, a lower bound: whether any fragment passes
    std::uint32_t samplesPerVoxel = kDefaultSamplesPerVoxel; ///< dominant-axis: along a voxel's side; 1 to 16
    double resolution = kDefaultResolution;                  ///< certified: as in Touch
    std::uint32_t maxContacts = 1U << 20U;                   ///< a list of contacts is cut beyond that many
};

/// How far is the surface from the opaque region?
struct Distance {
    double tolerance = kDefaultTolerance; ///< mm, from 1e-6 on: the search ends when the bounds are that near
    double maximum =
        std::numeric_limits<double>::infinity(); ///< mm, above 0: the search ends when it is certainly farther
    /// To each of these labels, at most kMaxMeasuredLabels: then every item needs labels on the grid of its volume,
    /// and the answer has labels instead of pairs. A label fills the closed boxes of its voxels, so that a face between
    /// two labels belongs to both. Labels that a map does not have are infinitely far.
    std::optional<std::vector<std::int32_t>> labels{};
    bool labelsAtAnyOpacity = false; ///< to all of a label; false: to the part of it that is opaque
    /// From the inside of the mesh, too, which must be closed: an enclosed opaque region is at distance 0, with a
    /// witness point inside the mesh. Not with labels.
    bool solid = false;
    double resolution = kDefaultResolution; ///< as in Touch
    std::uint64_t maxSteps = 1U << 18U;     ///< a pair that takes more is left with the bounds it has; at least 1
};

/// How much of the surface is in the opaque region?
struct Area {
    double tolerance = kDefaultAreaTolerance; ///< mm^2, from 1e-9 on: the search ends when the bounds are that near
    /// In each of these labels, at most kMaxMeasuredLabels: as in Distance. Of labels that a map does not have it is 0.
    std::optional<std::vector<std::int32_t>> labels{};
    /// And how much each triangle has of it; not with labels. The tolerance is of the pair's area. All of a batch is in
    /// memory until it is done, some 100 bytes for each triangle that touches.
    bool triangles = false;
    double resolution = kDefaultResolution; ///< as in Touch
    /// A pair, or a label of one, that takes more is left with the bounds it has; at least 1. Each step takes half a
    /// kilobyte of a thread's memory at most, while its pair is measured.
    std::uint64_t maxSteps = 1U << 18U;
};

/// The shapes of a mesh that bends, one for each pose of an item: its vertices, as cpu::Mesh::update() takes them.
using ShapesOfPoses = std::span<const std::span<const double>>;

/// What happens between consecutive poses of each item? One answer fewer than an item has poses.
struct Motion {
    Interpolation interpolation = Interpolation::Screw; ///< of the poses in between
    double resolution = kDefaultMotionResolution; ///< mm, from 1e-6 on: the mesh moves at most that far from the end of
                                                  ///< what is free to a touch
    /// Of meshes that bend on the way, for each item: while the mesh moves as poseBetween() says, with the centre of
    /// the item's own mesh, its vertices go as shapeBetween() says. Empty: nothing bends. Read during the call only.
    std::span<const ShapesOfPoses> shapes{};
    double touchResolution = kDefaultResolution; ///< as Touch::resolution
    std::uint64_t maxSteps = 1U << 20U;          ///< a segment that takes more is left with what is known; at least 1
};

} // namespace voxtact
