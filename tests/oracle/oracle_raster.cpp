// SPDX-License-Identifier: MIT
#include "oracle/oracle_raster.h"
#include "core/base/infinity.h"

#include <algorithm>
#include <cmath>

namespace voxtact::oracle {

namespace {

template <std::size_t N>
std::array<double, N> mix(const std::array<double, N>& a, const std::array<double, N>& b, double t) {
    std::array<double, N> out{};
    for (std::size_t i = 0; i < N; ++i) {
        out[i] = a[i] + t * (b[i] - a[i]);
    }
    return out;
}

Corner mix(const Corner& a, const Corner& b, double t) {
    return {mix(a.clip, b.clip, t), mix(a.texture, b.texture, t), mix(a.clipError, b.clipError, t),
            mix(a.textureError, b.textureError, t)};
}

/// Keeps the part where `distance` is not negative. The new corner of an edge is reckoned from its inner end, so that
/// two triangles on either side of the edge get the same one.
template <class Distance> std::vector<Corner> cut(const std::vector<Corner>& polygon, const Distance& distance) {
    std::vector<Corner> out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Corner& a = polygon[i];
        const Corner& b = polygon[(i + 1) % polygon.size()];
        const double da = distance(a);
        const double db = distance(b);
        if (da >= 0) {
            out.push_back(a);
        }
        if ((da >= 0) != (db >= 0)) {
            out.push_back(da >= 0 ? mix(a, b, da / (da - db)) : mix(b, a, db / (db - da)));
        }
    }
    return out;
}

std::vector<Corner> cutToViewVolume(const Triangle& triangle, double slack) {
    std::vector<Corner> polygon(triangle.begin(), triangle.end());
    const auto error = [slack](const Corner& c, std::size_t axis) {
        return slack * (c.clipError[axis] + c.clipError[3]);
    };
    polygon = cut(polygon, [slack](const Corner& c) { return c.clip[2] + slack * c.clipError[2]; });
    polygon = cut(polygon, [&](const Corner& c) { return c.clip[3] - c.clip[2] + error(c, 2); });
    for (std::size_t axis = 0; axis < 2; ++axis) {
        polygon = cut(polygon, [&](const Corner& c) { return c.clip[3] + c.clip[axis] + error(c, axis); });
        polygon = cut(polygon, [&](const Corner& c) { return c.clip[3] - c.clip[axis] + error(c, axis); });
    }
    return polygon;
}

double toPixels(double normalised, std::uint32_t size) {
    return (normalised * 0.5 + 0.5) * size;
}

/// Pixels: what fixed function and plane equations in single precision lose in a viewport of this size.
double viewportRounding(const View& view) {
    return 4 * kFloatRounding * (static_cast<double>(view.width) + view.height);
}

ScreenCorner toScreen(const Corner& corner, const View& view) {
    const double w = corner.clip[3];
    const double x = corner.clip[0] / w;
    const double y = corner.clip[1] / w;
    const double dx = (corner.clipError[0] + std::abs(x) * corner.clipError[3]) / w * view.width / 2;
    const double dy = (corner.clipError[1] + std::abs(y) * corner.clipError[3]) / w * view.height / 2;
    ScreenCorner out;
    out.exactX = toPixels(x, view.width);
    out.exactY = toPixels(y, view.height);
    out.x = std::llround(out.exactX * kSubPixels);
    out.y = std::llround(out.exactY * kSubPixels);
    out.w = w;
    out.texture = corner.texture;
    out.textureError = corner.textureError;
    out.drift = std::hypot(dx, dy) + viewportRounding(view);
    return out;
}

std::int64_t centre(std::uint32_t pixel) {
    return 256 * std::int64_t{pixel} + 128;
}

/// Twice the signed area of a, b and the point. With y down it is positive to the right of an edge that goes up.
std::int64_t edgeFunction(const ScreenCorner& a, const ScreenCorner& b, std::int64_t x, std::int64_t y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

bool isTopOrLeft(const ScreenCorner& a, const ScreenCorner& b) {
    return b.y < a.y || (b.y == a.y && b.x > a.x);
}

std::optional<Vec3> coordinateInTriangle(const ScreenCorner& a, const ScreenCorner& second, const ScreenCorner& third,
                                         std::int64_t x, std::int64_t y) {
    const std::int64_t area = edgeFunction(a, second, third.x, third.y);
    if (area == 0) {
        return std::nullopt;
    }
    const ScreenCorner* corners[3] = {&a, area > 0 ? &second : &third, area > 0 ? &third : &second};
    double weights[3];
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const ScreenCorner& from = *corners[(i + 1) % 3];
        const ScreenCorner& to = *corners[(i + 2) % 3];
        const std::int64_t inside = edgeFunction(from, to, x, y);
        if (inside < 0 || (inside == 0 && !isTopOrLeft(from, to))) {
            return std::nullopt;
        }
        weights[i] = static_cast<double>(inside) / corners[i]->w;
        sum += weights[i];
    }
    Vec3 out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < 3; ++i) {
            out[axis] += weights[i] / sum * corners[i]->texture[axis];
        }
    }
    return out;
}

