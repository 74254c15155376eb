// SPDX-License-Identifier: MIT
#pragma once

#include "bench/compare/compare.h"
#include "io/text/table.h"

#include <iosfwd>

namespace voxtact::lab {

/// One method to find touched triangles, over all poses.
struct LocalizeWay {
    std::string name;
    std::string unchecked{}; ///< why it was not run; empty: it was
    bool byView = true;      ///< finds visible triangles, on which all such methods must agree
    std::vector<std::vector<TouchedTriangle>> found{}; ///< of each pose, by triangle
    std::uint64_t triangles = 0;                       ///< found
    std::uint64_t missed = 0;                          ///< certified, and not found
    std::uint64_t wrong = 0;                           ///< found, and not certified
    std::optional<std::uint64_t> queries{};
    std::optional<std::uint64_t> boxes{}; ///< nodes of the tree that were tested
    std::vector<double> wall{};           ///< ms of a pair, one a pose and round
    std::vector<double> gpu{};            ///< the same; empty where there is no GPU time
};

/// A triangle that a way found and that is not certified.
struct WrongTriangle {
    std::uint32_t pose = 0;
    std::uint32_t triangle = 0;
    std::uint32_t fragments = 0;
    std::string certified; ///< certified verdict: "possible", or "none", which rounding must explain
};

struct LocalizeResult {
    Machine machine;
    std::vector<std::uint32_t> poseNumbers;
    std::vector<LocalizeWay> ways; ///< the last is `certified`
    std::vector<WrongTriangle> wrong;
    CompareVerdict verdict{.rule = "polygon = leaf = leaf-bricks = fragments"}; ///< of the ways of the view
    std::vector<std::string> notes;
};

/// Every way on every pose of the scene, in `settings.repeats` rounds as far as they fit in `settings.timeLimit`, and
/// what follows from what they found. `step` is called for each pose of a round. `result` has the machine.
[[nodiscard]] Result<void> localize(const device::Session& session, const CompareSettings& settings, const Scene& scene,
                                    LocalizeResult& result, const std::function<void(std::uint64_t)>& step);

/// Fills the derived results: missed and false triangles, and the agreement of the methods of the view.
void judgeLocalize(LocalizeResult& result);

void writeLocalize(std::ostream& out, io::Format format, const Scene& scene, const LocalizeResult& result);

} // namespace voxtact::lab
