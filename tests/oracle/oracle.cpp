// SPDX-License-Identifier: MIT
#include "oracle/oracle.h"
#include "core/base/guard.h"
#include "core/base/infinity.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "core/geometry/projection.h"
#include "oracle/oracle_raster.h"
#include "oracle/oracle_sample.h"

#include <algorithm>
#include <cmath>

namespace voxtact::oracle {

namespace {

using oracle::Polygon;
using oracle::TextureBox;
using oracle::Triangle;
using oracle::ViewVolume;

/// A pair that has passed the checks.
struct Scene {
    MeshView mesh;
    VolumeView volume;
    View view;
    oracle::Table table;
    Mat4 clip_from_object{};
    Mat4 texture_from_object{};
    double threshold = 0;
    bool dominantAxis = false;
};

Error refuse(std::string text, ErrorCode code = ErrorCode::InvalidArgument) {
    return Error{code, 0, std::move(text)};
}

Result<void> checkView(const View& view) {
    const std::string size = std::to_string(view.width) + "x" + std::to_string(view.height);
    if (view.width == 0 || view.height == 0) {
        return refuse("the viewport is " + size + ", it needs at least one pixel");
    }
    if (view.width > cpu::kMaxViewport || view.height > cpu::kMaxViewport) {
        return refuse("the viewport is " + size + ", the limit is " + std::to_string(cpu::kMaxViewport) + " a side",
                      ErrorCode::LimitExceeded);
    }
    if (const Result<Mat4> world_from_clip = inverse(view.clip_from_world); !world_from_clip.ok()) {
        return refuse("the camera's clip_from_world cannot be used: " + world_from_clip.error().text);
    }
    return {};
}

Result<void> checkTolerance(const Tolerance& tolerance) {
    for (const double part : {tolerance.pixels, tolerance.weight, tolerance.value}) {
        if (!(part >= 0) || !std::isfinite(part)) {
            return refuse("a tolerance is " + number(part) + ", it must be finite and not negative");
        }
    }
    return {};
}

/// The view, or without a camera the viewport.
View viewOf(const OraclePair& pair) {
    if (pair.projection != Projection::DominantAxis) {
        return pair.view;
    }
    const auto side = static_cast<std::uint32_t>(dominantSide(pair.volume.grid, pair.samplesPerVoxel));
    return {identity(), side, side};
}

Result<void> checkPair(const OraclePair& pair) {
    VOXTACT_TRY(checkMesh(pair.mesh));
    VOXTACT_TRY(checkVolume(pair.volume));
    VOXTACT_TRY(checkView(viewOf(pair)));
    VOXTACT_TRY(checkFact(factOf("scene", "opacity_threshold"), pair.threshold));
    return checkAffine(pair.world_from_object, "the pose");
}

Result<Scene> prepare(const OraclePair& pair) {
    VOXTACT_TRY(checkPair(pair));
    Result<std::vector<float>> entries = sampleTable(pair.transferFunction);
    VOXTACT_TRY(entries);
    const Result<Mat4> texture_from_world = textureFromWorld(pair.volume.grid);
    VOXTACT_TRY(texture_from_world);
    Scene scene;
    scene.mesh = pair.mesh;
    scene.volume = pair.volume;
    scene.view = viewOf(pair);
    scene.dominantAxis = pair.projection == Projection::DominantAxis;
    scene.table = {std::move(*entries), tableDomain(pair.transferFunction)};
    scene.clip_from_object = multiply(scene.view.clip_from_world, pair.world_from_object);
    scene.texture_from_object = multiply(*texture_from_world, pair.world_from_object);
    scene.threshold = static_cast<double>(static_cast<float>(pair.threshold));
    return scene;
}

Triangle triangleOf(const Scene& scene, std::size_t number) {
    Triangle out;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t at = std::size_t{3} * scene.mesh.indices[3 * number + i];
        Vec3 position{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            position[axis] = scene.mesh.positions[at + axis];
        }
        out[i] = oracle::makeCorner(scene.clip_from_object, scene.texture_from_object, position);
    }
    if (scene.dominantAxis) {
        oracle::projectAlongDominantAxis(out, scene.volume.grid.size);
    }
    return out;
}

double domainDistance(const Vec3& coordinate) {
    double least = kInfinity;
    for (const double c : coordinate) {
        least = std::min({least, c, 1 - c});
    }
    return least;
}

/// The fragment program.
bool survives(const Scene& scene, const Vec3& coordinate) {
    return domainDistance(coordinate) >= 0 &&
           oracle::lookUp(scene.table, oracle::sampleVolume(scene.volume, coordinate)) >= scene.threshold;
}

void appendSurvivors(const Scene& scene, std::uint32_t number, std::vector<OracleFragment>& out) {
    const Polygon polygon = oracle::clipAndSnap(triangleOf(scene, number), scene.view, ViewVolume::True);
    std::int64_t lo[2] = {std::int64_t{scene.view.width} - 1, std::int64_t{scene.view.height} - 1};
    std::int64_t hi[2] = {0, 0};
    for (const oracle::ScreenCorner& corner : polygon.corners) {
        lo[0] = std::min(lo[0], corner.x / 256);
        lo[1] = std::min(lo[1], corner.y / 256);
        hi[0] = std::max(hi[0], std::min(corner.x / 256, std::int64_t{scene.view.width} - 1));
        hi[1] = std::max(hi[1], std::min(corner.y / 256, std::int64_t{scene.view.height} - 1));
    }
    for (std::int64_t row = std::max<std::int64_t>(lo[1], 0); row <= hi[1]; ++row) {
        for (std::int64_t column = std::max<std::int64_t>(lo[0], 0); column <= hi[0]; ++column) {
            const auto x = static_cast<std::uint32_t>(column);
            const auto y = static_cast<std::uint32_t>(row);
            const std::optional<Vec3> coordinate = oracle::coordinateWhereCovered(polygon, x, y);
            if (coordinate && survives(scene, *coordinate)) {
                out.push_back({number, x, y});
            }
        }
    }
}

/// What every rasteriser within the tolerance says to a test.
enum class Vote : std::uint32_t { No, Mixed, Yes };

struct Reach {
    Vote coverage = Vote::No;
    TextureBox box; ///< of the coordinate, where the coverage is not No
};

/// Widens a box by a share of another's extent.
void widen(TextureBox& box, double share, const TextureBox& whole) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double by = share * (whole.hi[axis] - whole.lo[axis]);
        box.lo[axis] -= by;
        box.hi[axis] += by;
    }
}

