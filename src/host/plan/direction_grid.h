// SPDX-License-Identifier: MIT
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace voxtact::cpu {

/// A rectangle of a DirectionGrid's vertices, both ends inclusive.
struct DirectionPatch {
    std::uint32_t rhombus = 0;
    std::array<std::uint32_t, 2> lo{};
    std::array<std::uint32_t, 2> hi{};

    [[nodiscard]] std::uint32_t cells(std::size_t axis) const noexcept { return hi[axis] - lo[axis]; }
};

/// All directions within an angle of one.
struct DirectionCone {
    glm::dvec3 axis{};
    double angle = 0; ///< radians
};

/// Directions all around: each side of an icosahedron is divided into n^2 triangles, and their corners are seen from
/// the middle. Two of the sides make a rhombus, with the corners (0, 0), (n, 0), (0, n) and (n, n); the ridge between
/// them goes from the second to the third.
class DirectionGrid {
  public:
    static constexpr std::uint32_t kRhombi = 10;

    /// Returns the smallest grid with at least this number of directions.
    explicit DirectionGrid(std::uint32_t directions);

    [[nodiscard]] std::uint32_t side() const noexcept { return side_; } ///< n
    [[nodiscard]] std::uint32_t count() const noexcept { return kRhombi * side_ * side_ + 2; }
    /// Number of a vertex; those on its edges belong to neighbours, too.
    [[nodiscard]] std::uint32_t number(std::uint32_t rhombus, std::uint32_t i, std::uint32_t j) const noexcept;
    /// Returns a unit vector up to rounding, always the same for an index.
    [[nodiscard]] glm::dvec3 direction(std::uint32_t number) const noexcept;
    /// Numbers of the corners of the two triangles of the cell that begins at a vertex, counter-clockwise from outside.
    [[nodiscard]] std::array<std::array<std::uint32_t, 3>, 2> triangles(std::uint32_t rhombus, std::uint32_t i,
                                                                        std::uint32_t j) const noexcept;
    /// Holds every direction to a point of the patch's triangles, flat ones or any that are seen in their place.
    [[nodiscard]] DirectionCone cone(const DirectionPatch& patch) const;

  private:
    [[nodiscard]] glm::dvec3 at(std::uint32_t rhombus, std::uint32_t i, std::uint32_t j) const noexcept;

    std::uint32_t side_ = 1;
    std::array<std::array<glm::dvec3, 4>, kRhombi> corners_{}; ///< (0, 0), (n, 0), (0, n), (n, n)
};

} // namespace voxtact::cpu
