// SPDX-License-Identifier: MIT
#include "step/deflection.h"

#include "step/derivative_bounds.h"

#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomAPI.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Pln.hxx>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace voxtact::step {

namespace {

/// Halvings of the sides of a triangle of parameters; those of one whose remainder is not known.
constexpr int kMaxDepth = 6;
constexpr int kBlindDepth = 3;
/// Pieces of an edge between two nodes.
constexpr int kMaxArcParts = 64;

using Corners = std::array<gp_XYZ, 3>;

double toSegment(const gp_XYZ& point, const gp_XYZ& a, const gp_XYZ& b) {
    const gp_XYZ along = b - a;
    const double length = along.SquareModulus();
    const double part = length > 0 ? std::clamp((point - a).Dot(along) / length, 0.0, 1.0) : 0;
    return (point - a - part * along).Modulus();
}

double toTriangle(const gp_XYZ& point, const Corners& of) {
    const gp_XYZ normal = (of[1] - of[0]).Crossed(of[2] - of[0]);
    const double size = normal.Modulus();
    double nearest = HUGE_VAL;
    bool isInside = size > 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const gp_XYZ& next = of[(i + 1) % 3];
        isInside = isInside && (next - of[i]).Crossed(point - of[i]).Dot(normal) >= 0;
        nearest = std::min(nearest, toSegment(point, of[i], next));
    }
    return isInside ? std::abs((point - of[0]).Dot(normal)) / size : nearest;
}

/// The largest distance of a corner: no point of a flat triangle is farther from another, which is convex.
double toTriangle(const Corners& points, const Corners& of) {
    return std::max({toTriangle(points[0], of), toTriangle(points[1], of), toTriangle(points[2], of)});
}

ParameterBox boxAround(std::initializer_list<gp_XY> points) {
    ParameterBox box{HUGE_VAL, -HUGE_VAL, HUGE_VAL, -HUGE_VAL};
    for (const gp_XY& point : points) {
        box.u0 = std::min(box.u0, point.X());
        box.u1 = std::max(box.u1, point.X());
        box.v0 = std::min(box.v0, point.Y());
        box.v1 = std::max(box.v1, point.Y());
    }
    return box;
}

/// One face, in its own coordinates.
class FaceDeflection {
  public:
    FaceDeflection(const TopoDS_Face& face, double wanted)
        : face_(face), triangles_(BRep_Tool::Triangulation(face, location_)), wanted_(wanted) {
        TopLoc_Location ignored;
        const opencascade::handle<Geom_Surface> surface = BRep_Tool::Surface(face_, ignored);
        surface_.Load(surface);
        bounds_.emplace(surface);
    }

    /// In the coordinates of the shape.
    [[nodiscard]] double bound() {
        findPoles();
        for (int i = 1; i <= triangles_->NbTriangles(); ++i) {
            addTriangle(i);
        }
        for (TopExp_Explorer edges(face_, TopAbs_EDGE); edges.More(); edges.Next()) {
            addEdge(TopoDS::Edge(edges.Current()));
        }
        proven_ = proven_ && std::all_of(open_.begin(), open_.end(), [](const auto& side) { return side.second == 0; });
        const double scale = std::abs(location_.Transformation().ScaleFactor());
        return scale * (proven_ ? bound_ : 2 * sampled_);
    }
    [[nodiscard]] bool isProven() const { return proven_; }

  private:
    [[nodiscard]] gp_XY parameters(int node) const { return triangles_->UVNode(node).XY(); }
    [[nodiscard]] gp_XYZ place(int node) const { return triangles_->Node(node).XYZ(); }
    [[nodiscard]] gp_XYZ onSurface(const gp_XY& at) const { return surface_.Value(at.X(), at.Y()).XYZ(); }

    void add(double sampled, double between) {
        sampled_ = std::max(sampled_, sampled);
        bound_ = std::max(bound_, sampled + between);
        proven_ = proven_ && std::isfinite(between);
    }

    /// A side counts up in one direction, and down in the other.
    void addSide(int from, int to, int times) {
        if (from != to) {
            open_[std::minmax(from, to)] += from < to ? times : -times;
        }
    }

    [[nodiscard]] std::array<int, 3> nodesOf(int triangle) const {
        std::array<int, 3> nodes{};
        triangles_->Triangle(triangle).Get(nodes[0], nodes[1], nodes[2]);
        return nodes;
    }
    [[nodiscard]] Corners cornersOf(int triangle) const {
        const std::array<int, 3> nodes = nodesOf(triangle);
        return {place(nodes[0]), place(nodes[1]), place(nodes[2])};
    }

