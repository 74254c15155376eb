// SPDX-License-Identifier: MIT
#include "step/derivative_bounds.h"

#include <GeomAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <GeomConvert.hxx>
#include <GeomConvert_BSplineCurveToBezierCurve.hxx>
#include <GeomConvert_BSplineSurfaceToBezierSurface.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SweptSurface.hxx>
#include <gp_Lin.hxx>
#include <gp_Torus.hxx>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace voxtact::step {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr DerivativeBounds kUnknown{kInfinity, kInfinity, kInfinity, kInfinity, kInfinity, 0, 0};

using Pole = BezierGrid::Pole;
using Net = BezierGrid::Net;

Pole poleOf(const gp_Pnt& point, double weight) {
    return {weight * point.X(), weight * point.Y(), weight * point.Z(), weight};
}

/// a - b, times `factor`.
Pole difference(const Pole& a, const Pole& b, double factor) {
    return {factor * (a[0] - b[0]), factor * (a[1] - b[1]), factor * (a[2] - b[2]), factor * (a[3] - b[3])};
}

/// The control points of the derivative along u or v; `span`: of the parameter.
Net derivative(const Net& net, bool alongU, double span) {
    Net out{net.sizeU - (alongU ? 1 : 0), net.sizeV - (alongU ? 0 : 1), {}};
    const double factor = static_cast<double>(alongU ? out.sizeU : out.sizeV) / span;
    for (std::size_t i = 0; i < out.sizeU; ++i) {
        for (std::size_t j = 0; j < out.sizeV; ++j) {
            const Pole& next = alongU ? net.at(i + 1, j) : net.at(i, j + 1);
            out.poles.push_back(difference(next, net.at(i, j), factor));
        }
    }
    return out;
}

/// The largest point, and the largest weight, of control points. Bezier curves stay in the hull of theirs.
struct Size {
    double point = 0;
    double weight = 0;
};
Size sizeOf(const Net& net) {
    Size size;
    for (const Pole& pole : net.poles) {
        size.point = std::max(size.point, std::hypot(pole[0], pole[1], pole[2]));
        size.weight = std::max(size.weight, std::abs(pole[3]));
    }
    return size;
}

/// How far a rational patch is from the origin, at most, and its least weight; a weight of 0 or less: nothing is known.
struct Reach {
    double distance = 0;
    double weight = kInfinity;
};
Reach reachOf(const Net& net) {
    Reach reach;
    for (const Pole& pole : net.poles) {
        reach.weight = std::min(reach.weight, pole[3]);
        reach.distance = std::max(reach.distance, std::hypot(pole[0], pole[1], pole[2]) / pole[3]);
    }
    return reach;
}

/// Moves the first control point to the origin.
Net centred(Net net) {
    const Pole first = net.poles.front();
    for (Pole& pole : net.poles) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            pole[axis] -= pole[3] * (first[axis] / first[3]);
        }
    }
    return net;
}

/// By the quotient rule: S = A / w, so that w S' = A' - S w', and w S'' = A'' - 2 S' w' - S w''.
DerivativeBounds boundsOf(const Net& given, double spanU, double spanV) {
    const Net net = centred(given);
    const Reach reach = reachOf(net);
    if (!(reach.weight > 0) || !std::isfinite(reach.distance)) {
        return kUnknown;
    }
    const auto along = [](const Net& of, bool alongU, double span) {
        return (alongU ? of.sizeU : of.sizeV) > 1 ? derivative(of, alongU, span) : Net{};
    };
    const Net netU = along(net, true, spanU);
    const Net netV = along(net, false, spanV);
    const Size u = sizeOf(netU);
    const Size v = sizeOf(netV);
    const Size uu = sizeOf(along(netU, true, spanU));
    const Size uv = sizeOf(along(netU, false, spanV));
    const Size vv = sizeOf(along(netV, false, spanV));
    DerivativeBounds bounds;
    bounds.u = (u.point + reach.distance * u.weight) / reach.weight;
    bounds.v = (v.point + reach.distance * v.weight) / reach.weight;
    bounds.uu = (uu.point + 2 * bounds.u * u.weight + reach.distance * uu.weight) / reach.weight;
    bounds.uv = (uv.point + bounds.u * v.weight + bounds.v * u.weight + reach.distance * uv.weight) / reach.weight;
    bounds.vv = (vv.point + 2 * bounds.v * v.weight + reach.distance * vv.weight) / reach.weight;
    return bounds;
}

