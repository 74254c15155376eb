// SPDX-License-Identifier: MIT
#include "cli/render/mesh_distance.h"

#include "cli/draw/text.h"
#include "cli/draw/viridis.h"
#include "cli/output/progress.h"
#include "cli/render/fine_mesh.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "voxtact/cpu.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace voxtact::app {

namespace {

constexpr double kSteps = 20;   // maximum colour steps along an edge
constexpr double kFinest = 400; // fractions of the maximum: smaller differences are invisible
constexpr std::size_t kPointsAtOnce = 4096;
constexpr std::size_t kMaxTriangles = 300'000;

Colour toColour(const Rgb& rgb) {
    return {rgb[0] / 255.0, rgb[1] / 255.0, rgb[2] / 255.0};
}

/// Certain touches are red, as with the other paints.
Colour colourOf(const Bounds& bounds, double maximum) {
    if (bounds.upper == 0) {
        return MeshPaint{}.contactColour;
    }
    return toColour(viridis(std::isfinite(bounds.upper) ? (bounds.lower + bounds.upper) / 2 / maximum : 1));
}

/// Host objects for all distances.
struct HostScene {
    cpu::Volume volume;
    cpu::TransferFunction function;
    double threshold;
    std::span<const Mat4> poses;

    [[nodiscard]] cpu::BatchItem item(const cpu::Mesh& mesh) const { return {&mesh, &volume, &function, poses}; }
};

Result<HostScene> hostScene(const ShownPairs& pairs) {
    Result<cpu::Volume> volume = cpu::Volume::create(pairs.volume.view());
    VOXTACT_TRY(volume);
    Result<cpu::TransferFunction> function = cpu::TransferFunction::create(pairs.transferFunction);
    VOXTACT_TRY(function);
    return HostScene{std::move(*volume), std::move(*function), pairs.threshold, pairs.poses};
}

/// Distinct positions of a mesh's vertices, and the position of each vertex.
struct Places {
    std::vector<Vec3> points;
    std::vector<std::size_t> ofVertex;
};

Places placesOf(const MeshData& mesh) {
    Places places;
    std::map<Vec3, std::size_t> known;
    for (std::size_t at = 0; at < mesh.positions.size(); at += 3) {
        const Vec3 point{mesh.positions[at], mesh.positions[at + 1], mesh.positions[at + 2]};
        const auto [found, isNew] = known.try_emplace(point, places.points.size());
        if (isNew) {
            places.points.push_back(point);
        }
        places.ofVertex.push_back(found->second);
    }
    return places;
}

/// A triangle whose corners are one point has the distance of that point.
Result<cpu::Mesh> pointMesh(const Vec3& point) {
    std::array<double, 9> corners{};
    for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = point[i % 3];
    }
    constexpr std::array<std::uint32_t, 3> kIndices{0, 1, 2};
    return cpu::Mesh::create({corners, kIndices});
}

/// Appends the colours of the points: of all poses of the first, then of the next.
Result<void> colourPoints(std::span<const Vec3> points, const HostScene& scene, double maximum, cpu::HostEngine& engine,
                          std::vector<Colour>& colours) {
    std::vector<cpu::Mesh> meshes;
    meshes.reserve(points.size());
    for (const Vec3& point : points) {
        Result<cpu::Mesh> mesh = pointMesh(point);
        VOXTACT_TRY(mesh);
        meshes.push_back(std::move(*mesh));
    }
    std::vector<cpu::BatchItem> items;
    for (const cpu::Mesh& mesh : meshes) {
        items.push_back(scene.item(mesh));
    }
    const Distance question{.tolerance = maximum / kFinest, .maximum = maximum};
    const Result<DistanceAnswer> answer =
        engine.ask(question, {.items = items, .view = {}, .threshold = scene.threshold});
    VOXTACT_TRY(answer);
    for (const PairDistance& point : answer->pairs) {
        colours.push_back(colourOf(point.bounds, maximum));
    }
    return {};
}

/// Returns the colours of one mesh's vertices, pose by pose.
Result<std::vector<std::vector<Colour>>> coloursOf(const MeshData& mesh, const HostScene& scene, double maximum,
                                                   cpu::HostEngine& engine, bool progress) {
    const Places places = placesOf(mesh);
    Progress shown(progress, "points of the mesh", places.points.size());
    std::vector<Colour> ofPoints;
    const std::span<const Vec3> points(places.points);
    for (std::size_t first = 0; first < points.size(); first += kPointsAtOnce) {
        const std::size_t count = std::min(kPointsAtOnce, points.size() - first);
        VOXTACT_TRY(colourPoints(points.subspan(first, count), scene, maximum, engine, ofPoints));
        shown.update(first + count);
    }
    const std::size_t poses = scene.poses.size();
    std::vector<std::vector<Colour>> colours(poses);
    for (std::size_t pose = 0; pose < poses; ++pose) {
        for (const std::size_t place : places.ofVertex) {
            colours[pose].push_back(ofPoints[poses * place + pose]);
        }
    }
    return colours;
}

