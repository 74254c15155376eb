// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/data.h"

#include <algorithm>
#include <array>

/// Where a triangle is in a volume, as the judge has it: in double precision, and in __float128.
namespace voxtact::test::quad {

__extension__ using Quad = __float128;

/// Of the terms of a sum or a product: generously more than a hundred roundings.
template <class Real> constexpr Real kRounding = Real(0x1p-46);
template <> constexpr Quad kRounding<Quad> = Quad(0x1p-104);

template <class Real> Real size(Real value) {
    return value < 0 ? -value : value;
}

template <class Real> using Place = std::array<Real, 3>;

/// A sum that knows whether it was rounded.
template <class Real> struct Sum {
    Real value = 0;
    Real magnitude = 0;
    bool exact = true;

    void add(Real term) {
        const Real sum = value + term;
        const Real ofTerm = sum - value;
        exact = exact && (term - ofTerm) + (value - (sum - ofTerm)) == 0;
        value = sum;
        magnitude += size(term);
    }
    /// Of a double and what has at most 32 bits: exact in 113 bits, never taken for it in 53.
    void addProduct(Real a, Real b) {
        exact = exact && (sizeof(Real) > sizeof(double) || a == 0 || b == 0);
        add(a * b);
    }
    [[nodiscard]] Real error() const { return exact ? Real(0) : kRounding<Real> * magnitude; }
};

template <class Real> struct Vertex {
    Place<Real> at{};
    Real error = 0; ///< voxels, along each axis
    /// Of each face of the domain, [2 * axis + end]: certainly inside of it or in it, in it, beyond it.
    std::array<bool, 6> inside{};
    std::array<bool, 6> on{};
    std::array<bool, 6> beyond{};

    void compare(std::size_t face, Real distance, Real uncertain) {
        inside[face] = distance > uncertain || (uncertain == 0 && distance == 0);
        on[face] = uncertain == 0 && distance == 0;
        beyond[face] = -distance > uncertain;
    }
};

/// A point of world space as sums of products of what the pair was given in.
template <class Real>
std::array<Sum<Real>, 3> worldOf(const Mat4& world_from_object, const std::array<float, 3>& vertex,
                                 const Vec3& origin) {
    std::array<Sum<Real>, 3> out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t k = 0; k < 3; ++k) {
            out[axis].addProduct(Real(world_from_object[4 * k + axis]), Real(vertex[k]));
        }
        out[axis].add(Real(world_from_object[12 + axis]));
        out[axis].add(-Real(origin[axis]));
    }
    return out;
}

/// Where an axis of the grid is one of the world's: that one. 3 where it is not.
inline std::size_t alongWorld(const Grid& grid, std::size_t column) {
    std::size_t out = 3;
    for (std::size_t row = 0; row < 3; ++row) {
        const double element = grid.direction[3 * column + row];
        if (element == 1 || element == -1) {
            out = row;
        } else if (element != 0) {
            return 3;
        }
    }
    return out;
}

template <class Real>
void placeAligned(const Grid& grid, const std::array<Sum<Real>, 3>& world, std::size_t axis, std::size_t along,
                  Vertex<Real>& vertex) {
    const bool flipped = grid.direction[3 * axis + along] < 0;
    const Real spacing = Real(grid.spacing[axis]);
    Sum<Real> near = world[along];
    near.value = flipped ? -near.value : near.value;
    near.add(spacing / 2);
    Sum<Real> far = near;
    far.value = -near.value;
    far.addProduct(spacing, Real(grid.size[axis]));
    vertex.compare(2 * axis, near.value, near.error());
    vertex.compare(2 * axis + 1, far.value, far.error());
    vertex.at[axis] = near.value / spacing - Real(0.5);
    const Real error = near.error() / spacing + kRounding<Real> * (size(vertex.at[axis]) + 1);
    vertex.error = std::max(vertex.error, error);
}

/// Cramer's rule.
template <class Real>
void placeOblique(const Grid& grid, const std::array<Sum<Real>, 3>& world, std::size_t axis, Vertex<Real>& vertex) {
    const auto element = [&](std::size_t column, std::size_t row) {
        return Real(grid.direction[3 * (column % 3) + row % 3]) * Real(grid.spacing[column % 3]);
    };
    Real sum = 0;
    Real terms = 0;
    Real determinant = 0;
    Real determinantTerms = 0;
    for (std::size_t row = 0; row < 3; ++row) {
        const Real a = element(axis + 1, row + 1) * element(axis + 2, row + 2);
        const Real b = element(axis + 1, row + 2) * element(axis + 2, row + 1);
        sum += (a - b) * world[row].value;
        terms += (size(a) + size(b)) * world[row].magnitude;
        determinant += (a - b) * element(axis, row);
        determinantTerms += (size(a) + size(b)) * size(element(axis, row));
    }
    vertex.at[axis] = sum / determinant;
    const Real error = kRounding<Real> * ((terms + size(vertex.at[axis]) * determinantTerms) / size(determinant) + 1);
    vertex.compare(2 * axis, vertex.at[axis] + Real(0.5), error);
    vertex.compare(2 * axis + 1, Real(grid.size[axis]) - Real(0.5) - vertex.at[axis], error);
    vertex.error = std::max(vertex.error, error);
}

template <class Real>
Vertex<Real> placed(const Grid& grid, const Mat4& world_from_object, const std::array<float, 3>& vertex) {
    const std::array<Sum<Real>, 3> world = worldOf<Real>(world_from_object, vertex, grid.origin);
    bool aligned = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        aligned = aligned && alongWorld(grid, axis) < 3;
    }
    Vertex<Real> out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (aligned) {
            placeAligned(grid, world, axis, alongWorld(grid, axis), out);
        } else {
            placeOblique(grid, world, axis, out);
        }
    }
    return out;
}

template <class Real> using Triangle = std::array<Vertex<Real>, 3>;

/// A triangle that meets the half-space of a face in an edge or a corner alone is that edge or corner.
template <class Real> void fold(Triangle<Real>& triangle, std::size_t face) {
    const Vertex<Real>* on = nullptr;
    for (const Vertex<Real>& vertex : triangle) {
        if (!vertex.on[face] && !vertex.beyond[face]) {
            return;
        }
        on = vertex.on[face] ? &vertex : on;
    }
    if (on == nullptr) {
        return;
    }
    const Vertex<Real> kept = *on;
    for (Vertex<Real>& vertex : triangle) {
        vertex = vertex.on[face] ? vertex : kept;
    }
}

} // namespace voxtact::test::quad
