// SPDX-License-Identifier: MIT
#include "cli/pairs/pair_jobs.h"

#include <algorithm>

namespace voxtact::app {

namespace {

/// Returns the index of `value` in `list`; appends a new value.
std::uint32_t numberIn(std::vector<std::string>& list, const std::string& value) {
    const auto found = std::ranges::find(list, value);
    const auto number = static_cast<std::uint32_t>(found - list.begin());
    if (found == list.end()) {
        list.push_back(value);
    }
    return number;
}

} // namespace

PairJobs allPairs(const std::vector<std::string>& meshes, const std::vector<std::string>& volumes) {
    PairJobs jobs;
    for (const std::string& volume : volumes) {
        for (const std::string& mesh : meshes) {
            jobs.jobs.push_back({numberIn(jobs.meshes, mesh), numberIn(jobs.volumes, volume)});
        }
    }
    return jobs;
}

} // namespace voxtact::app
