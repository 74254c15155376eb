// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

/// Which mesh at which poses is put to which volume.
namespace voxtact::app {

/// Numbers in the lists of PairJobs.
struct Job {
    std::uint32_t mesh = 0;
    std::uint32_t volume = 0;
    std::uint32_t poses = 0;
};

/// Each source stands once in its list, however many jobs have it.
struct PairJobs {
    std::vector<std::string> meshes;
    std::vector<std::string> volumes;
    std::vector<std::filesystem::path> poses; ///< an empty one: the identity
    std::vector<Job> jobs;                    ///< in the order of the rows
    bool fromFile = false;

    /// How often a file of poses is gone through.
    [[nodiscard]] std::size_t uses(std::uint32_t poses) const;
};

/// Every mesh against every volume, at the poses of one file: by volume, then by mesh.
[[nodiscard]] PairJobs allPairs(const std::vector<std::string>& meshes, const std::vector<std::string>& volumes,
                                const std::filesystem::path& poses);
/// A CSV file with one job per line, `mesh,volume,poses`, the last may be left out; a first line with these names,
/// empty lines and lines that begin with `#` are skipped. Paths are as on the command line.
[[nodiscard]] Result<PairJobs> readJobs(const std::filesystem::path& path);

} // namespace voxtact::app