/// An edge of the outline, with the pixel's centre as the origin. Pixels.
struct Edge {
    double ax, ay, bx, by;
    double driftA, driftB;

    [[nodiscard]] double distanceAt(double t) const { return std::hypot(ax + t * (bx - ax), ay + t * (by - ay)); }
    [[nodiscard]] double distance() const {
        const double dx = bx - ax;
        const double dy = by - ay;
        const double squared = dx * dx + dy * dy;
        return distanceAt(squared > 0 ? std::clamp(-(ax * dx + ay * dy) / squared, 0.0, 1.0) : 0.0);
    }
    /// Least distance after each point has come nearer by its drift, which is linear along the edge on the screen
    /// because 1/w is. A convex function: sections find its minimum.
    [[nodiscard]] double distanceLessDrift() const {
        const auto value = [this](double t) { return distanceAt(t) - (driftA + t * (driftB - driftA)); };
        double lo = 0;
        double hi = 1;
        for (int i = 0; i < 80; ++i) {
            const double third = (hi - lo) / 3;
            if (value(lo + third) < value(hi - third)) {
                hi -= third;
            } else {
                lo += third;
            }
        }
        return std::min({value(0), value(1), value((lo + hi) / 2)});
    }
};

template <class Visitor> void forEachEdge(const Polygon& polygon, std::uint32_t x, std::uint32_t y, Visitor&& visit) {
    for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
        const ScreenCorner& a = polygon.corners[i];
        const ScreenCorner& b = polygon.corners[(i + 1) % polygon.corners.size()];
        const auto toCentre = [](std::int64_t at, std::uint32_t pixel) {
            return static_cast<double>(at - centre(pixel)) / kSubPixels;
        };
        visit(Edge{toCentre(a.x, x), toCentre(a.y, y), toCentre(b.x, x), toCentre(b.y, y), a.drift, b.drift});
    }
}

/// The screen polygon before the division again, in pixels from the centre of a pixel; clipError[0] is drift * w.
std::vector<Corner> undivide(const Polygon& polygon, std::uint32_t x, std::uint32_t y) {
    std::vector<Corner> out;
    for (const ScreenCorner& corner : polygon.corners) {
        const double px = static_cast<double>(corner.x - centre(x)) / kSubPixels;
        const double py = static_cast<double>(corner.y - centre(y)) / kSubPixels;
        out.push_back({{px * corner.w, py * corner.w, 0, corner.w},
                       corner.texture,
                       {corner.drift * corner.w, 0, 0, 0},
                       corner.textureError});
    }
    return out;
}

/// The part of an undivided polygon within `radius` of the origin along both axes.
std::vector<Corner> cutToSquare(std::vector<Corner> polygon, double radius) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
        polygon = cut(polygon, [&](const Corner& c) { return radius * c.clip[3] + c.clip[axis]; });
        polygon = cut(polygon, [&](const Corner& c) { return radius * c.clip[3] - c.clip[axis]; });
    }
    return polygon;
}

