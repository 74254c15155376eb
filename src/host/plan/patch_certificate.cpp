// SPDX-License-Identifier: MIT
#include "host/plan/patch_certificate.h"

#include <algorithm>
#include <cmath>

namespace voxtact::cpu {

namespace {

constexpr double kNearlyRightAngle = 1.5; // radians, rounded down: of cones of DirectionGrid::cone()
/// A patch that is not soon proven safe is halved, which makes the proof easier.
constexpr std::uint64_t kSoon = 200;
constexpr std::uint64_t kMost = 5000; // of a cell, which is never halved
/// Relative to the spread of a patch's paths: smaller boxes are not divided.
constexpr double kFinestPart = 1.0 / 8;

} // namespace

template <class Visit> void PatchCertificate::forTriangles(const DirectionPatch& patch, const Visit& visit) const {
    for (std::uint32_t i = patch.lo[0]; i < patch.hi[0]; ++i) {
        for (std::uint32_t j = patch.lo[1]; j < patch.hi[1]; ++j) {
            for (std::uint32_t which = 0; which < 2; ++which) {
                const std::uint32_t place = places_.at(patch.rhombus, i, j, which);
                if (place != TrianglePlaces::kNone) {
                    visit(scene_.grid.triangles(patch.rhombus, i, j)[which], place);
                }
            }
        }
    }
}

PatchCertificate::Contents PatchCertificate::contentsOf(const DirectionPatch& patch) const {
    Contents out;
    forTriangles(patch, [&](const std::array<std::uint32_t, 3>& corners, std::uint32_t /*place*/) {
        bool safe = true;
        for (const std::uint32_t corner : corners) {
            out.longest = std::max(out.longest, paths_[corner]->length);
            safe = safe && paths_[corner]->safety == Safety::Safe;
        }
        out.some = out.some || safe;
        out.all = out.all && safe;
    });
    return out;
}

Sweep PatchCertificate::sweepOf(const DirectionCone& cone) const {
    Sweep sweep;
    sweep.turn = cone.angle;
    sweep.centre = glm::dvec3(scene_.task.target[0], scene_.task.target[1], scene_.task.target[2]);
    sweep.slack = scene_.slack;
    return sweep;
}

/// Returns true if all paths in the patch, from entries up to the longest, keep clear. Tests the pairs that an
/// enclosing patch left open; `open` receives those that this one leaves.
bool PatchCertificate::isApart(const DirectionPatch& patch, double longest, Open& open) {
    const DirectionCone cone = scene_.grid.cone(patch);
    if (!(cone.angle < kNearlyRightAngle)) {
        return false;
    }
    const bool last = patch.cells(0) == 1 && patch.cells(1) == 1;
    const double end = scene_.axisEnd(longest);
    const Sweep sweep = sweepOf(cone);
    const double wanted = scene_.margin + scene_.radius;
    const SearchGoal goal{.tolerance = 0,
                          .maximum = wanted + 2 * scene_.slack,
                          .enough = last ? -1 : wanted,
                          .finest = std::max(kDefaultTolerance, kFinestPart * cone.angle * end),
                          .maxSteps = last ? kMost : kSoon,
                          .coarsely = true};
    bool apart = true;
    for (std::size_t i = 0; i < scene_.obstacles.size(); ++i) {
        const Obstacle& of = scene_.obstacles[i];
        const BatchItem item{&scene_.axis, of.given->volume, nullptr, {}};
        const Found found = PairAt{item, *of.part, scene_.axisPose(cone.axis, longest), &scene_.cancel}.search(
            memory_, of.searched(), goal, sweep, open[i].get());
        if (found.lo < goal.maximum) {
            apart = false;
        }
        open[i] = std::make_shared<const OpenPairs>(memory_.search.left());
    }
    return apart;
}

void PatchCertificate::certify(const DirectionPatch& patch, Open open, std::vector<EntryTriangle>& triangles) {
    const Contents contents = contentsOf(patch);
    if (!contents.some || scene_.givenUp()) {
        return;
    }
    if (contents.all && isApart(patch, contents.longest, open)) {
        forTriangles(patch, [&](const auto& /*corners*/, std::uint32_t place) { triangles[place].safe = true; });
        return;
    }
    const std::size_t axis = patch.cells(0) >= patch.cells(1) ? 0 : 1;
    if (patch.cells(axis) == 1) {
        return;
    }
    DirectionPatch first = patch;
    DirectionPatch second = patch;
    first.hi[axis] = second.lo[axis] = patch.lo[axis] + patch.cells(axis) / 2;
    certify(first, open, triangles);
    certify(second, std::move(open), triangles);
}

/// The upper bound of the search is approximate for rotated objects and only ends the search; the lower bound accounts
/// for the pairs that it prunes.
double PatchCertificate::clearanceOf(const DirectionPatch& cell, double longest, double most) {
    const DirectionCone cone = scene_.grid.cone(cell);
    if (!(cone.angle < kNearlyRightAngle)) {
        return 0;
    }
    const Sweep sweep = sweepOf(cone);
    const double off = scene_.radius + 2 * scene_.slack;
    const double fine = std::max(scene_.task.tolerance, kFinestPart * cone.angle * scene_.axisEnd(longest));
    double clearance = most;
    for (std::size_t i = 0; i < scene_.obstacles.size() && clearance > 0; ++i) {
        const Obstacle& of = scene_.obstacles[i];
        const SearchGoal goal{.tolerance = fine,
                              .maximum = clearance + off,
                              .enough = scene_.radius,
                              .finest = fine,
                              .maxSteps = kMost,
                              .measures = true,
                              .coarsely = true};
        const BatchItem item{&scene_.axis, of.given->volume, nullptr, {}};
        const Found found = PairAt{item, *of.part, scene_.axisPose(cone.axis, longest), &scene_.cancel}.search(
            memory_, of.searched(), goal, sweep);
        clearance = std::min(clearance, found.lo - off);
    }
    return std::max(clearance, 0.0);
}

void PatchCertificate::measure(const DirectionPatch& cell, std::vector<EntryTriangle>& triangles) {
    double longest = 0;
    double most = 0; // no path of a triangle keeps more than those from its corners
    forTriangles(cell, [&](const std::array<std::uint32_t, 3>& corners, std::uint32_t /*place*/) {
        double least = scene_.task.maximum;
        for (const std::uint32_t corner : corners) {
            longest = std::max(longest, paths_[corner]->length);
            least = std::min(least, paths_[corner]->clearance.upper);
        }
        most = std::max(most, least);
    });
    if (most == 0 || scene_.givenUp()) {
        return;
    }
    const double all = clearanceOf(cell, longest, most);
    forTriangles(cell, [&](const std::array<std::uint32_t, 3>& corners, std::uint32_t place) {
        double hi = all;
        for (const std::uint32_t corner : corners) {
            hi = std::min(hi, paths_[corner]->clearance.upper);
        }
        EntryTriangle& triangle = triangles[place];
        triangle.clearance = triangle.safe ? std::max(hi, std::min(scene_.task.margin, scene_.task.maximum)) : hi;
    });
}

void PatchCertificate::run(const DirectionPatch& patch, std::vector<EntryTriangle>& triangles) {
    certify(patch, Open(scene_.obstacles.size()), triangles);
    if (!scene_.task.triangleDistances) {
        return;
    }
    for (std::uint32_t i = patch.lo[0]; i < patch.hi[0]; ++i) {
        for (std::uint32_t j = patch.lo[1]; j < patch.hi[1]; ++j) {
            measure({patch.rhombus, {i, j}, {i + 1, j + 1}}, triangles);
        }
    }
}

} // namespace voxtact::cpu
