// SPDX-License-Identifier: MIT
// OBB trees: what the boxes hold, what the descent keeps, and meshes that have no directions of their own.
#include "bench/engines/obb_tree.h"
#include "core/geometry/mesh_vertex.h"
#include "support/scenes.h"
#include "voxtact/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace voxtact::test {
namespace {

using Long3 = std::array<long double, 3>;

Long3 minus(const Long3& a, const Long3& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

long double dot(const Long3& a, const Long3& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Long3 cross(const Long3& a, const Long3& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Long3 wide(const Vec3& a) {
    return {a[0], a[1], a[2]};
}

/// Solves for the point's coordinates along the node's axes: nothing here supposes that these are at right angles.
bool holds(const ObbNode& node, const Vec3& point) {
    const Long3 from = minus(wide(point), wide(node.centre));
    const Long3 axes[3] = {wide(node.axes[0]), wide(node.axes[1]), wide(node.axes[2])};
    const long double volume = dot(axes[0], cross(axes[1], axes[2]));
    bool inside = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const long double at = dot(from, cross(axes[(i + 1) % 3], axes[(i + 2) % 3])) / volume;
        inside = inside && std::abs(at) <= node.half[i];
    }
    return inside;
}

std::uint32_t depthOf(const ObbTree& tree) {
    std::uint32_t deepest = 0;
    std::vector<std::uint32_t> ends; // of the nodes around the current one
    for (std::uint32_t at = 0; at < tree.nodes.size(); ++at) {
        while (!ends.empty() && ends.back() <= at) {
            ends.pop_back();
        }
        deepest = std::max(deepest, static_cast<std::uint32_t>(ends.size()));
        ends.push_back(tree.nodes[at].next);
    }
    return deepest;
}

void checkTree(const MeshData& mesh) {
    const ObbTree tree = makeObbTree(mesh.view());
    const std::size_t triangles = mesh.indices.size() / 3;
    std::vector<std::uint32_t> sorted = tree.triangles;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> all(triangles);
    std::iota(all.begin(), all.end(), 0U);
    ASSERT_EQ(sorted, all);
    ASSERT_EQ(tree.nodes.size(), 2 * triangles - 1);
    ASSERT_EQ(tree.nodes[0].triangleCount, triangles);
    for (std::uint32_t at = 0; at < tree.nodes.size(); ++at) {
        const ObbNode& node = tree.nodes[at];
        for (std::uint32_t i = node.firstTriangle; i < node.firstTriangle + node.triangleCount; ++i) {
            for (std::size_t corner = 0; corner < 3; ++corner) {
                ASSERT_TRUE(holds(
                    node, vertexOf(mesh.view(), mesh.view().indices[std::size_t{3} * tree.triangles[i] + corner])))
                    << "node " << at;
            }
        }
        if (node.triangleCount <= kObbLeafTriangles) {
            ASSERT_EQ(node.next, at + 1);
            continue;
        }
        const ObbNode& left = tree.nodes[at + 1];
        const ObbNode& right = tree.nodes[left.next];
        ASSERT_EQ(left.firstTriangle, node.firstTriangle);
        ASSERT_EQ(right.firstTriangle, node.firstTriangle + left.triangleCount);
        ASSERT_EQ(left.triangleCount + right.triangleCount, node.triangleCount);
        ASSERT_EQ(right.next, node.next);
    }
    ASSERT_EQ(touchingTriangles(tree, [](const ObbNode&) { return true; }), tree.triangles);
    ASSERT_TRUE(touchingTriangles(tree, [](const ObbNode&) { return false; }).empty());
    const ObbTree again = makeObbTree(mesh.view());
    ASSERT_EQ(again.triangles, tree.triangles);
    for (std::size_t at = 0; at < tree.nodes.size(); ++at) {
        ASSERT_EQ(again.nodes[at].centre, tree.nodes[at].centre);
        ASSERT_EQ(again.nodes[at].axes, tree.nodes[at].axes);
        ASSERT_EQ(again.nodes[at].half, tree.nodes[at].half);
    }
}

/// Triangles whose corners are `cornerOf(i)`.
template <class CornerOf> MeshData makeMesh(std::uint32_t triangles, CornerOf&& cornerOf) {
    MeshData mesh;
    for (std::uint32_t i = 0; i < 3 * triangles; ++i) {
        const Vec3 corner = cornerOf(i);
        for (const double coordinate : corner) {
            mesh.positions.push_back(static_cast<float>(coordinate));
        }
        mesh.indices.push_back(i);
    }
    return mesh;
}

Vec3 randomPoint(std::mt19937_64& random, double size) {
    return {uniform(random, -size, size), uniform(random, -size, size), uniform(random, -size, size)};
}

MeshData soup(std::mt19937_64& random, std::uint32_t triangles, double size) {
    Vec3 at{};
    return makeMesh(triangles, [&](std::uint32_t corner) {
        at = corner % 3 == 0 ? randomPoint(random, 1) : at;
        const Vec3 off = randomPoint(random, size);
        return Vec3{at[0] + off[0], at[1] + off[1], at[2] + off[2]};
    });
}

TEST(ObbTrees, HoldTheirTriangles) {
    std::mt19937_64 random(testSeed());
    checkTree(std::move(makeScalpel()).value());
    checkTree(std::move(makeEllipsoid(2000)).value());
    checkTree(makeCube(-1, 2));
    for (int round = 0; round < 100; ++round) {
        const auto triangles = static_cast<std::uint32_t>(uniform(random, 1, 60));
        checkTree(soup(random, triangles, std::pow(10, uniform(random, -3, 1))));
    }
}

TEST(ObbTrees, MeshesWithoutDirections) {
    std::mt19937_64 random(testSeed());
    const Vec3 point = randomPoint(random, 100);
    const Vec3 along = randomPoint(random, 10);
    checkTree(makeMesh(50, [&](std::uint32_t) { return point; }));
    checkTree(makeMesh(50, [&](std::uint32_t i) { // one triangle, many times
        return Vec3{i % 3 == 0 ? 1.0 : 0.0, i % 3 == 1 ? 1.0 : 0.0, i % 3 == 2 ? 1.0 : 0.0};
    }));
    checkTree(makeMesh(50, [&](std::uint32_t) { // a line
        const double t = uniform(random, 0, 1);
        return Vec3{point[0] + t * along[0], point[1] + t * along[1], point[2] + t * along[2]};
    }));
    checkTree(makeMesh(50, [&](std::uint32_t) { return Vec3{uniform(random, 0, 1), uniform(random, 0, 1), 7}; }));
    checkTree(makeMesh(50, [&](std::uint32_t) { return randomPoint(random, 3e38); }));
    checkTree(makeMesh(50, [&](std::uint32_t) { return randomPoint(random, 1e-40); }));
    checkTree(makeMesh(200, [&](std::uint32_t i) { // each one twice as far as the last
        const double at = std::ldexp(1.0, static_cast<int>(i / 3) - 100);
        return Vec3{at, i % 3 == 1 ? at : 0, 0};
    }));
    checkTree(makeMesh(50, [&](std::uint32_t) { // far away and small
        const Vec3 off = randomPoint(random, 1e-3);
        return Vec3{1e4 + off[0], -1e4 + off[1], 1e4 + off[2]};
    }));
}

void checkDepth(const MeshData& mesh) {
    const std::size_t triangles = mesh.indices.size() / 3;
    const double least = std::log2(static_cast<double>(triangles));
    const std::uint32_t depth = depthOf(makeObbTree(mesh.view()));
    EXPECT_GE(depth, least) << triangles;
    EXPECT_LE(depth, 1.5 * least) << triangles;
}

TEST(ObbTrees, AreNotDeep) {
    checkDepth(std::move(makeEllipsoid(500)).value());
    checkDepth(std::move(makeEllipsoid(20000)).value());
    checkDepth(std::move(makeScalpel()).value());
}

Mat4 randomAffine(std::mt19937_64& random) {
    Mat4 stretch = identity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        stretch[5 * axis] = std::pow(10, uniform(random, -1.5, 0.5)) * (uniform(random, 0, 1) < 0.2 ? -1 : 1);
    }
    stretch[4] = uniform(random, 0, 1) < 0.5 ? 0 : uniform(random, -0.5, 0.5);
    const Mat4 turned = multiply(randomRotation(random), multiply(stretch, randomRotation(random)));
    return multiply(translation(randomPoint(random, 0.3)), turned);
}

Box randomBox(std::mt19937_64& random) {
    Box box;
    const double size = std::pow(10, uniform(random, -1.5, 0.5));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = uniform(random, -1, 0.5);
        box.hi[axis] = box.lo[axis] + (uniform(random, 0, 1) < 0.1 ? 0 : uniform(random, 0, size));
    }
    return box;
}

/// The farthest point of a box's image along a direction, box and matrix as of obbMeetsBox(); the box negated and
/// added: a point of their Minkowski difference.
Long3 support(const ObbNode& node, const Mat4& matrix, const Box& box, const Long3& direction) {
    Long3 out{};
    std::array<Long3, 3> edges{};
    for (std::size_t row = 0; row < 3; ++row) {
        out[row] = matrix[12 + row] - (direction[row] >= 0 ? box.lo[row] : box.hi[row]);
        for (std::size_t column = 0; column < 3; ++column) {
            const long double element = matrix[4 * column + row];
            out[row] += element * node.centre[column];
            for (std::size_t i = 0; i < 3; ++i) {
                edges[i][row] += element * node.axes[i][column] * node.half[i];
            }
        }
    }
    for (const Long3& edge : edges) {
        const long double sign = dot(edge, direction) >= 0 ? 1 : -1;
        out = {out[0] + sign * edge[0], out[1] + sign * edge[1], out[2] + sign * edge[2]};
    }
    return out;
}

enum class Distance { Apart, Meeting, Unknown };

/// Whether one of many random points of the node's box is in the other.
bool shareASample(const ObbNode& node, const Mat4& matrix, const Box& box, std::mt19937_64& random) {
    for (int sample = 0; sample < 300; ++sample) {
        Vec3 point = node.centre;
        for (std::size_t i = 0; i < 3; ++i) {
            const double along = uniform(random, -1, 1) * node.half[i];
            for (std::size_t row = 0; row < 3; ++row) {
                point[row] += along * node.axes[i][row];
            }
        }
        const Vec3 at = transformPoint(matrix, point);
        bool inside = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            inside = inside && box.lo[axis] + 1e-9 <= at[axis] && at[axis] <= box.hi[axis] - 1e-9;
        }
        if (inside) {
            return true;
        }
    }
    return false;
}