double greatestDrift(const std::vector<Corner>& undivided) {
    double out = 0;
    for (const Corner& corner : undivided) {
        out = std::max(out, corner.clipError[0] / corner.clip[3]);
    }
    return out;
}

template <class Corners> TextureBox boxOf(const Corners& corners) {
    TextureBox box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    for (const Corner& corner : corners) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lo[axis] = std::min(box.lo[axis], corner.texture[axis] - corner.textureError[axis]);
            box.hi[axis] = std::max(box.hi[axis], corner.texture[axis] + corner.textureError[axis]);
        }
    }
    return box;
}

std::array<double, 2> pixelsOf(const ScreenCorner& corner) {
    return {static_cast<double>(corner.x) / kSubPixels, static_cast<double>(corner.y) / kSubPixels};
}

double longestEdge(const Polygon& polygon) {
    double longest = 0;
    for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
        const auto a = pixelsOf(polygon.corners[i]);
        const auto b = pixelsOf(polygon.corners[(i + 1) % polygon.corners.size()]);
        longest = std::max(longest, std::hypot(b[0] - a[0], b[1] - a[1]));
    }
    return longest;
}

/// Pixels: twice the area over the longest edge.
template <class Place> double heightOf(const Polygon& polygon, const Place& place) {
    double doubledArea = 0;
    for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
        const auto a = place(polygon.corners[i]);
        const auto b = place(polygon.corners[(i + 1) % polygon.corners.size()]);
        // Relative to the first corner, so that nothing large cancels.
        const auto origin = place(polygon.corners.front());
        doubledArea += (a[0] - origin[0]) * (b[1] - origin[1]) - (b[0] - origin[0]) * (a[1] - origin[1]);
    }
    return std::abs(doubledArea) / std::max(longestEdge(polygon), 1 / kSubPixels);
}

} // namespace

Corner makeCorner(const Mat4& clip_from_object, const Mat4& texture_from_object, const Vec3& position) {
    const std::array<double, 4> point{position[0], position[1], position[2], 1};
    Corner out;
    for (std::size_t row = 0; row < 4; ++row) {
        for (std::size_t c = 0; c < 4; ++c) {
            const double term = clip_from_object[4 * c + row] * point[c];
            out.clip[row] += term;
            out.clipError[row] += kCornerRoundings * kFloatRounding * std::abs(term);
        }
    }
    for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t c = 0; c < 4; ++c) {
            const double term = texture_from_object[4 * c + row] * point[c];
            out.texture[row] += term;
            out.textureError[row] += kCornerRoundings * kFloatRounding * std::abs(term);
        }
    }
    return out;
}

void projectAlongDominantAxis(Triangle& triangle, const std::array<std::uint32_t, 3>& size) {
    std::array<Vec3, 3> voxels{};
    for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            voxels[i][axis] = triangle[i].texture[axis] * size[axis];
        }
    }
    Vec3 normal{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t b = (axis + 1) % 3;
        const std::size_t c = (axis + 2) % 3;
        normal[axis] = std::abs((voxels[1][b] - voxels[0][b]) * (voxels[2][c] - voxels[0][c]) -
                                (voxels[1][c] - voxels[0][c]) * (voxels[2][b] - voxels[0][b]));
    }
    const auto axis = static_cast<std::size_t>(std::max_element(normal.begin(), normal.end()) - normal.begin());
    const double half = *std::max_element(size.begin(), size.end()) / 2.0;
    for (std::size_t i = 0; i < 3; ++i) {
        Corner& corner = triangle[i];
        corner.clip = {-3, -3, 0.5, 1};
        corner.clipError = {};
        for (std::size_t k = 0; k < 2 && normal[axis] > 0; ++k) {
            const std::size_t along = (axis + 1 + k) % 3;
            corner.clip[k] = voxels[i][along] / half - 1;
            corner.clipError[k] =
                (corner.textureError[along] * size[along] / half) + 4 * kFloatRounding * (1 + std::abs(corner.clip[k]));
        }
    }
}