    /// Nodes at which an edge has no length, as at the poles of a sphere.
    void findPoles() {
        for (TopExp_Explorer edges(face_, TopAbs_EDGE); edges.More(); edges.Next()) {
            const TopoDS_Edge edge = TopoDS::Edge(edges.Current());
            const auto polygon = BRep_Tool::PolygonOnTriangulation(edge, triangles_, location_);
            for (int i = 1; BRep_Tool::Degenerated(edge) && !polygon.IsNull() && i <= polygon->NbNodes(); ++i) {
                const gp_XY along = parameters(polygon->Node(polygon->NbNodes())) - parameters(polygon->Node(1));
                const double u = std::abs(along.X());
                const double v = std::abs(along.Y());
                proven_ = proven_ && std::min(u, v) <= 1e-9 * std::max(u, v);
                poles_[polygon->Node(i)] = u > v;
            }
        }
    }

    void addTriangle(int triangle) {
        const std::array<int, 3> nodes = nodesOf(triangle);
        const std::array<gp_XY, 3> uv{parameters(nodes[0]), parameters(nodes[1]), parameters(nodes[2])};
        for (std::size_t corner = 0; corner < 3; ++corner) {
            addSide(nodes[corner], nodes[(corner + 1) % 3], 1);
        }
        const ParameterBox box = boxAround({uv[0], uv[1], uv[2]});
        const double area = (uv[1] - uv[0]).Crossed(uv[2] - uv[0]);
        proven_ = proven_ && area >= -1e-12 * box.sizeU() * box.sizeV();
        const auto poles = std::ranges::count_if(nodes, [this](int node) { return poles_.contains(node); });
        const Corners flat = cornersOf(triangle);
        if (poles == 0) {
            addPiece(flat, uv);
        } else if (poles == 1) {
            addSector(flat, uv, nodes);
        } else {
            // Two nodes at one place, and nothing between them; or the triangle goes from pole to pole.
            const double shortest =
                std::min({(flat[0] - flat[1]).Modulus(), (flat[1] - flat[2]).Modulus(), (flat[2] - flat[0]).Modulus()});
            proven_ = proven_ && shortest < 1e-6;
        }
    }

    /// A triangle at a pole. The parameters of all of them together are those between the sides that they have opposite
    /// to the pole and the edge there: so each may stand for those between its side and that edge.
    void addSector(const Corners& flat, const std::array<gp_XY, 3>& uv, const std::array<int, 3>& nodes) {
        std::size_t pole = 0;
        while (!poles_.contains(nodes[pole])) {
            ++pole;
        }
        const gp_XY at = uv[pole];
        const gp_XY a = uv[(pole + 1) % 3];
        const gp_XY b = uv[(pole + 2) % 3];
        const bool alongU = poles_[nodes[pole]];
        const gp_XY nextToA = alongU ? gp_XY(a.X(), at.Y()) : gp_XY(at.X(), a.Y());
        const gp_XY nextToB = alongU ? gp_XY(b.X(), at.Y()) : gp_XY(at.X(), b.Y());
        addPiece(flat, {a, b, nextToB});
        addPiece(flat, {a, nextToB, nextToA});
    }

    void addPiece(const Corners& flat, const std::array<gp_XY, 3>& uv) {
        addPiece(flat, uv, {onSurface(uv[0]), onSurface(uv[1]), onSurface(uv[2])}, 0);
    }

