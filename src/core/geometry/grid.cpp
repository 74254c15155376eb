// SPDX-License-Identifier: MIT
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/geometry/glm_bridge.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace voxtact {

namespace {

/// Below this, the unit axes are so nearly in one plane that positions across it are lost.
constexpr double kSmallestDeterminant = 1e-6;

constexpr const char* kAxes[] = {"x", "y", "z"};

glm::dmat4 worldFromIndexGlm(const Grid& grid) {
    glm::dmat4 out(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        for (int r = 0; r < 3; ++r) {
            out[axis][r] = grid.direction[3 * a + static_cast<std::size_t>(r)] * grid.spacing[a];
        }
        out[3][axis] = grid.origin[a];
    }
    return out;
}

glm::dmat4 indexFromTextureGlm(const Grid& grid) {
    // index = texture * n - 0.5: voxel i's centre is at texture (i+0.5)/n.
    const glm::dmat4 shift = glm::translate(glm::dmat4(1.0), glm::dvec3(-0.5));
    return glm::scale(shift, glm::dvec3(grid.size[0], grid.size[1], grid.size[2]));
}

/// Refuses axes that do not span space, and steps between voxels that are too short or long.
Result<void> checkDirection(const Grid& grid) {
    glm::dmat3 direction;
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
            direction[c][r] = grid.direction[static_cast<std::size_t>(3 * c + r)];
            if (!std::isfinite(direction[c][r])) {
                return refuse("the direction matrix has an element that is not finite");
            }
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double step = glm::length(direction[axis]) * grid.spacing[static_cast<std::size_t>(axis)];
        if (!(step >= kMinSpacing && step <= kMaxSpacing)) {
            return refuse(std::string("the voxels along ") + kAxes[axis] + " are " + number(step) +
                          " mm apart, by spacing and direction; it must be from " + number(kMinSpacing) + " to " +
                          number(kMaxSpacing));
        }
    }
    if (!(std::abs(glm::determinant(direction)) >= kSmallestDeterminant)) {
        return refuse("the direction matrix is singular (determinant " + number(glm::determinant(direction)) +
                      "): the image's axes do not span space");
    }
    return {};
}

} // namespace

Result<void> checkGrid(const Grid& grid) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (grid.size[axis] == 0) {
            return refuse(std::string("the image is empty: it has 0 voxels along ") + kAxes[axis]);
        }
        if (!(grid.spacing[axis] >= kMinSpacing && grid.spacing[axis] <= kMaxSpacing)) {
            return refuse(std::string("the spacing along ") + kAxes[axis] + " is " + number(grid.spacing[axis]) +
                          " mm, it must be from " + number(kMinSpacing) + " to " + number(kMaxSpacing));
        }
        if (!(std::abs(grid.origin[axis]) <= kMaxSpacing)) {
            return refuse(std::string("the origin's ") + kAxes[axis] + " is " + number(grid.origin[axis]) +
                          " mm, it must be within " + number(kMaxSpacing));
        }
    }
    // So that byte counts fit into 64 bits.
    constexpr std::uint64_t kMostVoxels = std::uint64_t{1} << 56U;
    if (std::uint64_t{grid.size[0]} * grid.size[1] > kMostVoxels / grid.size[2]) {
        return refuse("the image has more than 2^56 voxels");
    }
    return checkDirection(grid);
}

Mat4 worldFromIndex(const Grid& grid) noexcept {
    return fromGlm(worldFromIndexGlm(grid));
}

Mat4 worldFromTexture(const Grid& grid) noexcept {
    return fromGlm(worldFromIndexGlm(grid) * indexFromTextureGlm(grid));
}

Result<Mat4> textureFromWorld(const Grid& grid) {
    VOXTACT_TRY(checkGrid(grid));
    return fromGlm(glm::inverse(worldFromIndexGlm(grid) * indexFromTextureGlm(grid)));
}

std::uint64_t voxelCount(const Grid& grid) noexcept {
    return std::uint64_t{grid.size[0]} * grid.size[1] * grid.size[2];
}

} // namespace voxtact
