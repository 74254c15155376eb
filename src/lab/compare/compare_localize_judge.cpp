// SPDX-License-Identifier: MIT
#include "lab/compare/compare_localize.h"

#include <algorithm>
#include <iterator>

namespace voxtact::lab {

namespace {

bool before(const TouchedTriangle& a, const TouchedTriangle& b) {
    return a.triangle < b.triangle;
}

/// Counts what each way misses and has too much, against the certified set.
void holdAgainstCertified(LocalizeResult& result) {
    const LocalizeWay& certified = result.ways.back();
    for (LocalizeWay& way : result.ways) {
        for (std::size_t pose = 0; pose < way.found.size(); ++pose) {
            std::vector<TouchedTriangle> both;
            std::ranges::set_intersection(certified.found[pose], way.found[pose], std::back_inserter(both), before);
            way.missed += certified.found[pose].size() - both.size();
            way.wrong += way.found[pose].size() - both.size();
        }
    }
}

std::string textOf(const std::vector<TouchedTriangle>& found, std::uint32_t triangle) {
    const auto at = std::ranges::lower_bound(found, triangle, {}, &TouchedTriangle::triangle);
    return std::to_string(at == found.end() || at->triangle != triangle ? 0 : at->count);
}

/// The first pose and triangle on which a way of the view has other fragments than the first of them.
void findDisagreement(LocalizeResult& result) {
    const LocalizeWay& first = result.ways.front();
    for (std::size_t pose = 0; pose < first.found.size(); ++pose) {
        for (const LocalizeWay& way : result.ways) {
            if (!way.byView || !way.unchecked.empty()) {
                continue;
            }
            std::vector<TouchedTriangle> apart;
            std::ranges::set_symmetric_difference(first.found[pose], way.found[pose], std::back_inserter(apart),
                                                  [](const TouchedTriangle& a, const TouchedTriangle& b) {
                                                      return std::pair(a.triangle, a.count) <
                                                             std::pair(b.triangle, b.count);
                                                  });
            if (apart.empty()) {
                continue;
            }
            const std::uint32_t triangle = apart.front().triangle;
            result.failedPose = result.poseNumbers[pose];
            result.failure = "triangle " + std::to_string(triangle) + ": " + first.name + " " +
                             textOf(first.found[pose], triangle) + ", " + way.name + " " +
                             textOf(way.found[pose], triangle) + " fragments";
            return;
        }
    }
}

} // namespace

void judgeLocalize(LocalizeResult& result) {
    holdAgainstCertified(result);
    findDisagreement(result);
}

std::string disagreementOf(const LocalizeResult& result) {
    return result.failedPose ? "polygon = leaf = leaf-bricks = fragments: disagreement on pose " +
                                   std::to_string(*result.failedPose) + ": " + result.failure
                             : std::string();
}

} // namespace voxtact::lab