    /// The surface over a triangle of parameters, from its corners on the surface.
    void addPiece(const Corners& flat, const std::array<gp_XY, 3>& uv, const Corners& points, int depth) {
        const ParameterBox box = boxAround({uv[0], uv[1], uv[2]});
        const double between = bounds_->over(box).interpolationError(box);
        const double off = toTriangle(points, flat);
        const bool isEnough =
            std::isfinite(between) ? off + between <= std::max(wanted_, 1.1 * sampled_) : depth == kBlindDepth;
        if (isEnough || depth == kMaxDepth) {
            add(off, between);
            return;
        }
        const std::array<gp_XY, 3> middles{0.5 * (uv[0] + uv[1]), 0.5 * (uv[1] + uv[2]), 0.5 * (uv[2] + uv[0])};
        const Corners on{onSurface(middles[0]), onSurface(middles[1]), onSurface(middles[2])};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t before = (i + 2) % 3;
            addPiece(flat, {uv[i], middles[i], middles[before]}, {points[i], on[i], on[before]}, depth + 1);
        }
        addPiece(flat, middles, on, depth + 1);
    }

    /// Of an edge that a face has twice, one polygon is along each of its two curves of parameters.
    [[nodiscard]] opencascade::handle<Poly_PolygonOnTriangulation>
    polygonOf(const TopoDS_Edge& edge, const opencascade::handle<Geom2d_Curve>& curve) const {
        const auto miss = [&](const opencascade::handle<Poly_PolygonOnTriangulation>& polygon) {
            return polygon.IsNull() || !polygon->HasParameters()
                       ? HUGE_VAL
                       : (curve->Value(polygon->Parameter(1)).XY() - parameters(polygon->Node(1))).Modulus();
        };
        const auto one = BRep_Tool::PolygonOnTriangulation(edge, triangles_, location_);
        const auto other = BRep_Tool::PolygonOnTriangulation(TopoDS::Edge(edge.Reversed()), triangles_, location_);
        const auto& polygon = miss(other) < miss(one) ? other : one;
        return miss(polygon) < HUGE_VAL ? polygon : nullptr;
    }

    void addEdge(const TopoDS_Edge& edge) {
        double first = 0;
        double last = 0;
        const opencascade::handle<Geom2d_Curve> curve = BRep_Tool::CurveOnSurface(edge, face_, first, last);
        const auto polygon = curve.IsNull() ? nullptr : polygonOf(edge, curve);
        if (polygon.IsNull()) {
            proven_ = false;
            return;
        }
        const int times = edge.Orientation() == TopAbs_REVERSED ? 1 : edge.Orientation() == TopAbs_FORWARD ? -1 : 0;
        const opencascade::handle<Geom_Curve> flat = GeomAPI::To3d(curve, gp_Pln(gp::XOY()));
        const CurveBounds alongU(flat, {1, 0, 0});
        const CurveBounds alongV(flat, {0, 1, 0});
        for (int i = 1; i < polygon->NbNodes(); ++i) {
            addSide(polygon->Node(i), polygon->Node(i + 1), times);
            const double t0 = polygon->Parameter(i);
            const double t1 = polygon->Parameter(i + 1);
            const double begin = std::min(t0, t1);
            const double end = std::max(t0, t1);
            addArc(curve, {polygon->Node(i), polygon->Node(i + 1)}, {t0, t1}, alongU.over(begin, end),
                   alongV.over(begin, end));
        }
    }

    /// The region between an edge and its chord from a node to the next: points of the surface that no triangle of
    /// parameters covers. Each is between a point of the edge and one of the chord of parameters, and of two points
    /// that are near the chord in space, all between are.
    void addArc(const opencascade::handle<Geom2d_Curve>& curve, const std::array<int, 2>& nodes,
                const std::array<double, 2>& t, const DerivativeBounds& u, const DerivativeBounds& v) {
        const gp_XY from = parameters(nodes[0]);
        const gp_XY to = parameters(nodes[1]);
        const double miss =
            std::max((curve->Value(t[0]).XY() - from).Modulus(), (curve->Value(t[1]).XY() - to).Modulus());
        const ParameterBox span{0, std::abs(t[1] - t[0]), 0, 0};
        const double offU = u.interpolationError(span) + miss;
        const double offV = v.interpolationError(span) + miss;
        const ParameterBox chord = boxAround({from, to});
        const DerivativeBounds surface =
            bounds_->over({chord.u0 - offU, chord.u1 + offU, chord.v0 - offV, chord.v1 + offV});
        // The edge in space, by the chain rule, and the chord of parameters there.
        const DerivativeBounds arc{.uu = surface.uu * u.u * u.u + 2 * surface.uv * u.u * v.u + surface.vv * v.u * v.u +
                                         surface.u * u.uu + surface.v * v.uu,
                                   .jumpU = surface.jumpU * u.u + surface.jumpV * v.u + surface.u * u.jumpU +
                                            surface.v * v.jumpU};
        const auto between = [&](int parts) {
            return std::max(arc.interpolationError(span, parts), surface.interpolationError(chord, parts));
        };
        int parts = 1;
        while (parts < kMaxArcParts && between(parts) > wanted_ / 10) {
            parts *= 2;
        }
        double off = 0;
        for (int i = 0; i <= parts; ++i) {
            const double part = static_cast<double>(i) / parts;
            for (const gp_XY& at :
                 {curve->Value((1 - part) * t[0] + part * t[1]).XY(), (1 - part) * from + part * to}) {
                off = std::max(off, toSegment(onSurface(at), place(nodes[0]), place(nodes[1])));
            }
        }
        add(off, between(parts) + surface.interpolationError({0, offU, 0, offV}) + (surface.u + surface.v) * miss);
    }

    TopoDS_Face face_;
    TopLoc_Location location_;
    opencascade::handle<Poly_Triangulation> triangles_;
    GeomAdaptor_Surface surface_;
    std::optional<SurfaceBounds> bounds_;
    double wanted_;
    double sampled_ = 0;
    double bound_ = 0;
    bool proven_ = true;
    std::map<std::pair<int, int>, int> open_; ///< sides that no other triangle or edge has
    std::map<int, bool> poles_;               ///< nodes; whether the edge there is along u
};

} // namespace

Deflection deflectionOf(const TopoDS_Shape& shape, double wanted) {
    // mm: of evaluating surfaces and distances.
    constexpr double kRounding = 1e-9;
    Deflection out;
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
        FaceDeflection face(TopoDS::Face(faces.Current().Oriented(TopAbs_FORWARD)), wanted);
        out.bound = std::max(out.bound, face.bound() + kRounding);
        out.unprovenFaces += face.isProven() ? 0 : 1;
    }
    return out;
}

} // namespace voxtact::step
