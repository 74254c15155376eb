// SPDX-License-Identifier: MIT
#pragma once

#include "io/text/table.h"
#include "lab/engines/engine.h"

#include <iosfwd>

namespace voxtact::lab {

/// What `voxtact bench` can measure of engines.
enum class BenchMode {
    Certified, ///< the certified answer beside the view and FCL
    Outputs,   ///< what each projection and each output costs beside the bare count
    Latency,   ///< one pair, now: latency.h
    Batches,   ///< what a batch costs by its size: batches.h
};

struct BenchSettings {
    BenchMode mode = BenchMode::Certified;
    std::uint32_t poses = 256;
    std::uint64_t seed = 1;
    std::uint32_t repetitions = 7;
};

/// The scene of a mode where none was asked for: its volume and how many voxels of it are opaque, and its meshes.
[[nodiscard]] const char* defaultVolume(BenchMode mode);
[[nodiscard]] std::vector<std::string> defaultMeshes(BenchMode mode);
inline constexpr const char* kDefaultOpacity = "40:0,80:1";

/// One engine on one set of poses of one mesh.
struct BenchRow {
    std::string mesh{};
    std::uint32_t triangles = 0;
    std::string poses{}; ///< "large", "onset"
    EngineFacts engine{};
    std::uint64_t pairs = 0;
    std::uint64_t contacts = 0;      ///< certified
    std::uint64_t untouched = 0;     ///< certified too; the rest is possible
    std::uint64_t missed = 0;        ///< of the contacts
    std::uint64_t wrong = 0;         ///< hits where certainly nothing touches
    std::vector<double> wallRate{};  ///< pairs a second, a sample each
    std::vector<double> cpuRate{};   ///< pairs a second of CPU time of the whole process
    std::vector<double> wallRatio{}; ///< to the first engine's sample of the same round
    std::vector<double> cpuRatio{};
};

/// What was measured on which scene, whatever was measured.
struct BenchScene {
    Machine machine;
    std::string volume;
    double threshold = 0;
    std::array<std::uint32_t, 3> voxels{};
    std::vector<std::string> notes;
    std::string disagreement; ///< of engines that must agree; empty: there is none
};

struct BenchResult : BenchScene {
    std::vector<BenchRow> rows;
};

/// Counts in `row` what its engine misses and has too much. Returns where it differs though it must agree, or nothing.
[[nodiscard]] std::string judgeEngine(std::span<const PairAnswer> certified, std::span<const PairAnswer> answers,
                                      BenchRow& row);

/// The engines of a mode for this volume and mesh, which must be ready and outlive them. For certified the first is the
/// host's yes or no on one thread, the second the host's count; for outputs the first is the host's count in the view,
/// the second the host's in the projection conservative. `session` may be null: no engines of a device.
[[nodiscard]] Result<Engines> makeBenchEngines(BenchMode mode, const VolumePart& volume, const MeshPart& mesh,
                                               const device::Session* session);

/// Engines side by side on each of the meshes, checked and timed, in the view. The volume and the meshes are made
/// ready; `session` may be null, and must outlive the parts. `result` has the machine.
[[nodiscard]] Result<void> bench(const BenchSettings& settings, const device::Session* session, VolumePart& volume,
                                 std::vector<MeshPart> meshes, const Steps& steps, BenchResult& result);

void writeBench(std::ostream& out, io::Format format, const BenchSettings& settings, const BenchResult& result);

} // namespace voxtact::lab
