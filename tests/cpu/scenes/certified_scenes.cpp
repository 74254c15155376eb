// SPDX-License-Identifier: MIT
#include "cpu/scenes/certified_scenes.h"

#include "cpu/scenes/engine_fixture.h"
#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <optional>

namespace voxtact::test {

double opacityOfValue(const std::vector<ControlPoint>& points, double value) {
    double opacity = value < points.front().value  ? points.front().opacity
                     : value > points.back().value ? points.back().opacity
                                                   : 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        opacity = points[i].value == value ? std::max(opacity, points[i].opacity) : opacity;
        if (i > 0 && points[i - 1].value < value && value < points[i].value) {
            const double share = (value - points[i - 1].value) / (points[i].value - points[i - 1].value);
            opacity = points[i - 1].opacity + share * (points[i].opacity - points[i - 1].opacity); // exact where equal
        }
    }
    return opacity;
}

namespace {

using Random = std::mt19937_64;

double pick(Random& random, std::initializer_list<double> choices) {
    return choices.begin()[below(random, choices.size())];
}

double voxelOf(const VolumeData& volume, const std::size_t (&at)[3]) {
    const auto& n = volume.grid.size;
    const std::byte* voxel =
        volume.voxels.data() + ((at[2] * n[1] + at[1]) * n[0] + at[0]) * bytesPerVoxel(volume.type);
    const auto load = [&](auto scalar) {
        std::memcpy(&scalar, voxel, sizeof scalar);
        return static_cast<double>(scalar);
    };
    switch (volume.type) {
    case ScalarType::UInt8:
        return load(std::uint8_t{});
    case ScalarType::Int16:
        return load(std::int16_t{});
    case ScalarType::UInt16:
        return load(std::uint16_t{});
    case ScalarType::Float32:
        break;
    }
    return load(float{});
}

/// Index space. Between equal voxels it is their value: nothing rounds at a step of the opacity.
double valueAt(const VolumeData& volume, const Vec3& place) {
    double values[8];
    Vec3 weight{};
    for (std::size_t corner = 0; corner < 8; ++corner) {
        std::size_t at[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double last = volume.grid.size[axis] - 1.0;
            const double u = std::clamp(place[axis], 0.0, last);
            const bool upper = (corner >> axis & 1) != 0;
            at[axis] = static_cast<std::size_t>(std::min(std::floor(u) + (upper ? 1 : 0), last));
            weight[axis] = u - std::floor(u);
        }
        values[corner] = voxelOf(volume, at);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < std::size_t{4} >> axis; ++i) {
            values[i] = std::lerp(values[2 * i], values[2 * i + 1], weight[axis]);
        }
    }
    return values[0];
}

double opacityOfIndex(const CertifiedCase& c, const Vec3& place) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (place[axis] < -0.5 || place[axis] > c.scene.volume.grid.size[axis] - 0.5) {
            return -1;
        }
    }
    return opacityOfValue(c.scene.points, valueAt(c.scene.volume, place));
}

bool opaque(const CertifiedCase& c, const Vec3& place) {
    return opacityOfIndex(c, place) >= c.scene.threshold;
}

/// `plain`: what a mesh in a plane of the grid keeps through the transform.
Grid randomGrid(Random& random, bool plain) {
    Grid grid;
    const std::size_t most = chance(random, 0.3) ? 10 : 4;
    for (std::uint32_t& side : grid.size) {
        side = static_cast<std::uint32_t>(1 + below(random, most));
    }
    const Mat4 turn = chance(random, 0.7) ? randomRotation(random) : identity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.spacing[axis] = plain ? pick(random, {0.5, 1, 2}) : uniform(random, 0.3, 3);
        grid.origin[axis] = plain ? pick(random, {0, 0.5, -8}) : uniform(random, -200, 200);
        for (std::size_t row = 0; row < 3 && !plain; ++row) {
            grid.direction[3 * axis + row] = turn[4 * axis + row];
        }
    }
    return grid;
}

