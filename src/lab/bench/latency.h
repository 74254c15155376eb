// SPDX-License-Identifier: MIT
#pragma once

#include "lab/bench/bench.h"

/// One pair, now: how long a loop that moves a mesh waits for its answer, tick by tick.
namespace voxtact::lab {

struct LatencySettings {
    std::uint32_t ticks = 10000;
    std::uint64_t seed = 1;
    double timeLimit = 60; ///< seconds of the ticks of all engines: each has an equal share
};

/// One engine with one mesh.
struct LatencyRow {
    std::string mesh{};
    std::uint32_t triangles = 0;
    EngineFacts engine{};
    std::vector<double> ticks{};     ///< µs each, from the pose to the answer
    std::vector<double> recording{}; ///< µs of it; empty where nothing is recorded
    std::uint64_t touching = 0;      ///< ticks whose answer is a hit
    std::uint64_t rounding = 0;      ///< ticks that the device's rasteriser counts otherwise than cpu
};

struct LatencyResult : BenchScene {
    std::vector<LatencyRow> rows;
};

/// What must be answered at a tick.
struct TickTruth {
    PairAnswer certified; ///< by the host: the count in the projection conservative
    PairAnswer view;      ///< the same in the view
    /// In the view by the device's rasteriser, all of whose methods must count the same: nothing until one has.
    std::optional<PairAnswer> raster{};
};

/// Fragments by which a rasteriser may count otherwise than the host, besides half of what the host counts.
inline constexpr std::uint64_t kRoundedFragments = 64;
/// Ticks of a measurement, at most: all their poses are held at once.
inline constexpr std::uint32_t kMostTicks = 10'000'000;

/// Whether an answer in the view is not the host's.
[[nodiscard]] bool differsByRounding(const PairAnswer& answer, const PairAnswer& host);
/// What is wrong with an answer, or nothing; `truth` learns what the rasteriser counts from the first method that does.
/// A certified answer must be the host's; those of a rasteriser must be each other's, and near the host's in the view.
[[nodiscard]] std::string judgeTick(const EngineFacts& engine, const PairAnswer& answer, TickTruth& truth);

/// An empty submission, the host, and every method of the device, polled and waited for: certified yes or no and count,
/// and the count in the view. `session` may be null.
[[nodiscard]] Result<Engines> makeLatencyEngines(const device::Session* session);

/// Engines one after the other on the ticks of a moving mesh, in the view. Each tick's answer is held against the
/// host's after its clock has stopped. The volume and the meshes are made ready; `session` may be null, and must
/// outlive the parts.
[[nodiscard]] Result<void> measureLatency(const LatencySettings& settings, const device::Session* session,
                                          VolumePart& volume, std::vector<MeshPart> meshes, const Steps& steps,
                                          LatencyResult& result);

void writeLatency(std::ostream& out, io::Format format, const LatencySettings& settings, const LatencyResult& result);

} // namespace voxtact::lab
