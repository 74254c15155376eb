// SPDX-License-Identifier: MIT
#pragma once

#include "bench/compare/agreement.h"
#include "bench/engines/engine.h"

namespace voxtact::lab {

/// The quantity of a sweep; each is a chart of the report.
enum class Sweep { Batch, Triangles, Fragments, Voxels };
inline constexpr std::array<Sweep, 4> kSweeps{Sweep::Batch, Sweep::Triangles, Sweep::Fragments, Sweep::Voxels};
[[nodiscard]] const char* toString(Sweep sweep) noexcept;

/// Settings of `voxtact compare`.
struct CompareSettings {
    std::vector<CountingMethod> methods{}; ///< empty: every one
    std::uint32_t oraclePoses = 32;
    std::vector<Sweep> sweeps{};
    std::uint32_t repeats = 7;
    double timeLimit = 15; ///< seconds, of each sweep
    bool keepGoing = false;
    Loaders load{}; ///< for the sweeps of triangles and voxels
};

/// Submission of pairs: each submitted and waited for alone (like the paper), or batches in flight.
enum class Mode { Sync, Pipelined };
[[nodiscard]] const char* toString(Mode mode) noexcept;

/// The times of one method at one point of a sweep.
struct Series {
    Sweep sweep = Sweep::Batch;
    std::string method{};
    Mode mode = Mode::Sync;
    std::uint32_t batch = 1; ///< number of pairs per time
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t triangles = 0;
    std::uint32_t pairs = 0;           ///< of a sample, the same for all methods; fast ones take them more than once
    std::optional<double> fragments{}; ///< passing fragments of a pair, on average
    std::vector<double> wall{};        ///< ms of a batch, a sample each
    std::vector<double> gpu{};         ///< the same; empty where there is no GPU time
    std::array<std::uint32_t, 3> voxels{};

    /// Empty if the clock stood still.
    [[nodiscard]] std::optional<double> pairsPerSecond() const;
    [[nodiscard]] std::optional<double> fragmentsPerSecond() const;
    /// Returns true if it answers more than yes or no, and is no oracle.
    [[nodiscard]] bool counts() const;
};
/// Without times, of a method at a work.
[[nodiscard]] Series seriesOf(Sweep sweep, const std::string& method, const Work& work, Mode mode, std::uint32_t batch);
/// The fastest that counts, of those that `wanted` accepts; null where there is none.
[[nodiscard]] const Series* fastestOf(std::span<const Series> all, const std::function<bool(const Series&)>& wanted);

/// The series, and the counts, of the oracle.
inline constexpr const char* kOracle = "oracle";

struct MethodEntry {
    std::string name;
    bool available = true;
    std::string reason; ///< why not
    std::string filter;
    bool exact = true;      ///< false: zero or not zero
    bool trusted = true;    ///< the self-test's verdict; always of cpu
    std::string selfTest{}; ///< result of its self-test; empty for cpu
};

/// Everything that the outputs say.
struct CompareResult {
    Machine machine;
    std::vector<MethodEntry> methods;
    std::vector<std::uint32_t> poseNumbers;
    std::vector<NamedCounts> counts;
    std::vector<CompareVerdict> verdicts;
    std::vector<FragmentCheck> fragmentChecks;
    std::optional<double> oracleMilliseconds; ///< of a pose, on average
    std::vector<Series> series;
    std::vector<std::string> notes;

    [[nodiscard]] const CompareVerdict* firstFailure() const;
    /// Returns true if the rules hold; empty if nothing was compared.
    [[nodiscard]] std::optional<bool> agrees() const;
};

/// Verifies, then times the same pairs by every method; a failed verdict ends the run unless it is to go on. `result`
/// has the machine.
[[nodiscard]] Result<void> compare(const CompareSettings& settings, const Scene& scene, const device::Session& session,
                                   const Steps& steps, CompareResult& result);

/// Returns an engine per requested and supported method; lists the others in `result`. Returns Unsupported if there is
/// none.
[[nodiscard]] Result<Engines> makeMethodEngines(const device::Session& session, const CompareSettings& settings,
                                                CompareResult& result);
/// Asks the self-test, as `voxtact devices` does, which of the methods can be trusted; a note of each that cannot.
[[nodiscard]] Result<void> addTrust(const device::Session& session, std::vector<MethodEntry>& methods,
                                    std::vector<std::string>& notes);
/// Counts every pose by every method.
[[nodiscard]] Result<std::vector<NamedCounts>> countAll(const Engines& engines, const Work& work);

/// State of a comparison: inputs, engines, and destination of the results.
struct CompareRun {
    const device::Session& session;
    const CompareSettings& settings;
    const Scene& scene;
    const Engines& engines;
    CompareResult& result;
    const std::function<void(std::uint64_t)>& step;

    /// Returns true if a verdict failed, which ends the run.
    [[nodiscard]] bool ended() const { return result.firstFailure() != nullptr && !settings.keepGoing; }
};

/// Counts every pose by every method, and judges the counts.
[[nodiscard]] Result<void> checkCounts(const CompareRun& run);

/// The sample of methods that are timed on the same poses.
struct SampleSize {
    std::size_t batches = 1;           ///< of which it is, for all of them
    std::vector<std::size_t> passes{}; ///< repetitions of each, so that no sample is too short; 0: not timed
};
/// `milliseconds`: of a batch by each, kNoLimit for one that is not timed; `most`: of a sample; of `all` batches.
[[nodiscard]] SampleSize sampleSize(std::span<const double> milliseconds, double most, std::size_t all);

/// Times one sweep and adds its series to the result. Batches are of the scene; the others verify the counts of each
/// point first, and time nothing where they are wrong and the run is not to go on:
///   triangles  builtin meshes of several sizes; another mesh is told in the notes
///   fragments  viewports of several sizes
///   voxels     a builtin volume of half to twice as many voxels per side; another volume is told in the notes, and so
///              are sizes that the device or the builtin cannot have. Mesh, poses, camera and transfer function stay.
[[nodiscard]] Result<void> timeSweep(const CompareRun& run, Sweep sweep);
/// Steps of a sweep.
[[nodiscard]] std::uint64_t stepsOf(Sweep sweep, std::uint32_t repeats) noexcept;

} // namespace voxtact::lab
