// SPDX-License-Identifier: MIT
#pragma once

#include "app/compare_localize.h"
#include "app/compare_result.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// What `voxtact bench --paper` finds: the measurements of the paper (Volume-Surface Collision Detection, section 6)
/// made again.
namespace voxtact::app {

/// What the paper publishes of its own measurements, on its own hardware (OpenGL).
namespace published {
inline constexpr double kPairsPerSecond = 3800;
inline constexpr double kLeastOverhead = 4.3; ///< percent that collision detection adds to a frame, over its scenes
inline constexpr double kMostOverhead = 15.9;
inline constexpr double kIntegrationMilliseconds = 40; ///< the pre-integrated table, 256x256
} // namespace published

/// One of the four: v1s1, v1s2, v2s1, v2s2.
struct PaperScene {
    std::string name{};
    std::string volume{}; ///< a file's name, or builtin:NAME
    std::string mesh{};
    std::array<std::uint32_t, 3> voxels{};
    std::string voxelType{};
    std::uint32_t triangles = 0;
    double opaqueShare = 0; ///< of the voxels, 0..1
    std::string opacity{};  ///< the transfer function, as --opacity takes it
    std::uint32_t poses = 0;
    double step = 0; ///< of the ray casting, mm
};

/// The columns of the paper's tables by one clock, ms: a sample each round, of one pose. Empty where that clock cannot
/// tell. Samples of one round have the same number in every column.
struct PaperColumns {
    std::vector<double> mesh{};      ///< drawing the mesh; within `rendering`
    std::vector<double> volume{};    ///< casting rays through the volume; within `rendering`
    std::vector<double> collision{}; ///< the detection of one pair, alone
    std::vector<double> rendering{}; ///< a frame: mesh and volume, without detection; all that `total` has but that
    std::vector<double> total{};     ///< a frame and the detection in one submission
};

/// What detection costs of what rendering does, percent: the paper's way to say it, by their times alone. A sample each
/// round; none where one of the two is not known.
[[nodiscard]] std::vector<double> collisionPercent(const PaperColumns& columns);
/// What detection adds to a frame, percent of the frame without it. A sample each round, of the two frames of it.
[[nodiscard]] std::vector<double> overheadPercent(const PaperColumns& columns);

/// A line of the tables: a counting method in a scene.
struct PaperRow {
    std::size_t scene = 0; ///< number in PaperResult::scenes
    std::string method{};
    double survivors = 0; ///< of a pair, on average over the poses; of query-any 0 or 1
    std::uint32_t hits = 0;
    PaperColumns gpu{};  ///< timestamps
    PaperColumns wall{}; ///< from submission to the end of the wait; `mesh` and `volume` are empty
};

/// The making of the pre-integrated table.
struct IntegrationPoint {
    std::uint32_t entries = 0;  ///< a side
    std::vector<double> gpu{};  ///< ms, a sample each
    std::vector<double> wall{}; ///< the same; with the integrals on the host, the submission and the wait
};

struct PaperResult {
    Machine machine;
    std::uint32_t width = 0; ///< of frames and viewport
    std::uint32_t height = 0;
    std::vector<PaperScene> scenes;
    std::vector<PaperRow> rows;
    std::vector<Series> series;         ///< sweeps: batches, triangles, fragments, voxels; of v1s1 where not varied
    std::vector<LocalizeWay> polygons;  ///< which triangles touch, in v1s1
    std::uint32_t polygonTriangles = 0; ///< of the mesh there
    std::uint32_t polygonPoses = 0;     ///< what the ways found is of all of them together
    std::vector<IntegrationPoint> integration;
    std::vector<std::string> notes;
    std::string disagreement; ///< of methods that must agree; empty: there is none
};

} // namespace voxtact::app
