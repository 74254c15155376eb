// SPDX-License-Identifier: MIT
#include "cli/output/size_note.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace voxtact::app {

namespace {

/// Rounds to three significant digits: "0.15".
std::string rounded(double length) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", length);
    return text;
}

double diagonal(const Box& box) {
    return std::hypot(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]);
}

/// Far from the origin, rounding loses the size.
Mat4 withoutPlace(Mat4 pose) {
    std::fill(pose.begin() + 12, pose.begin() + 15, 0.0);
    return pose;
}

/// Returns the note for the sizes of a mesh and a volume, mm.
std::string noteOf(double mesh, double volume) {
    // A factor of 1000, with a tolerance for the sizes of instruments and anatomies.
    constexpr double kStriking = 250;
    if (!(mesh > 0) || !(volume > 0)) {
        return {};
    }
    if (mesh * kStriking < volume) {
        return "is " + rounded(mesh) + " mm long, the volume " + rounded(volume) +
               " mm: if in metres, use --mesh-scale 1000";
    }
    if (mesh > volume * kStriking) {
        return "is " + rounded(mesh) + " mm long, the volume " + rounded(volume) +
               " mm: if in micrometres, use --mesh-scale 0.001";
    }
    return {};
}

} // namespace

std::string sizeNote(const Box& object, const Mat4& world_from_object, const Grid& volume) {
    // The bounds of a rotated box are larger than the box, but too little to matter here.
    return noteOf(diagonal(transformBox(withoutPlace(world_from_object), object)),
                  diagonal(transformBox(worldFromTexture(volume), {{0, 0, 0}, {1, 1, 1}})));
}

std::string unitHint(const Box& bounds) {
    // Instruments have centimetres to decimetres, bodies up to two metres.
    constexpr double kShortest = 3;
    constexpr double kLongest = 10000;
    const double length = diagonal(bounds);
    if (length > 0 && length < kShortest) {
        return "only " + rounded(length) + " mm long: if in metres, use --mesh-scale 1000";
    }
    if (length > kLongest) {
        return rounded(length) + " mm long: if in micrometres, use --mesh-scale 0.001";
    }
    return {};
}

} // namespace voxtact::app
