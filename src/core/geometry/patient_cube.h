// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <array>
#include <cstddef>
#include <vector>

/// A cube aligned with the patient, with a letter on each side, in a view. World space is LPS.
namespace voxtact {

/// A side of the patient.
struct PatientSide {
    const char* letter; ///< L left, R right, P posterior, A anterior, S superior, I inferior
    const char* view;   ///< name of the view of this side, for directionNamed()
    Vec3 normal;        ///< direction of the side
    Vec3 up;            ///< up direction of its letter: upright like the patient; on top and bottom, towards the face
};

/// By axis, the positive side first.
inline constexpr std::array<PatientSide, 6> kPatientSides{{{"L", "left", {1, 0, 0}, {0, 0, 1}},
                                                           {"R", "right", {-1, 0, 0}, {0, 0, 1}},
                                                           {"P", "back", {0, 1, 0}, {0, 0, 1}},
                                                           {"A", "front", {0, -1, 0}, {0, 0, 1}},
                                                           {"S", "top", {0, 0, 1}, {0, -1, 0}},
                                                           {"I", "bottom", {0, 0, -1}, {0, -1, 0}}}};

[[nodiscard]] constexpr const PatientSide& patientSide(std::size_t axis, bool negative) noexcept {
    return kPatientSides[2 * axis + (negative ? 1 : 0)];
}

/// Maximum distance of the cube's corners from its middle, in half edges: sqrt(3), plus a margin.
inline constexpr double kCubeReach = 1.75;

/// A side of the cube that the eye sees. Places are to the right and down in a picture, in half edges of the cube.
struct SeenSide {
    std::size_t side = 0;           ///< of kPatientSides
    double facing = 0;              ///< 1: seen from straight before it; near 0: from the side
    std::array<double, 2> middle{}; ///< from the cube's middle
    std::array<double, 2> right{};  ///< from there to its edge, along its letter
    std::array<double, 2> up{};     ///< the same
};

/// Returns the visible sides, which do not occlude each other. Arguments are unit vectors of world space at right
/// angles: to the picture's right and up.
[[nodiscard]] inline std::vector<SeenSide> seenSides(const Vec3& right, const Vec3& up) {
    const auto dot = [](const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
    const auto cross = [](const Vec3& a, const Vec3& b) {
        return Vec3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const auto place = [&](const Vec3& v) { return std::array<double, 2>{dot(v, right), -dot(v, up)}; };
    const Vec3 towardsEye = cross(right, up);
    constexpr double kSeen = 0.02;
    std::vector<SeenSide> out;
    for (std::size_t side = 0; side < kPatientSides.size(); ++side) {
        const auto& [letter, view, normal, upright] = kPatientSides[side];
        const double facing = dot(normal, towardsEye);
        if (facing >= kSeen) {
            out.push_back({side, facing, place(normal), place(cross(upright, normal)), place(upright)});
        }
    }
    return out;
}

} // namespace voxtact