/// The row of control points that patches share, and the jump of the homogeneous derivative there. Any multiple of the
/// row may be taken off the jump: it turns the point along itself.
double jumpAcross(Net row, Net jump) {
    const Pole origin = row.poles.front();
    for (std::size_t i = 0; i < row.poles.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double centre = origin[axis] / origin[3];
            row.poles[i][axis] -= row.poles[i][3] * centre;
            jump.poles[i][axis] -= jump.poles[i][3] * centre;
        }
    }
    const Reach reach = reachOf(row);
    const double multiple = jump.poles.front()[3] / row.poles.front()[3];
    for (std::size_t i = 0; i < row.poles.size(); ++i) {
        for (std::size_t k = 0; k < 4; ++k) {
            jump.poles[i][k] -= multiple * row.poles[i][k];
        }
    }
    const Size size = sizeOf(jump);
    return reach.weight > 0 ? (size.point + reach.distance * size.weight) / reach.weight : kInfinity;
}

double jumpBetween(const Net& before, const Net& after, bool alongU, double spanBefore, double spanAfter) {
    if ((alongU ? after.sizeU : after.sizeV) == 1) {
        return 0; // a curve, across its own direction
    }
    const Net left = derivative(before, alongU, spanBefore);
    const Net right = derivative(after, alongU, spanAfter);
    Net row{1, alongU ? after.sizeV : after.sizeU, {}};
    Net jump = row;
    for (std::size_t k = 0; k < row.sizeV; ++k) {
        row.poles.push_back(alongU ? after.at(0, k) : after.at(k, 0));
        jump.poles.push_back(alongU ? difference(right.at(0, k), left.at(left.sizeU - 1, k), 1)
                                    : difference(right.at(k, 0), left.at(k, left.sizeV - 1), 1));
    }
    return jumpAcross(std::move(row), std::move(jump));
}

/// The spans of knots that a range meets: all of them where it leaves the knots, as a periodic B-spline allows.
struct Spans {
    std::size_t begin = 0;
    std::size_t end = 0;
    bool crossesSeam = false;

    /// Of the first derivative, at the knots between the spans.
    [[nodiscard]] double jump(double inside, double seam) const {
        return crossesSeam ? std::max(inside, seam) * static_cast<double>(end)
                           : inside * static_cast<double>(end - begin - 1);
    }
};
Spans spansOf(const std::vector<double>& knots, double first, double last) {
    const double slack = 1e-9 * (knots.back() - knots.front());
    const std::size_t spans = knots.size() - 1;
    if (first < knots.front() - slack || last > knots.back() + slack) {
        return {0, spans, true};
    }
    const auto after = std::upper_bound(knots.begin(), knots.end(), first - slack);
    const auto end = std::lower_bound(knots.begin(), knots.end(), last + slack);
    const auto lo = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - knots.begin() - 1, 0));
    const auto hi = static_cast<std::size_t>(end - knots.begin());
    const std::size_t begin = std::min(lo, spans - 1);
    return {begin, std::clamp(hi, begin + 1, spans), false};
}

template <class Knots>
std::vector<double> knotsOf(const Knots& of, int patches, void (Knots::*get)(TColStd_Array1OfReal&) const) {
    TColStd_Array1OfReal knots(1, patches + 1);
    (of.*get)(knots);
    return {knots.begin(), knots.end()};
}

BezierGrid gridOf(const opencascade::handle<Geom_BSplineSurface>& surface) {
    GeomConvert_BSplineSurfaceToBezierSurface patches(surface);
    std::vector<Net> nets;
    for (int i = 1; i <= patches.NbUPatches(); ++i) {
        for (int j = 1; j <= patches.NbVPatches(); ++j) {
            const opencascade::handle<Geom_BezierSurface> patch = patches.Patch(i, j);
            Net net{static_cast<std::size_t>(patch->NbUPoles()), static_cast<std::size_t>(patch->NbVPoles()), {}};
            for (int u = 1; u <= patch->NbUPoles(); ++u) {
                for (int v = 1; v <= patch->NbVPoles(); ++v) {
                    net.poles.push_back(poleOf(patch->Pole(u, v), patch->Weight(u, v)));
                }
            }
            nets.push_back(std::move(net));
        }
    }
    using Patches = GeomConvert_BSplineSurfaceToBezierSurface;
    return {knotsOf(patches, patches.NbUPatches(), &Patches::UKnots),
            knotsOf(patches, patches.NbVPatches(), &Patches::VKnots), std::move(nets)};
}