/// 0..1: waves, noise, a single voxel, a constant, steps, a slope.
VoxelFunction randomPattern(Random& random, const Grid& grid) {
    const double a = uniform(random, 0, 1);
    const Vec3 wave{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    const std::uint64_t key = random();
    const auto hashed = [key](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        std::uint64_t h = key ^ (x + 31ULL * y + 1009ULL * z) * 0x9e3779b97f4a7c15ULL;
        h = (h ^ h >> 31U) * 0xbf58476d1ce4e5b9ULL;
        return static_cast<double>(h >> 40U) / 16777216.0;
    };
    const auto along = [=](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return wave[0] * x + wave[1] * y + wave[2] * z;
    };
    const std::uint32_t at[3] = {static_cast<std::uint32_t>(below(random, grid.size[0])),
                                 static_cast<std::uint32_t>(below(random, grid.size[1])),
                                 static_cast<std::uint32_t>(below(random, grid.size[2]))};
    const std::size_t kind = below(random, 16);
    if (kind < 5) {
        return [=](auto x, auto y, auto z) { return 0.5 + 0.5 * std::sin(along(x, y, z) + 6 * a); };
    }
    if (kind < 9) {
        return hashed;
    }
    if (kind < 12) {
        const double ground = chance(random, 0.5) ? 0 : 0.2 * a;
        return [=](auto x, auto y, auto z) { return x == at[0] && y == at[1] && z == at[2] ? 1 : ground; };
    }
    if (kind < 13) {
        return [=](auto...) { return a; };
    }
    if (kind < 15) {
        return [=](auto x, auto y, auto z) { return along(x, y, z) > a ? 1.0 : 0.0; };
    }
    return [=](auto x, auto y, auto z) { return std::clamp(0.5 + along(x, y, z) / 10, 0.0, 1.0); };
}

VolumeData randomImage(Random& random, const Grid& grid) {
    const VoxelFunction pattern = randomPattern(random, grid);
    const auto stretched = [&](double lo, double hi) {
        return [&pattern, lo, hi](auto x, auto y, auto z) { return lo + (hi - lo) * pattern(x, y, z); };
    };
    switch (below(random, 4)) {
    case 0:
        return makeVolume<std::uint8_t>(grid, ScalarType::UInt8, stretched(0, 255));
    case 1:
        return makeVolume<std::uint16_t>(grid, ScalarType::UInt16, stretched(0, pick(random, {4095, 65535})));
    case 2:
        return makeVolume<std::int16_t>(grid, ScalarType::Int16, stretched(-1024, pick(random, {3071, 32767})));
    default:
        break;
    }
    const double scale = pick(random, {1, 1, 1e-3, 1e6, 1e30});
    return makeVolume<float>(grid, ScalarType::Float32, stretched(pick(random, {-scale, 0}), scale));
}

Vec3 randomPlace(Random& random, const Grid& grid, double beyond) {
    Vec3 out{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out[axis] = uniform(random, -0.5 - beyond, grid.size[axis] - 0.5 + beyond);
    }
    return out;
}

std::vector<ControlPoint> randomPoints(Random& random, double value, double width, double level) {
    const double steep = width * std::pow(10, uniform(random, -3, 0));
    switch (below(random, 8)) {
    case 0:
    case 1: // rises
        return {{value - steep, 0}, {value + steep, uniform(random, 0.5, 1)}};
    case 2: // falls
        return {{value - steep, 1}, {value + steep, 0}};
    case 3: // a step
        return {{value, 0}, {value, uniform(random, 0.2, 1)}};
    case 4: // a narrow peak
        return {{value - 0.1 * steep, 0}, {value, 1}, {value + 0.1 * steep, 0}};
    case 5: // a plateau
        return {{value - 2 * steep, 0}, {value - steep, level}, {value + steep, level}, {value + 2 * steep, 0}};
    case 6: // a constant
        return {{value, chance(random, 0.5) ? level : uniform(random, 0, 1)}};
    default:
        break;
    }
    std::vector<ControlPoint> peaks;
    for (int i = 0; i < 12; ++i) {
        peaks.push_back({value + width * (i - 6) / 12, chance(random, 0.5) ? 0.0 : uniform(random, 0, 1)});
    }
    return peaks;
}

/// Returns a place whose value the function is about.
Vec3 randomFunction(Random& random, OracleScene& scene) {
    const ValueRange range = take(checkVolume(scene.volume.view()));
    const double width = std::max({range.hi - range.lo, 1e-3 * std::abs(range.hi), 1e-6});
    scene.domain = {range.lo - uniform(random, -0.04, 0.3) * width, range.hi + uniform(random, -0.04, 0.3) * width};
    if (!(scene.domain.lo < scene.domain.hi)) {
        scene.domain.hi = scene.domain.lo + width;
    }
    constexpr std::uint32_t kSizes[] = {2, 3, 16, 64, 255, 256, 300};
    scene.tableSize = kSizes[below(random, std::size(kSizes))];
    const Vec3 place = randomPlace(random, scene.volume.grid, 0);
    const double value = valueAt(scene.volume, place);
    const double level = pick(random, {0.1, 0.5, 1, 1e-6, uniform(random, 0, 1)});
    scene.points = randomPoints(random, value, width, level);
    const std::vector<float> table = take(sampleTable({scene.points, scene.domain, scene.tableSize}));
    const auto entry = static_cast<double>(table[below(random, table.size())]);
    scene.threshold =
        chance(random, 0.15)
            ? pick(random, {0, 1, 1e-6, 1e-30})
            : pick(random, {level, entry, kDefaultThreshold, uniform(random, 0, 1), uniform(random, 0.05, 0.5)});
    return place;
}

Vec3 moved(const Vec3& from, const Vec3& direction, double by) {
    return {from[0] + by * direction[0], from[1] + by * direction[1], from[2] + by * direction[2]};
}

Vec3 randomDirection(Random& random) {
    const Mat4 turn = randomRotation(random);
    return {turn[0], turn[1], turn[2]};
}

/// Index space; the normal points to where nothing is opaque.
struct Onset {
    Vec3 place{};
    Vec3 normal{};
};

Vec3 outward(const CertifiedCase& c, const Vec3& place, const Vec3& towards) {
    constexpr double kStep = 1e-4;
    Vec3 slope{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double last = c.scene.volume.grid.size[axis] - 0.5;
        if (std::abs(place[axis] + 0.5) < kStep || std::abs(place[axis] - last) < kStep) {
            slope = {};
            slope[axis] = place[axis] < 0 ? -1 : 1;
            return slope;
        }
        Vec3 step{};
        step[axis] = kStep;
        slope[axis] = valueAt(c.scene.volume, moved(place, step, 1)) - valueAt(c.scene.volume, moved(place, step, -1));
    }
    const double along = slope[0] * towards[0] + slope[1] * towards[1] + slope[2] * towards[2];
    const double length = std::hypot(slope[0], slope[1], slope[2]);
    if (!(length > 0) || along == 0) {
        return moved({}, towards, 1 / std::hypot(towards[0], towards[1], towards[2]));
    }
    return moved({}, slope, (along > 0 ? 1 : -1) / length);
}

/// Where contact begins, on the way from an opaque place to one that is not, or is outside of the domain.
/// `likely` may be opaque.
std::optional<Onset> findOnset(Random& random, const CertifiedCase& c, const Vec3& likely) {
    constexpr int kTries = 30;
    std::optional<Vec3> inside;
    std::optional<Vec3> outside;
    (opaque(c, likely) ? inside : outside) = likely;
    for (int i = 0; i < kTries && !(inside && outside); ++i) {
        const Vec3 place = randomPlace(random, c.scene.volume.grid, i % 2 == 0 ? 0 : 0.2);
        (opaque(c, place) ? inside : outside) = place;
    }
    if (!inside || !outside) {
        return {};
    }
    Vec3 in = *inside;
    Vec3 out = *outside;
    for (int i = 0; i < 40; ++i) {
        const Vec3 middle{(in[0] + out[0]) / 2, (in[1] + out[1]) / 2, (in[2] + out[2]) / 2};
        (opaque(c, middle) ? in : out) = middle;
    }
    return Onset{in, outward(c, in, moved(*outside, *inside, -1))};
}

/// Two directions that span the plane across a normal.
std::array<Vec3, 2> spanOf(Random& random, const Vec3& normal) {
    const Vec3 any = randomDirection(random);
    const auto cross = [](const Vec3& a, const Vec3& b) {
        return Vec3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const Vec3 across = cross(normal, any);
    const Vec3 unit = moved({}, across, 1 / std::max(std::hypot(across[0], across[1], across[2]), 1e-9));
    return {unit, cross(normal, unit)};
}

/// Voxels.
double randomExtent(Random& random, CaseKind kind) {
    switch (kind) {
    case CaseKind::SubVoxel:
        return 1e-3 * uniform(random, 0.1, 2);
    case CaseKind::Huge:
        return uniform(random, 100, 1000);
    default:
        return std::pow(10, uniform(random, -1, 0.5));
    }
}

using Triangle = std::array<Vec3, 3>;

/// About a place, along a plane. `tilt` is how far the corners leave it, as a share of the triangle's extent.
Triangle randomTriangle(Random& random, CaseKind kind, const Onset& about, double tilt) {
    const auto [u, v] = spanOf(random, about.normal);
    const double extent = randomExtent(random, kind);
    const double turn = uniform(random, 0, 2 * std::numbers::pi);
    const double width = kind == CaseKind::Sliver ? std::pow(10, uniform(random, -6, -1)) : uniform(random, 0.1, 1);
    Triangle out;
    for (std::size_t i = 0; i < 3; ++i) {
        const double angle = turn + 2 * std::numbers::pi * (static_cast<double>(i) + uniform(random, -0.4, 0.4)) / 3;
        out[i] = moved(about.place, u, extent * std::cos(angle));
        out[i] = moved(out[i], v, width * extent * std::sin(angle));
        out[i] = moved(out[i], about.normal, extent * uniform(random, -tilt, tilt));
    }
    if (kind == CaseKind::Degenerate) {
        out[1] = chance(random, 0.5) ? out[0] : out[2];
        out[2] = chance(random, 0.3) ? out[1] : out[2];
    }
    return out;
}

/// Into a plane of voxel centres or faces, or into a face of the domain.
void flatten(Random& random, const CertifiedCase& c, Triangle& triangle) {
    const std::size_t axis = below(random, 3);
    const double last = c.scene.volume.grid.size[axis] - 0.5;
    const double middle = std::clamp(std::round(2 * triangle[0][axis]) / 2, 0.0, last - 0.5);
    const double plane = c.kind == CaseKind::DomainFace ? pick(random, {-0.5, last}) : middle;
    for (Vec3& corner : triangle) {
        corner[axis] = plane;
    }
}

std::vector<Triangle> randomTriangles(Random& random, CertifiedCase& c, const std::optional<Onset>& found) {
    c.onset = found && c.kind != CaseKind::FarAway && c.kind != CaseKind::DomainFace && c.kind != CaseKind::Plate;
    const std::size_t count = chance(random, 0.3) ? 1 : 1 + below(random, chance(random, 0.3) ? 12 : 4);
    const double offset = uniform(random, -0.25, 0.75);
    std::vector<Triangle> out;
    for (std::size_t i = 0; i < count; ++i) {
        Onset about = found.value_or(Onset{{}, randomDirection(random)});
        if (!found || i > 1) {
            about.place = randomPlace(random, c.scene.volume.grid, 1);
        } else {
            about.place = moved(about.place, about.normal, offset + (i == 0 ? 0 : uniform(random, 0, 0.5)));
        }
        if (c.kind == CaseKind::FarAway) {
            about.place = moved(about.place, randomDirection(random), std::pow(10, uniform(random, 1, 5)));
        }
        out.push_back(randomTriangle(random, c.kind, about, c.onset ? pick(random, {0, 0.01, 0.2}) : 1));
        if (c.kind == CaseKind::Plate || c.kind == CaseKind::DomainFace) {
            flatten(random, c, out.back());
        }
    }
    return out;
}

Mat4 randomPose(Random& random, CertifiedCase& c, bool plain) {
    if (plain || chance(random, 0.2)) {
        return identity();
    }
    c.farOrigin = chance(random, 0.12);
    const double away = std::pow(10, c.farOrigin ? uniform(random, 2, 4) : uniform(random, -1, 1.5));
    const Vec3 centre = transformPoint(worldFromTexture(c.scene.volume.grid), {0.5, 0.5, 0.5});
    Mat4 scale = identity();
    for (std::size_t axis = 0; axis < 3; ++axis) {
        scale[5 * axis] = c.farOrigin ? uniform(random, 1, 3) : std::pow(10, uniform(random, -1, 1));
    }
    return multiply(translation(moved(centre, randomDirection(random), away)), multiply(randomRotation(random), scale));
}

} // namespace

const char* toString(CaseKind kind) noexcept {
    constexpr const char* kNames[kCaseKinds] = {"plain",     "sliver", "plate",    "domain-face",
                                                "sub-voxel", "huge",   "far-away", "degenerate"};
    return kNames[static_cast<std::size_t>(kind)];
}

double opacityOf(const CertifiedCase& c, const Vec3& texture) {
    Vec3 place{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        place[axis] = texture[axis] * c.scene.volume.grid.size[axis] - 0.5;
    }
    return opacityOfIndex(c, place);
}

CertifiedCase withTable(OracleScene scene) {
    CertifiedCase out;
    out.scene = std::move(scene);
    out.table = take(sampleTable({out.scene.points, out.scene.domain, out.scene.tableSize}));
    return out;
}

CertifiedCase makeCertifiedCase(std::uint64_t seed, std::uint64_t number) {
    std::seed_seq numbers{seed, seed >> 32U, number, number >> 32U};
    Random random(numbers);
    constexpr CaseKind kKinds[] = {CaseKind::Plain,    CaseKind::Plain,  CaseKind::Plain,   CaseKind::Plain,
                                   CaseKind::Plain,    CaseKind::Plain,  CaseKind::Plain,   CaseKind::Plain,
                                   CaseKind::Sliver,   CaseKind::Sliver, CaseKind::Plate,   CaseKind::DomainFace,
                                   CaseKind::SubVoxel, CaseKind::Huge,   CaseKind::FarAway, CaseKind::Degenerate};
    const CaseKind kind = kKinds[below(random, std::size(kKinds))];
    const bool plain = (kind == CaseKind::Plate || kind == CaseKind::DomainFace) && chance(random, 0.7);
    OracleScene scene;
    scene.volume = randomImage(random, randomGrid(random, plain));
    const bool wanted = chance(random, 0.75);
    CertifiedCase out;
    std::optional<Onset> onset;
    for (int tries = wanted ? 5 : 1; tries > 0 && !onset; --tries) {
        const Vec3 likely = randomFunction(random, scene);
        out = withTable(scene);
        onset = wanted ? findOnset(random, out, likely) : std::nullopt;
    }
    out.kind = kind;
    out.scene.world_from_object = randomPose(random, out, plain);
    const Mat4 object_from_index =
        multiply(inverse(out.scene.world_from_object).value(), worldFromIndex(out.scene.volume.grid));
    const std::vector<Triangle> triangles = randomTriangles(random, out, onset);
    for (const auto& [a, b, c] : triangles) {
        addTriangle(out.scene.mesh, transformPoint(object_from_index, a), transformPoint(object_from_index, b),
                    transformPoint(object_from_index, c));
    }
    return out;
}

CertifiedCase outlierCase(std::uint64_t seed, double outlier, bool near) {
    std::mt19937_64 random(seed);
    OracleScene scene;
    Grid grid;
    grid.size = {20, 19, 18};
    scene.points = {{100, 0}, {150, 1}};
    scene.domain = {0, 255};
    scene.volume = makeVolume<float>(grid, ScalarType::Float32, [&](auto... place) {
        const double value = uniform(random, 0, 1) < 0.6 ? 10 : 200;
        return ((place % 8 == 0) && ...) ? outlier : value;
    });
    for (int i = 0; i < 10; ++i) {
        std::array<Vec3, 3> corners{};
        Vec3 block{};
        std::ranges::generate(block, [&] { return static_cast<double>(8 * (random() % 2)); });
        for (Vec3& corner : corners) {
            for (std::size_t axis = 0; axis < 3; ++axis) {
                corner[axis] = near ? uniform(random, -1, 19) : block[axis] + uniform(random, 3, 5);
            }
        }
        addTriangle(scene.mesh, corners[0], corners[1], corners[2]);
    }
    return withTable(std::move(scene));
}

} // namespace voxtact::test