/// Gilbert's algorithm for the point of the difference that is nearest to 0: no axis is tried out in it.
Distance distanceOf(const ObbNode& node, const Mat4& matrix, const Box& box, std::mt19937_64& random) {
    if (shareASample(node, matrix, box, random)) {
        return Distance::Meeting;
    }
    Long3 nearest = support(node, matrix, box, {1, 0, 0});
    for (int step = 0; step < 1000; ++step) {
        const long double squared = dot(nearest, nearest);
        if (squared < 1e-20L) {
            return Distance::Unknown;
        }
        const Long3 next = support(node, matrix, box, {-nearest[0], -nearest[1], -nearest[2]});
        if (dot(next, nearest) > 1e-9L * std::sqrt(squared)) {
            return Distance::Apart; // all of the difference is beyond a plane that 0 is not
        }
        const Long3 way = minus(next, nearest);
        const long double t = std::clamp(-dot(nearest, way) / dot(way, way), 0.0L, 1.0L);
        nearest = {nearest[0] + t * way[0], nearest[1] + t * way[1], nearest[2] + t * way[2]};
    }
    return Distance::Unknown;
}

TEST(ObbTrees, ABoxIsMetWhereItIsAndNowhereElse) {
    std::mt19937_64 random(testSeed());
    std::size_t apart = 0;
    std::size_t meeting = 0;
    for (int round = 0; round < 10000; ++round) {
        ObbNode node;
        const Mat4 turn = randomRotation(random);
        node.centre = randomPoint(random, 0.5);
        for (std::size_t i = 0; i < 3; ++i) {
            node.axes[i] = {turn[4 * i], turn[4 * i + 1], turn[4 * i + 2]};
            node.half[i] = uniform(random, 0, 1) < 0.1 ? 0 : std::pow(10, uniform(random, -2, 0));
        }
        const Mat4 matrix = randomAffine(random);
        const Box box = randomBox(random);
        const Distance distance = distanceOf(node, matrix, box, random);
        if (distance == Distance::Unknown) {
            continue;
        }
        ASSERT_EQ(obbMeetsBox(node, matrix, box), distance == Distance::Meeting);
        ++(distance == Distance::Meeting ? meeting : apart);
    }
    EXPECT_GT(apart, 1000U);
    EXPECT_GT(meeting, 100U);
}

