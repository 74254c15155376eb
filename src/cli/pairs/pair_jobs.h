// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// The pairs of meshes and volumes of a run.
namespace voxtact::app {

/// Indices in the lists of PairJobs.
struct Job {
    std::uint32_t mesh = 0;
    std::uint32_t volume = 0;
};

/// All jobs of a run; lists each source once.
struct PairJobs {
    std::vector<std::string> meshes;
    std::vector<std::string> volumes;
    std::vector<Job> jobs; ///< in the order of the rows
};

/// Pairs every mesh with every volume: by volume, then by mesh.
[[nodiscard]] PairJobs allPairs(const std::vector<std::string>& meshes, const std::vector<std::string>& volumes);

} // namespace voxtact::app
