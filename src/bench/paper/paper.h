// SPDX-License-Identifier: MIT
#pragma once

#include "bench/compare/localize.h"
#include "voxtact/render.h"

#include <algorithm>
#include <filesystem>
#include <optional>

/// Results of `voxtact bench --paper`: the measurements of the paper (Volume-Surface Collision Detection, Tables 1 and
/// 2), repeated.
namespace voxtact::lab {

/// The paper's own measurements, on its hardware (OpenGL), without viewport, ray step or number of samples.
namespace published {
/// A line of Table 1 or 2: average ms per frame.
struct TableLine {
    int table = 0; ///< 1 or 2, see kHardware
    const char* scene = nullptr;
    double mesh = 0;
    double volume = 0;
    double collision = 0;
    double rendering = 0;
    double total = 0;
    double overhead = 0; ///< percent: collision / rendering
};
/// As printed, with errors: the total of Table 1, v2s2 repeats the rendering (it should be 6.083), and the overhead of
/// Table 2, v2s1 is 15.8 by its own columns.
inline constexpr std::array<TableLine, 8> kTables{{
    {1, "v1s1", 0.043, 5.793, 0.502, 5.835, 6.337, 8.6},
    {1, "v1s2", 0.356, 5.793, 0.789, 6.148, 6.937, 12.8},
    {1, "v2s1", 0.027, 4.983, 0.481, 5.01, 5.491, 9.6},
    {1, "v2s2", 0.343, 4.983, 0.758, 5.325, 5.325, 14.2},
    {2, "v1s1", 0.381, 1.811, 0.334, 2.192, 2.526, 15.2},
    {2, "v1s2", 4.324, 1.811, 0.272, 6.134, 6.407, 4.4},
    {2, "v2s1", 0.447, 1.688, 0.338, 2.135, 2.473, 15.9},
    {2, "v2s2", 4.452, 1.688, 0.262, 6.1394, 6.401, 4.3},
}};
inline constexpr std::array<const char*, 2> kHardware{"Core 2 Quad 2.4 GHz, Quadro FX 3700, Windows XP",
                                                      "Core i3 3.07 GHz, GeForce GTX 470, Windows 7"};
inline constexpr ValueRange kOverhead{
    std::ranges::min_element(kTables, {}, &TableLine::overhead)->overhead,
    std::ranges::max_element(kTables, {}, &TableLine::overhead)->overhead}; ///< percent, over its scenes
inline constexpr double kPairsPerSecond = 3800;
inline constexpr double kIntegrationMilliseconds = 40; ///< the pre-integrated table, 256x256
} // namespace published

/// Settings of `voxtact bench --paper`. By default every pose is timed, with enough samples for an interval of 95 %.
struct PaperSettings {
    std::uint32_t poses = 7; ///< of a scene
    std::uint64_t seed = 1;
    std::uint32_t repetitions = 7;
    std::filesystem::path data; ///< a folder with the files of the scenes; empty: builtins
    std::uint32_t scale = 1;    ///< the sides of its builtin volumes are divided by it
    bool noSweeps = false;      ///< the tables alone
    VkExtent2D size{512, 512};  ///< of frames
    double timeLimit = 240;     ///< seconds for all samples: fewer than `repetitions` are taken where they do not fit
    Loaders load;
};

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

/// Time of detection relative to rendering, percent, like in the paper. A sample per round; none if one of the times is
/// unknown.
[[nodiscard]] std::vector<double> collisionPercent(const PaperColumns& columns);
/// Increase of a frame's time by detection, percent. A sample per round, from its two frames.
[[nodiscard]] std::vector<double> overheadPercent(const PaperColumns& columns);

/// A line of the tables: a counting method in a scene.
struct PaperRow {
    std::size_t scene = 0; ///< number in PaperResult::scenes
    std::string method{};
    std::optional<double> survivors; ///< of a pair, on average over the poses; none of query-any, which counts none
    std::uint32_t hits = 0;
    PaperColumns gpu{};  ///< timestamps
    PaperColumns wall{}; ///< from submission to the end of the wait; `mesh` and `volume` are empty
};

/// The clocks, by their names in CSV and JSON.
struct PaperClock {
    const char* name;
    const char* words;
    const char* title;
    PaperColumns PaperRow::*columns;
};
inline constexpr std::array<PaperClock, 2> kPaperClocks{
    {{"gpu", "by GPU timestamps", "By GPU timestamps", &PaperRow::gpu},
     {"wall", "by wall clock", "By wall clock, from the submission to the end of the wait", &PaperRow::wall}}};

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
    std::vector<MethodEntry> methods;
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

/// The paper's tables and sweeps. `result` has the provenance of its machine.
[[nodiscard]] Result<void> measurePaper(const PaperSettings& settings, const device::Session& session,
                                        const Steps& steps, PaperResult& result);

/// Minimum confidence of the intervals of medians.
inline constexpr double kConfidence = 0.95;

/// Formats the median overhead of detection, percent: "2.6", or "noise" if it is below 0, and its interval, if there
/// are enough samples. Expects at least one sample.
[[nodiscard]] std::string overheadText(const std::vector<double>& percents);

/// Returns the results as sentences: the agreement, then the overhead of detection, then the rest.
[[nodiscard]] std::vector<std::string> paperSummary(const PaperResult& result);
/// The whole result as one object.
[[nodiscard]] nlohmann::ordered_json paperJson(const PaperResult& result);
/// CSV: a row for each scene, method and clock, and everything else in comments. Text: tables like the paper's.
void writePaper(std::ostream& out, io::Format format, const PaperResult& result);

} // namespace voxtact::lab
