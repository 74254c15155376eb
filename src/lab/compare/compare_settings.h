// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"
#include "voxtact/methods.h"

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace voxtact::lab {

/// What grows from point to point; each is a chart of the report.
enum class Sweep { Batch, Triangles, Fragments, Voxels };
inline constexpr std::array<Sweep, 4> kSweeps{Sweep::Batch, Sweep::Triangles, Sweep::Fragments, Sweep::Voxels};
[[nodiscard]] const char* toString(Sweep sweep) noexcept;

/// How the data that options name get here: a path, or builtin:NAME.
struct Loaders {
    std::function<Result<VolumeData>(const std::string& source)> volume;
    std::function<Result<MeshData>(const std::string& source)> mesh;
};

/// What `voxtact compare` measures, and how long.
struct CompareSettings {
    std::vector<CountingMethod> methods; ///< empty: every one
    std::uint32_t oraclePoses = 32;
    std::vector<Sweep> sweeps;
    std::uint32_t repeats = 7;
    double timeLimit = 15; ///< seconds, of each sweep
    bool keepGoing = false;
    Loaders load; ///< for the sweeps of triangles and voxels

    [[nodiscard]] bool wants(CountingMethod method) const;
};

} // namespace voxtact::lab