/// Widens a box to hold a coordinate.
void include(TextureBox& box, const Vec3& coordinate) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lo[axis] = std::min(box.lo[axis], coordinate[axis]);
        box.hi[axis] = std::max(box.hi[axis], coordinate[axis]);
    }
}

Reach reachOf(const Scene& scene, const Triangle& triangle, const OracleFragment& at, double pixels) {
    const Polygon most = oracle::clipAndSnap(triangle, scene.view, ViewVolume::Widened);
    if (most.undivided) {
        return {Vote::Mixed, oracle::coordinatesOf(triangle)};
    }
    const bool mostCovers = oracle::coordinateWhereCovered(most, at.x, at.y).has_value();
    if (!mostCovers && !oracle::outlineMayPass(most, at.x, at.y, pixels)) {
        return {};
    }
    const Polygon least = oracle::clipAndSnap(triangle, scene.view, ViewVolume::Narrowed);
    const bool leastCovers = oracle::coordinateWhereCovered(least, at.x, at.y).has_value();
    const bool certain = leastCovers && !oracle::outlineMayPass(least, at.x, at.y, pixels);
    std::optional<TextureBox> box = oracle::reachableCoordinates(most, scene.view, at.x, at.y, pixels);
    if (!box) {
        box = oracle::coordinatesOf(triangle);
    }
    // A rasteriser may interpolate between the corners as they were before snapping (llvmpipe does). Where the centre
    // is outside of those, that extrapolates: in a sliver by many times its extent.
    include(*box, oracle::extrapolatedCoordinate(triangle, scene.view, at.x, at.y));
    widen(*box, oracle::planeError(most, scene.view), oracle::coordinatesOf(triangle));
    return {certain ? Vote::Yes : Vote::Mixed, *box};
}

Vote voteOnDomain(const TextureBox& box) {
    Vote vote = Vote::Yes;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (box.hi[axis] < 0 || box.lo[axis] > 1) {
            return Vote::No;
        }
        if (box.lo[axis] < 0 || box.hi[axis] > 1) {
            vote = Vote::Mixed;
        }
    }
    return vote;
}

Vote voteOnOpacity(const Scene& scene, const ValueRange& opacity) {
    if (opacity.hi < scene.threshold) {
        return Vote::No;
    }
    return opacity.lo >= scene.threshold ? Vote::Yes : Vote::Mixed;
}

Doubt doubtOf(Vote coverage, Vote domain, Vote opacity) {
    if (coverage == Vote::No || domain == Vote::No || opacity == Vote::No) {
        return Doubt::None;
    }
    if (coverage == Vote::Mixed) {
        return Doubt::Coverage;
    }
    if (domain == Vote::Mixed) {
        return Doubt::Coordinate;
    }
    return opacity == Vote::Mixed ? Doubt::Opacity : Doubt::None;
}

