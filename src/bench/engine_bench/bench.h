// SPDX-License-Identifier: MIT
#pragma once

#include "bench/engines/engine.h"
#include "io/text/table.h"

#include <iosfwd>

namespace voxtact::lab {

/// Measurements of engines by `voxtact bench`.
enum class BenchMode {
    Certified, ///< the certified answer compared with the view and FCL
    Outputs,   ///< cost of each projection and output, compared with the bare count
    Latency,   ///< latency of one pair in a loop that moves a mesh
    Batches,   ///< cost of a batch by its size
};

struct BenchSettings {
    BenchMode mode = BenchMode::Certified;
    std::uint32_t number = 256; ///< poses of each kind; ticks; pairs of the largest batch
    std::uint64_t seed = 1;
    std::uint32_t repetitions = 7; ///< not of ticks
    double timeLimit = 60;         ///< seconds of ticks and batches: fewer of them are taken where they do not fit
};

/// Defaults of a mode.
struct BenchDefaults {
    std::uint32_t number = 256;
    std::uint32_t repetitions = 7;
    const char* volume = "builtin:head:256"; ///< large, for engines that prune
    std::vector<std::string> meshes{"builtin:scalpel:3068"};
};
[[nodiscard]] BenchDefaults defaultsOf(BenchMode mode);
/// Default opacity for the voxels of such a volume.
inline constexpr const char* kDefaultOpacity = "40:0,80:1";

/// One engine on one set of pairs of one mesh. Samples are in the order of the rounds.
struct BenchRow {
    std::string mesh{};
    std::uint32_t triangles = 0;
    std::string poses{}; ///< "large", "onset"; empty of ticks and batches
    EngineFacts engine{};
    std::uint64_t pairs = 0;         ///< poses; of a batch
    std::uint64_t contacts = 0;      ///< certified
    std::uint64_t untouched = 0;     ///< also certified; the rest is undecided
    std::uint64_t missed = 0;        ///< of the contacts
    std::uint64_t wrong = 0;         ///< touches on poses that certainly do not touch
    std::uint64_t touching = 0;      ///< ticks with a touch
    std::uint64_t rounding = 0;      ///< pairs of all samples that the device's rasteriser counts otherwise than cpu
    std::vector<double> wall{};      ///< ms of a tick, from the pose to the answer; of a batch
    std::vector<double> gpu{};       ///< the device's part of a batch; empty where there is none
    std::vector<double> recording{}; ///< of a tick; empty without recording
    std::vector<double> wallRate{};  ///< pairs per second
    std::vector<double> cpuRate{};   ///< pairs per second of CPU time of the whole process
    std::vector<double> wallRatio{}; ///< to the reference engine's sample of the same round
    std::vector<double> cpuRatio{};
};

/// Results of a scene.
struct BenchResult {
    Machine machine;
    std::string volume;
    double threshold = 0;
    std::string opacity; ///< the control points, as --opacity takes them
    ValueRange domain;   ///< of the table
    std::uint32_t tableSize = 0;
    std::array<std::uint32_t, 3> voxels{};
    std::vector<std::string> notes;
    std::string disagreement; ///< of engines that must agree; empty: there is none
    std::vector<BenchRow> rows;
};

/// Engines side by side on each of the meshes, checked and timed, in the view. The volume and the meshes are made
/// ready; `session` may be null, and must outlive the parts. `result` has the machine.
///   certified, outputs  poses at random, and around the onset of contact; each engine is checked, then timed
///   latency             the ticks of a moving mesh. Each answer is held against the host's after its clock has stopped
///   batches             random poses, each batch a submission that is waited for or a call of the host; the answers of
///                       every one are held against the host's
[[nodiscard]] Result<void> bench(const BenchSettings& settings, const device::Session* session, VolumePart& volume,
                                 std::vector<MeshPart> meshes, const Steps& steps, BenchResult& result);

void writeBench(std::ostream& out, io::Format format, const BenchSettings& settings, const BenchResult& result);

} // namespace voxtact::lab