BezierGrid gridOf(const opencascade::handle<Geom_BSplineCurve>& curve, const std::array<double, 3>& seen) {
    GeomConvert_BSplineCurveToBezierCurve arcs(curve);
    std::vector<Net> nets;
    for (int i = 1; i <= arcs.NbArcs(); ++i) {
        const opencascade::handle<Geom_BezierCurve> arc = arcs.Arc(i);
        Net net{static_cast<std::size_t>(arc->NbPoles()), 1, {}};
        for (int pole = 1; pole <= arc->NbPoles(); ++pole) {
            const gp_Pnt at = arc->Pole(pole);
            net.poles.push_back(poleOf({seen[0] * at.X(), seen[1] * at.Y(), seen[2] * at.Z()}, arc->Weight(pole)));
        }
        nets.push_back(std::move(net));
    }
    return {knotsOf(arcs, arcs.NbArcs(), &GeomConvert_BSplineCurveToBezierCurve::Knots), {0, 1}, std::move(nets)};
}

double largestCosine(double first, double last) {
    // Latitudes of a sphere, from -pi/2 to pi/2.
    return first <= 0 && last >= 0 ? 1 : std::max(std::abs(std::cos(first)), std::abs(std::cos(last)));
}

} // namespace

double DerivativeBounds::interpolationError(const ParameterBox& box, double parts) const {
    const double du = box.sizeU() / parts;
    const double dv = box.sizeV() / parts;
    return (uu * du * du + 2 * uv * du * dv + vv * dv * dv) / 8 + (jumpU * du + jumpV * dv) / 4;
}

BezierGrid::BezierGrid(std::vector<double> knotsU, std::vector<double> knotsV, std::vector<Net> nets)
    : knotsU_(std::move(knotsU)), knotsV_(std::move(knotsV)), nets_(std::move(nets)) {
    for (std::size_t i = 0; i + 1 < knotsU_.size(); ++i) {
        for (std::size_t j = 0; j + 1 < knotsV_.size(); ++j) {
            bounds_.push_back(boundsOf(net(i, j), knotsU_[i + 1] - knotsU_[i], knotsV_[j + 1] - knotsV_[j]));
        }
    }
    findJumps();
}

void BezierGrid::findJumps() {
    const std::size_t countU = knotsU_.size() - 1;
    const std::size_t countV = knotsV_.size() - 1;
    const auto spanU = [this](std::size_t i) { return knotsU_[i + 1] - knotsU_[i]; };
    const auto spanV = [this](std::size_t j) { return knotsV_[j + 1] - knotsV_[j]; };
    for (std::size_t i = 0; i < countU; ++i) {
        for (std::size_t j = 0; j < countV; ++j) {
            const std::size_t beforeU = (i == 0 ? countU : i) - 1;
            const std::size_t beforeV = (j == 0 ? countV : j) - 1;
            double& jumpU = i == 0 ? seamU_ : jumpU_;
            double& jumpV = j == 0 ? seamV_ : jumpV_;
            jumpU = std::max(jumpU, jumpBetween(net(beforeU, j), net(i, j), true, spanU(beforeU), spanU(i)));
            jumpV = std::max(jumpV, jumpBetween(net(i, beforeV), net(i, j), false, spanV(beforeV), spanV(j)));
        }
    }
}

DerivativeBounds BezierGrid::over(const ParameterBox& box) const {
    const Spans u = spansOf(knotsU_, box.u0, box.u1);
    const Spans v = spansOf(knotsV_, box.v0, box.v1);
    DerivativeBounds out;
    for (std::size_t i = u.begin; i < u.end; ++i) {
        for (std::size_t j = v.begin; j < v.end; ++j) {
            const DerivativeBounds& one = bounds_[i * (knotsV_.size() - 1) + j];
            out.u = std::max(out.u, one.u);
            out.v = std::max(out.v, one.v);
            out.uu = std::max(out.uu, one.uu);
            out.uv = std::max(out.uv, one.uv);
            out.vv = std::max(out.vv, one.vv);
        }
    }
    out.jumpU = u.jump(jumpU_, seamU_);
    out.jumpV = v.jump(jumpV_, seamV_);
    return out;
}