double edgeDistance(const Polygon& polygon, const OracleFragment& at, bool covered) {
    const double distance = oracle::outlineDistance(polygon, at.x, at.y);
    return covered ? distance : -distance;
}

Vec3 clampTo(const TextureBox& box, Vec3 coordinate) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        coordinate[axis] = std::clamp(coordinate[axis], box.lo[axis], box.hi[axis]);
    }
    return coordinate;
}

Evidence evidenceOf(const Scene& scene, const OracleFragment& fragment, const Tolerance& tolerance) {
    const Triangle triangle = triangleOf(scene, fragment.triangle);
    const Polygon polygon = oracle::clipAndSnap(triangle, scene.view, ViewVolume::True);
    const std::optional<Vec3> found = oracle::coordinateWhereCovered(polygon, fragment.x, fragment.y);
    Reach reach = reachOf(scene, triangle, fragment, tolerance.pixels);

    Evidence out;
    out.covered = found.has_value();
    out.edgeDistance = edgeDistance(polygon, fragment, out.covered);
    out.coordinate = found ? *found : oracle::extrapolatedCoordinate(triangle, scene.view, fragment.x, fragment.y);
    if (reach.coverage == Vote::No) {
        reach.box = {out.coordinate, out.coordinate};
    } else if (out.covered) {
        include(reach.box, out.coordinate);
    } else {
        out.coordinate = clampTo(reach.box, out.coordinate);
    }
    out.domainDistance = domainDistance(out.coordinate);
    out.opacity = oracle::lookUp(scene.table, oracle::sampleVolume(scene.volume, out.coordinate));
    out.survives = out.covered && survives(scene, out.coordinate);
    const ValueRange opacity =
        oracle::opacityRange(scene.volume, scene.table, reach.box, {tolerance.weight, tolerance.value});
    out.opacityLow = opacity.lo;
    out.opacityHigh = opacity.hi;
    out.doubt = doubtOf(reach.coverage, voteOnDomain(reach.box), voteOnOpacity(scene, opacity));
    return out;
}

Result<void> checkFragment(const Scene& scene, const OracleFragment& fragment) {
    const std::size_t triangles = scene.mesh.indices.size() / 3;
    if (fragment.triangle >= triangles) {
        return refuse("the fragment is of triangle " + std::to_string(fragment.triangle) + ", the mesh has " +
                      std::to_string(triangles));
    }
    if (fragment.x >= scene.view.width || fragment.y >= scene.view.height) {
        return refuse("the fragment is at pixel (" + std::to_string(fragment.x) + ", " + std::to_string(fragment.y) +
                      "), outside the viewport");
    }
    return {};
}

} // namespace

const char* toString(Doubt doubt) noexcept {
    switch (doubt) {
    case Doubt::None:
        return "none";
    case Doubt::Coverage:
        return "coverage";
    case Doubt::Coordinate:
        return "coordinate";
    case Doubt::Opacity:
        break;
    }
    return "opacity";
}

Result<std::vector<OracleFragment>> oracleSurvivors(const OraclePair& pair) {
    return guard([&]() -> Result<std::vector<OracleFragment>> {
        const Result<Scene> scene = prepare(pair);
        VOXTACT_TRY(scene);
        std::vector<OracleFragment> out;
        for (std::size_t triangle = 0; triangle < pair.mesh.indices.size() / 3; ++triangle) {
            appendSurvivors(*scene, static_cast<std::uint32_t>(triangle), out);
        }
        std::sort(out.begin(), out.end());
        return out;
    });
}

Result<std::vector<Evidence>> oracleEvidence(const OraclePair& pair, std::span<const OracleFragment> fragments,
                                             const Tolerance& tolerance) {
    return guard([&]() -> Result<std::vector<Evidence>> {
        VOXTACT_TRY(checkTolerance(tolerance));
        const Result<Scene> scene = prepare(pair);
        VOXTACT_TRY(scene);
        std::vector<Evidence> out;
        out.reserve(fragments.size());
        for (const OracleFragment& fragment : fragments) {
            VOXTACT_TRY(checkFragment(*scene, fragment));
            out.push_back(evidenceOf(*scene, fragment, tolerance));
        }
        return out;
    });
}

Result<Evidence> oracleEvidence(const OraclePair& pair, const OracleFragment& fragment, const Tolerance& tolerance) {
    Result<std::vector<Evidence>> all = oracleEvidence(pair, std::span(&fragment, 1), tolerance);
    VOXTACT_TRY(all);
    return all->front();
}

} // namespace voxtact::oracle
