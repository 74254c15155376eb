// SPDX-License-Identifier: MIT
#pragma once

#include "cpu/judges/quad_judge.h"
#include "support/host_meters.h"
#include "voxtact/cpu.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace voxtact::test {

/// A pair that is as near to a tie as its numbers allow: spikes of one entry, thresholds a unit in the last place from
/// an entry, domains of 1e-30, vertices at voxels' centres and faces and a unit beside them, slivers, far origins,
/// triangles in faces and edges of the domain, grids along the world's axes, flipped, anisotropic and oblique.
struct ExtremeCase {
    VolumeData volume;
    MeshData mesh;
    Mat4 world_from_object{};
    std::vector<ControlPoint> points;
    ValueRange domain;
    std::uint32_t tableSize = 0;
    double threshold = 0;
};

/// The same case for the same numbers.
[[nodiscard]] ExtremeCase makeExtremeCase(std::uint64_t seed, std::uint64_t number);

/// What the host engine was found to say of cases, compared with the judge.
struct ExtremeTally {
    std::uint64_t touches = 0;  ///< certain, and right
    std::uint64_t none = 0;     ///< certain, and right
    std::uint64_t possible = 0; ///< where the judge knows
    std::uint64_t unjudged = 0; ///< the judge does not know
    std::uint64_t wrong = 0;
    std::vector<std::string> complaints; ///< of the wrong ones, the first few
};

/// Asks the engine and judges it. Two questions a case, yes or no and the count, which must agree. One object a thread.
class ExtremeTrial {
  public:
    ExtremeTrial();
    void run(std::uint64_t seed, std::uint64_t number);
    [[nodiscard]] const ExtremeTally& tally() const noexcept { return tally_; }

  private:
    cpu::Detector yesNo_;
    cpu::Detector count_;
    ExtremeTally tally_;
};

} // namespace voxtact::test