/// Returns the approximate scale of a transform.
double scaleOf(const Mat4& pose) {
    double squares = 0;
    for (std::size_t column = 0; column < 3; ++column) {
        for (std::size_t row = 0; row < 3; ++row) {
            squares += std::pow(pose[4 * column + row], 2);
        }
    }
    return std::sqrt(squares / 3);
}

/// Returns the position of a point in the picture; empty behind the eye.
std::optional<Point> pixelOf(const Vec3& world, const Mat4& clip_from_world, const Canvas& canvas) {
    std::array<double, 4> clip{};
    for (std::size_t row = 0; row < 4; ++row) {
        clip[row] = clip_from_world[12 + row];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            clip[row] += clip_from_world[4 * axis + row] * world[axis];
        }
    }
    constexpr double kFarAway = 100; // pictures; farther points are invisible
    const double x = clip[0] / clip[3];
    const double y = clip[1] / clip[3];
    if (!(clip[3] > 0 && std::abs(x) < kFarAway && std::abs(y) < kFarAway)) {
        return std::nullopt;
    }
    return Point{(x + 1) / 2 * canvas.width(), (y + 1) / 2 * canvas.height()};
}

} // namespace

MeshData meshForDistances(MeshData mesh, std::span<const Mat4> poses, double maximum) {
    double scale = 0;
    for (const Mat4& pose : poses) {
        scale = std::max(scale, scaleOf(pose));
    }
    return halveLongEdges(std::move(mesh), maximum / kSteps / scale, kMaxTriangles);
}

Result<MeshDistances> measureMeshes(const ShownPairs& pairs, double maximum, bool progress) {
    const Result<HostScene> scene = hostScene(pairs);
    VOXTACT_TRY(scene);
    Result<cpu::HostEngine> engine = cpu::HostEngine::create();
    VOXTACT_TRY(engine);
    MeshDistances out;
    out.maximum = maximum;
    for (const MeshData& data : pairs.meshes) {
        const Result<cpu::Mesh> mesh = cpu::Mesh::create(data.view());
        VOXTACT_TRY(mesh);
        const cpu::BatchItem item = scene->item(*mesh);
        Result<DistanceAnswer> answer =
            engine->ask(Distance{}, {.items = {&item, 1}, .view = {}, .threshold = pairs.threshold});
        VOXTACT_TRY(answer);
        out.pairs.insert(out.pairs.end(), answer->pairs.begin(), answer->pairs.end());
        Result<std::vector<std::vector<Colour>>> colours = coloursOf(data, *scene, maximum, *engine, progress);
        VOXTACT_TRY(colours);
        std::ranges::move(*colours, std::back_inserter(out.colours));
    }
    return out;
}

Legend distanceLegend(double maximum) {
    constexpr int kParts = 8;
    Legend out;
    out.unit = "mm";
    out.range = {0, maximum};
    for (int i = 0; i <= kParts; ++i) {
        const double share = static_cast<double>(i) / kParts;
        out.opacity.push_back({share * maximum, 1});
        out.colours.push_back({share * maximum, toColour(viridis(share))});
    }
    return out;
}

void drawClosest(Picture& picture, const MeshDistances& distances, const Mat4& clip_from_world) {
    Canvas canvas(picture.rgba, picture.width, picture.height);
    constexpr double kPlain = 512;
    const double unit = std::max(1.0, std::min(canvas.width(), canvas.height()) / kPlain);
    const double text = 13 * unit;
    for (const PairDistance& pair : distances.pairs) {
        if (!pair.closest || pair.bounds.upper == 0) {
            continue;
        }
        const std::optional<Point> from = pixelOf(pair.closest->mesh, clip_from_world, canvas);
        const std::optional<Point> to = pixelOf(pair.closest->volume, clip_from_world, canvas);
        if (!from || !to) {
            continue;
        }
        constexpr Colour kInk{1, 1, 1};
        constexpr Colour kRim{0, 0, 0};
        canvas.line(*from, *to, 3.5 * unit, kRim, 0.7);
        for (const Point& end : {*from, *to}) {
            canvas.dot(end, 7 * unit, kRim, 0.7);
        }
        canvas.line(*from, *to, 1.6 * unit, kInk);
        for (const Point& end : {*from, *to}) {
            canvas.dot(end, 4.5 * unit, kInk);
        }
        // Rounds down: shows only certain distance.
        const std::string length = number(std::floor(100 * pair.bounds.lower) / 100) + " mm";
        drawText(canvas, length, text,
                 {(from->x + to->x) / 2 + 0.6 * text, (from->y + to->y) / 2 + capitalHeight(text) / 2});
    }
}

} // namespace voxtact::app
