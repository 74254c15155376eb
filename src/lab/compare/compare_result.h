// SPDX-License-Identifier: MIT
#pragma once

#include "lab/compare/compare_agreement.h"
#include "lab/compare/compare_settings.h"
#include "lab/engines/engine.h"
#include "lab/measure/machine.h"

#include <optional>

namespace voxtact::lab {

/// Repeated measurements of one thing.
struct Spread {
    double median = 0;
    double min = 0;
    double max = 0;
    double p10 = 0;
    double p90 = 0;
};

/// Linear between the two nearest ranks. `samples` must not be empty.
[[nodiscard]] Spread spreadOf(std::vector<double> samples);

/// Where the median of the distribution that samples come from is, whatever that distribution is.
struct MedianInterval {
    double low = 0;
    double high = 0;
    double confidence = 0; ///< reached, 0..1: at least what was asked for
};

/// From the smallest interval between two samples of mirrored ranks whose confidence, by the sign test, is
/// `confidence`. Nothing where there are too few samples: six for 0.95.
[[nodiscard]] std::optional<MedianInterval> medianInterval(std::vector<double> samples, double confidence);

/// How pairs reach the method: each submitted and waited for alone (the paper's way), or batches in flight.
enum class Mode { Sync, Pipelined };
[[nodiscard]] const char* toString(Mode mode) noexcept;

/// The times of one method at one point of a sweep.
struct Series {
    Sweep sweep = Sweep::Batch;
    std::string method;
    Mode mode = Mode::Sync;
    std::uint32_t batch = 1; ///< the times are of so many pairs
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t triangles = 0;
    std::uint32_t pairs = 0;         ///< measured in a sample
    std::optional<double> fragments; ///< survivors of a pair, on average
    std::vector<double> wall;        ///< ms of a batch, a sample each
    std::vector<double> gpu;         ///< the same; empty where there is no GPU time
    std::array<std::uint32_t, 3> voxels{};

    [[nodiscard]] double pairsPerSecond() const;
    [[nodiscard]] std::optional<double> fragmentsPerSecond() const;
};

/// "181x217x181"
[[nodiscard]] std::string sizeText(const std::array<std::uint32_t, 3>& voxels);

struct MethodEntry {
    std::string name;
    bool available = true;
    std::string reason; ///< why not
    std::string filter;
    bool exact = true; ///< false: zero or not zero
};

/// Everything that the outputs say.
struct CompareResult {
    Machine machine;
    std::vector<MethodEntry> methods;
    std::vector<std::uint32_t> poseNumbers;
    std::vector<NamedCounts> counts;
    std::vector<Verdict> verdicts;
    std::vector<FragmentCheck> fragmentChecks;
    std::optional<double> oracleMilliseconds; ///< of a pose, on average
    std::vector<Series> series;
    std::vector<std::string> notes;
    std::uint32_t triangles = 0;

    [[nodiscard]] const Verdict* firstFailure() const;
};

/// An engine for each method that is wanted and can be had; the others are told in `result`. Unsupported where there is
/// none.
[[nodiscard]] Result<Engines> makeMethodEngines(const Session& session, const CompareSettings& settings,
                                                CompareResult& result);

} // namespace voxtact::lab