CurveBounds::CurveBounds(const opencascade::handle<Geom_Curve>& curve, const std::array<double, 3>& seen)
    : everywhere_(kUnknown) {
    const GeomAdaptor_Curve adaptor(curve);
    const auto largest = [&] { return std::max({seen[0], seen[1], seen[2]}); };
    switch (adaptor.GetType()) {
    case GeomAbs_Line: {
        const gp_Dir along = adaptor.Line().Direction();
        everywhere_ = {.u = std::hypot(seen[0] * along.X(), seen[1] * along.Y(), seen[2] * along.Z())};
        break;
    }
    case GeomAbs_Circle:
        everywhere_ = {.u = largest() * adaptor.Circle().Radius(), .uu = largest() * adaptor.Circle().Radius()};
        break;
    case GeomAbs_Ellipse:
        everywhere_ = {.u = largest() * adaptor.Ellipse().MajorRadius(),
                       .uu = largest() * adaptor.Ellipse().MajorRadius()};
        break;
    case GeomAbs_BezierCurve:
        grid_ = gridOf(GeomConvert::CurveToBSplineCurve(adaptor.Bezier()), seen);
        break;
    case GeomAbs_BSplineCurve:
        grid_ = gridOf(adaptor.BSpline(), seen);
        break;
    default: // parabolas, hyperbolas and offsets
        break;
    }
}

DerivativeBounds CurveBounds::over(double first, double last) const {
    return grid_ ? grid_->over({first, last, 0, 1}) : everywhere_;
}

SurfaceBounds::SurfaceBounds(const opencascade::handle<Geom_Surface>& surface) : surface_(surface) {
    for (auto trimmed = opencascade::handle<Geom_RectangularTrimmedSurface>::DownCast(surface_); !trimmed.IsNull();
         trimmed = opencascade::handle<Geom_RectangularTrimmedSurface>::DownCast(surface_)) {
        surface_ = trimmed->BasisSurface();
    }
    const GeomAdaptor_Surface adaptor(surface_);
    if (adaptor.GetType() == GeomAbs_BSplineSurface) {
        grid_ = gridOf(adaptor.BSpline());
    } else if (adaptor.GetType() == GeomAbs_BezierSurface) {
        grid_ = gridOf(GeomConvert::SurfaceToBSplineSurface(adaptor.Bezier()));
    } else if (const auto swept = opencascade::handle<Geom_SweptSurface>::DownCast(surface_); !swept.IsNull()) {
        profile_.emplace(swept->BasisCurve());
    }
}

DerivativeBounds SurfaceBounds::over(const ParameterBox& box) const {
    if (grid_) {
        return grid_->over(box);
    }
    const GeomAdaptor_Surface adaptor(surface_);
    switch (adaptor.GetType()) {
    case GeomAbs_Plane:
        return {.u = 1, .v = 1};
    case GeomAbs_Cylinder: {
        const double radius = adaptor.Cylinder().Radius();
        return {.u = radius, .v = 1, .uu = radius};
    }
    case GeomAbs_Cone: {
        const double slope = std::sin(adaptor.Cone().SemiAngle());
        const double radius = std::max(std::abs(adaptor.Cone().RefRadius() + box.v0 * slope),
                                       std::abs(adaptor.Cone().RefRadius() + box.v1 * slope));
        return {.u = radius, .v = 1, .uu = radius, .uv = std::abs(slope)};
    }
    case GeomAbs_Sphere: {
        const double radius = adaptor.Sphere().Radius();
        const double ring = radius * largestCosine(box.v0, box.v1);
        return {.u = ring, .v = radius, .uu = ring, .uv = radius, .vv = radius};
    }
    case GeomAbs_Torus: {
        const double tube = std::abs(adaptor.Torus().MinorRadius());
        const double ring = std::abs(adaptor.Torus().MajorRadius()) + tube;
        return {.u = ring, .v = tube, .uu = ring, .uv = tube, .vv = tube};
    }
    case GeomAbs_SurfaceOfExtrusion: {
        const DerivativeBounds profile = profile_->over(box.u0, box.u1);
        return {.u = profile.u, .v = 1, .uu = profile.uu, .jumpU = profile.jumpU};
    }
    case GeomAbs_SurfaceOfRevolution: {
        const DerivativeBounds profile = profile_->over(box.v0, box.v1);
        const opencascade::handle<Adaptor3d_Curve> curve = adaptor.BasisCurve();
        const double middle = gp_Lin(adaptor.AxeOfRevolution()).Distance(curve->Value((box.v0 + box.v1) / 2));
        const double ring = middle + profile.u * box.sizeV() / 2;
        return {.u = ring, .v = profile.u, .uu = ring, .uv = profile.u, .vv = profile.uu, .jumpV = profile.jumpU};
    }
    default: // offsets
        return kUnknown;
    }
}

} // namespace voxtact::step
