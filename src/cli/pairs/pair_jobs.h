// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// The pairs of meshes and volumes of a run.
namespace voxtact::app {

/// Numbers in the lists of PairJobs.
struct Job {
    std::uint32_t mesh = 0;
    std::uint32_t volume = 0;
};

/// Each source is in its list once.
struct PairJobs {
    std::vector<std::string> meshes;
    std::vector<std::string> volumes;
    std::vector<Job> jobs; ///< in the order of the rows
};

/// Returns every mesh against every volume: by volume, then by mesh.
[[nodiscard]] PairJobs allPairs(const std::vector<std::string>& meshes, const std::vector<std::string>& volumes);

} // namespace voxtact::app