TEST(ObbTrees, TouchingIsMeeting) {
    const ObbNode node{{0.5, 0.5, 0.5}, {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, {0.5, 0.5, 0.5}, 0, 1, 1};
    for (const double offset : {0.0, 1000.0, -1e6}) {
        const Mat4 matrix = translation({offset, offset, offset});
        const auto meets = [&](const Vec3& lo) {
            const Vec3 at{offset + lo[0], offset + lo[1], offset + lo[2]};
            return obbMeetsBox(node, matrix, {at, {at[0] + 1, at[1] + 1, at[2] + 1}});
        };
        EXPECT_TRUE(meets({1, 0, 0}));
        EXPECT_TRUE(meets({-1, 1, 0}));
        EXPECT_TRUE(meets({1, 1, -1}));
        EXPECT_TRUE(meets({1 + 1e-15, 0, 0})) << "in doubt";
        EXPECT_FALSE(meets({1 + 1e-6, 0, 0}));
        EXPECT_FALSE(meets({0, 0, -1 - 1e-6}));
    }
    Mat4 broken = identity();
    broken[12] = std::nan("");
    EXPECT_TRUE(obbMeetsBox(node, broken, {{5, 5, 5}, {6, 6, 6}})) << "in doubt";
}

/// Whether a point of the triangle is certainly in the box: what is left of it when it is cut at the box's faces.
bool certainlyMeets(std::vector<Long3> polygon, const Box& box) {
    for (std::size_t face = 0; face < 6 && !polygon.empty(); ++face) {
        const std::size_t axis = face / 2;
        const long double margin = 1e-12L;
        const auto depth = [&](const Long3& at) {
            return (face % 2 == 0 ? at[axis] - box.lo[axis] : box.hi[axis] - at[axis]) - margin;
        };
        std::vector<Long3> kept;
        for (std::size_t i = 0; i < polygon.size(); ++i) {
            const Long3& a = polygon[i];
            const Long3& b = polygon[(i + 1) % polygon.size()];
            const long double depthA = depth(a);
            const long double depthB = depth(b);
            if (depthA >= 0) {
                kept.push_back(a);
            }
            if ((depthA >= 0) != (depthB >= 0)) {
                const long double t = depthA / (depthA - depthB);
                kept.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2])});
            }
        }
        polygon = std::move(kept);
    }
    return !polygon.empty();
}

