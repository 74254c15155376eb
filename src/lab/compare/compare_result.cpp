// SPDX-License-Identifier: MIT
#include "lab/compare/compare_result.h"

#include "core/try.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace voxtact::lab {

namespace {

double quantile(const std::vector<double>& sorted, double part) {
    const double at = part * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(std::floor(at));
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (sorted[above] - sorted[below]) * (at - std::floor(at));
}

} // namespace

Spread spreadOf(std::vector<double> samples) {
    std::sort(samples.begin(), samples.end());
    return {.median = quantile(samples, 0.5),
            .min = samples.front(),
            .max = samples.back(),
            .p10 = quantile(samples, 0.1),
            .p90 = quantile(samples, 0.9)};
}

std::optional<MedianInterval> medianInterval(std::vector<double> samples, double confidence) {
    std::sort(samples.begin(), samples.end());
    const auto count = static_cast<double>(samples.size());
    std::optional<MedianInterval> interval;
    // Each sample is below the median with probability 1/2. `beyond`: that at most `rank` of them are. Logarithms,
    // because the first of these probabilities is too small for a double where there are a thousand samples.
    double logarithm = -count * std::log(2.0);
    double beyond = std::exp(logarithm);
    for (std::size_t rank = 0; 2 * rank + 1 < samples.size() && 1 - 2 * beyond >= confidence; ++rank) {
        interval = {samples[rank], samples[samples.size() - 1 - rank], 1 - 2 * beyond};
        const auto at = static_cast<double>(rank);
        logarithm += std::log((count - at) / (at + 1));
        beyond += std::exp(logarithm);
    }
    return interval;
}

const char* toString(Mode mode) noexcept {
    return mode == Mode::Sync ? "sync" : "pipelined";
}

double Series::pairsPerSecond() const {
    const double median = wall.empty() ? 0 : spreadOf(wall).median;
    return median > 0 ? 1000.0 * batch / median : 0;
}

std::optional<double> Series::fragmentsPerSecond() const {
    return fragments ? std::optional(pairsPerSecond() * *fragments) : std::nullopt;
}

std::string sizeText(const std::array<std::uint32_t, 3>& voxels) {
    return std::to_string(voxels[0]) + "x" + std::to_string(voxels[1]) + "x" + std::to_string(voxels[2]);
}

Result<Engines> makeMethodEngines(const Session& session, const CompareSettings& settings, CompareResult& result) {
    Engines engines;
    std::map<CountingMethod, std::string> reasons;
    const std::vector<CountingMethod> available = availableMethods(
        session, [&](CountingMethod method, const std::string& reason) { reasons.emplace(method, reason); });
    for (const CountingMethod method : countingMethods()) {
        if (!settings.wants(method)) {
            continue;
        }
        const auto reason = reasons.find(method);
        const bool there = reason == reasons.end();
        result.methods.push_back({toString(method), there, there ? "" : reason->second, toString(defaultFilter(method)),
                                  exactness(method) == Exactness::Exact});
        if (!there) {
            result.notes.push_back(std::string("no ") + toString(method) + " on this device: " + reason->second);
            continue;
        }
        MadeEngine engine = makeMethodEngine(session, method);
        VOXTACT_TRY(engine);
        engines.push_back(std::move(*engine));
    }
    if (engines.empty()) {
        return Error{ErrorCode::Unsupported, 0,
                     "none of the methods can be had: " + result.notes.front() + "; see voxtact devices"};
    }
    return engines;
}

const Verdict* CompareResult::firstFailure() const {
    const auto found = std::find_if(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return v.failed(); });
    return found == verdicts.end() ? nullptr : &*found;
}

} // namespace voxtact::lab