Polygon clipAndSnap(const Triangle& triangle, const View& view, ViewVolume volume) {
    const double slack = volume == ViewVolume::True ? 0.0 : volume == ViewVolume::Widened ? 1.0 : -1.0;
    Polygon out;
    for (const Corner& corner : cutToViewVolume(triangle, slack)) {
        if (!(corner.clip[3] > corner.clipError[3])) {
            return {{}, true};
        }
        out.corners.push_back(toScreen(corner, view));
    }
    return out;
}

std::optional<Vec3> coordinateWhereCovered(const Polygon& polygon, std::uint32_t x, std::uint32_t y) {
    for (std::size_t i = 2; i < polygon.corners.size(); ++i) {
        const std::optional<Vec3> found =
            coordinateInTriangle(polygon.corners[0], polygon.corners[i - 1], polygon.corners[i], centre(x), centre(y));
        if (found) {
            return found;
        }
    }
    return std::nullopt;
}

Vec3 extrapolatedCoordinate(const Triangle& triangle, const View& view, std::uint32_t x, std::uint32_t y) {
    const double nx = (x + 0.5) / view.width * 2 - 1;
    const double ny = (y + 0.5) / view.height * 2 - 1;
    Vec3 a{};
    Vec3 b{};
    for (std::size_t i = 0; i < 3; ++i) {
        a[i] = triangle[i].clip[0] - nx * triangle[i].clip[3];
        b[i] = triangle[i].clip[1] - ny * triangle[i].clip[3];
    }
    // Weights of the corners for which both weighted sums vanish.
    Vec3 weights{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    double sum = weights[0] + weights[1] + weights[2];
    constexpr double kEdgeOn = 1e-12;
    if (!(std::abs(sum) > kEdgeOn * (std::abs(weights[0]) + std::abs(weights[1]) + std::abs(weights[2])))) {
        weights = {1, 1, 1};
        sum = 3;
    }
    Vec3 out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < 3; ++i) {
            out[axis] += weights[i] / sum * triangle[i].texture[axis];
        }
    }
    return out;
}

double outlineDistance(const Polygon& polygon, std::uint32_t x, std::uint32_t y) {
    double least = kInfinity;
    forEachEdge(polygon, x, y, [&](const Edge& edge) { least = std::min(least, edge.distance()); });
    return least;
}

bool outlineMayPass(const Polygon& polygon, std::uint32_t x, std::uint32_t y, double pixels) {
    bool passes = polygon.undivided;
    forEachEdge(polygon, x, y, [&](const Edge& edge) {
        const bool near = edge.distance() <= pixels + std::max(edge.driftA, edge.driftB);
        passes = passes || (near && edge.distanceLessDrift() <= pixels);
    });
    return passes;
}

std::optional<TextureBox> reachableCoordinates(const Polygon& polygon, const View& view, std::uint32_t x,
                                               std::uint32_t y, double pixels) {
    const std::vector<Corner> whole = undivide(polygon, x, y);
    const double rounding = viewportRounding(view);
    // Twice: the drift far away, which may be large where w is small, is none of this pixel's business.
    const std::vector<Corner> near = cutToSquare(whole, pixels + greatestDrift(whole) + rounding);
    const std::vector<Corner> nearest = cutToSquare(whole, pixels + greatestDrift(near) + rounding);
    if (nearest.empty()) {
        return std::nullopt;
    }
    return boxOf(nearest);
}

TextureBox coordinatesOf(const Triangle& triangle) {
    return boxOf(triangle);
}

double planeError(const Polygon& polygon, const View& view) {
    const double height = std::min(heightOf(polygon, [](const ScreenCorner& c) { return pixelsOf(c); }),
                                   heightOf(polygon, [](const ScreenCorner& c) {
                                       return std::array{c.exactX, c.exactY};
                                   }));
    // Roundings in setting up and evaluating the plane.
    constexpr double kPlaneRoundings = 8;
    const double thinnest = std::max(height, 1e-9);
    const double anchor = static_cast<double>(std::max(view.width, view.height));
    return kPlaneRoundings * kFloatRounding * (longestEdge(polygon) + anchor) / thinnest;
}

} // namespace voxtact::oracle