std::vector<Long3> transformed(const MeshData& mesh, std::uint32_t triangle, const Mat4& matrix) {
    std::vector<Long3> corners;
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const Vec3 vertex = vertexOf(mesh.view(), mesh.view().indices[std::size_t{3} * triangle + corner]);
        Long3 at{};
        for (std::size_t row = 0; row < 3; ++row) {
            at[row] = matrix[12 + row];
            for (std::size_t column = 0; column < 3; ++column) {
                at[row] += static_cast<long double>(matrix[4 * column + row]) * vertex[column];
            }
        }
        corners.push_back(at);
    }
    return corners;
}

void checkDescent(const MeshData& mesh, double scale, std::mt19937_64& random, std::size_t& met, std::size_t& kept) {
    const ObbTree tree = makeObbTree(mesh.view());
    for (int round = 0; round < 20; ++round) {
        Mat4 shrink = identity();
        shrink[0] = shrink[5] = shrink[10] = scale;
        const Mat4 matrix = multiply(randomAffine(random), shrink);
        const Box box = randomBox(random);
        std::vector<std::uint32_t> found =
            touchingTriangles(tree, [&](const ObbNode& node) { return obbMeetsBox(node, matrix, box); });
        kept += found.size();
        std::sort(found.begin(), found.end());
        for (std::uint32_t triangle = 0; triangle < mesh.indices.size() / 3; ++triangle) {
            if (certainlyMeets(transformed(mesh, triangle, matrix), box)) {
                ++met;
                ASSERT_TRUE(std::binary_search(found.begin(), found.end(), triangle)) << triangle;
            }
        }
    }
}

TEST(ObbTrees, TheDescentLosesNoTriangle) {
    std::mt19937_64 random(testSeed());
    std::size_t met = 0;
    std::size_t kept = 0;
    checkDescent(std::move(makeScalpel()).value(), 1.0 / 75, random, met, kept);
    checkDescent(std::move(makeEllipsoid(3000)).value(), 1.0 / 40, random, met, kept);
    for (int round = 0; round < 100; ++round) {
        checkDescent(soup(random, 40, std::pow(10, uniform(random, -2, 0))), 1, random, met, kept);
    }
    EXPECT_GT(met, 500U);
    EXPECT_LT(kept, 2 * met) << "the boxes of the leaves are tight";
}

} // namespace
} // namespace voxtact::test
