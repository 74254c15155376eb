// SPDX-License-Identifier: MIT
#pragma once

#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>

#include <array>
#include <optional>
#include <vector>

namespace voxtact::step {

/// A box of parameters. Curves have u alone.
struct ParameterBox {
    double u0 = 0;
    double u1 = 0;
    double v0 = 0;
    double v1 = 0;

    [[nodiscard]] double sizeU() const { return u1 - u0; }
    [[nodiscard]] double sizeV() const { return v1 - v0; }
};

/// Upper bounds of the lengths of partial derivatives over a box; infinite where none is known.
struct DerivativeBounds {
    double u = 0;
    double v = 0;
    double uu = 0;
    double uv = 0;
    double vv = 0;
    double jumpU = 0; ///< of the first derivatives: sum over the knots in the box
    double jumpV = 0;

    /// How far linear interpolation between the corners of a triangle in a box is off, at most. On a triangle with
    /// weights l, each term of the remainder is a variance, and that of a number in a range of length s is at most
    /// s^2 / 4 (Popoviciu); a kink by J adds at most J s / 4. `parts`: the triangle is divided into parts^2.
    [[nodiscard]] double interpolationError(const ParameterBox& box, double parts = 1) const;
};

/// The Bezier patches of a B-spline, with bounds of their derivatives from their control points.
class BezierGrid {
  public:
    using Pole = std::array<double, 4>; ///< homogeneous: weight times x, y, z; weight
    struct Net {
        std::size_t sizeU = 0;
        std::size_t sizeV = 0;
        std::vector<Pole> poles; ///< v fastest

        [[nodiscard]] const Pole& at(std::size_t i, std::size_t j) const { return poles[i * sizeV + j]; }
    };

    /// Knots of the patches; nets in the order of Net.
    BezierGrid(std::vector<double> knotsU, std::vector<double> knotsV, std::vector<Net> nets);

    [[nodiscard]] DerivativeBounds over(const ParameterBox& box) const;

  private:
    [[nodiscard]] const Net& net(std::size_t i, std::size_t j) const { return nets_[i * (knotsV_.size() - 1) + j]; }
    void findJumps();

    std::vector<double> knotsU_;
    std::vector<double> knotsV_;
    std::vector<Net> nets_;
    std::vector<DerivativeBounds> bounds_;
    double jumpU_ = 0; ///< the largest across a knot; that from the last to the first is across a seam
    double jumpV_ = 0;
    double seamU_ = 0;
    double seamV_ = 0;
};

/// Of a curve: u alone.
class CurveBounds {
  public:
    /// `seen`: x, y and z are multiplied by these first.
    explicit CurveBounds(const opencascade::handle<Geom_Curve>& curve, const std::array<double, 3>& seen = {1, 1, 1});

    [[nodiscard]] DerivativeBounds over(double first, double last) const;

  private:
    DerivativeBounds everywhere_;
    std::optional<BezierGrid> grid_;
};

class SurfaceBounds {
  public:
    explicit SurfaceBounds(const opencascade::handle<Geom_Surface>& surface);

    [[nodiscard]] DerivativeBounds over(const ParameterBox& box) const;

  private:
    opencascade::handle<Geom_Surface> surface_; ///< not trimmed
    std::optional<BezierGrid> grid_;
    std::optional<CurveBounds> profile_; ///< of surfaces that a curve sweeps
};

} // namespace voxtact::step
