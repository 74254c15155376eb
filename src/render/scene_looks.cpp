// SPDX-License-Identifier: MIT
// How a scene looks by name: light, cuts, and the colours of several meshes.
#include "voxtact/render.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace voxtact {

namespace {

/// Occlusion range as a fraction of the volume: millimetres for a head are too large for a tooth.
constexpr double kReach = 0.025; // of the diagonal

struct Side {
    const char* name;
    std::size_t axis;
    double sign; ///< sign of the removed side
};
constexpr Side kSides[] = {{"left", 0, 1},   {"right", 0, -1}, {"back", 1, 1},
                           {"front", 1, -1}, {"top", 2, 1},    {"bottom", 2, -1}};

constexpr Colour kOtherMeshes[] = {
    {0.30, 0.70, 0.88}, {0.98, 0.80, 0.28}, {0.46, 0.78, 0.42}, {0.74, 0.58, 0.90}, {0.20, 0.62, 0.60}};

} // namespace

std::optional<Lighting> lightingNamed(std::string_view name, const Grid& grid) noexcept {
    Lighting lighting;
    if (name == "eye") {
        return lighting;
    }
    if (name == "none") {
        lighting.volume = lighting.mesh = false;
        return lighting;
    }
    if (name != "soft") {
        return std::nullopt;
    }
    lighting.ambient = 0.3;
    lighting.diffuse = 0.45;
    lighting.side = 0.5;
    lighting.specular = 0.16;
    lighting.occlusion = 0.55;
    double diagonal = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        diagonal += std::pow(grid.spacing[axis] * grid.size[axis], 2);
    }
    lighting.reach = kReach * std::sqrt(diagonal);
    return lighting;
}

std::optional<ClipPlane> clipSide(std::string_view side, std::optional<double> at, const Grid& grid,
                                  const Vec3& towardsEye) noexcept {
    const Vec3 middle = transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
    if (side == "near") {
        const double depth = towardsEye[0] * middle[0] + towardsEye[1] * middle[1] + towardsEye[2] * middle[2];
        return ClipPlane{towardsEye, depth + at.value_or(0)};
    }
    const auto* found = std::ranges::find_if(kSides, [&](const Side& one) { return side == one.name; });
    if (found == std::end(kSides)) {
        return std::nullopt;
    }
    ClipPlane plane;
    plane.normal[found->axis] = found->sign;
    plane.offset = found->sign * at.value_or(middle[found->axis]);
    return plane;
}

Colour meshColour(std::size_t number) noexcept {
    const std::size_t which = number % (1 + std::size(kOtherMeshes));
    return which == 0 ? SceneMesh{}.meshColour : kOtherMeshes[which - 1];
}

double throughFor(Paint paint) noexcept {
    constexpr double kContacts = 0.8;
    return paint == Paint::Discarded ? 1 : kContacts;
}

} // namespace voxtact
