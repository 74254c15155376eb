// SPDX-License-Identifier: MIT
#include "cpu/scenes/random_scene.h"
#include "support/scenes.h"
#include "support/take.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace voxtact::test {

std::size_t below(std::mt19937_64& random, std::size_t end) {
    return static_cast<std::size_t>(random() % end);
}

bool chance(std::mt19937_64& random, double probability) {
    return uniform(random, 0, 1) < probability;
}

namespace {

ValueRange rangeOf(const VolumeData& volume) {
    return take(checkVolume(volume.view()));
}

Grid randomGrid(std::mt19937_64& random) {
    Grid grid;
    for (std::uint32_t& side : grid.size) {
        side = static_cast<std::uint32_t>(1 + below(random, chance(random, 0.2) ? 4 : 40));
    }
    if (chance(random, 0.3)) {
        return unitGrid(grid.size[0], grid.size[1], grid.size[2]);
    }
    const Mat4 turn = randomRotation(random);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.spacing[axis] = uniform(random, 0.1, 3);
        grid.origin[axis] = uniform(random, -100, 100);
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 * axis + row] = turn[4 * axis + row];
        }
    }
    return grid;
}

/// 0..1: blobs, blocks, noise, constants, and single voxels.
std::function<double(std::uint32_t, std::uint32_t, std::uint32_t)> randomPatternOf(std::mt19937_64& random,
                                                                                   const Grid& grid) {
    const std::size_t kind = below(random, 6);
    const double scale = uniform(random, 0.1, 0.8);
    const double offset = uniform(random, 0, 6);
    const std::uint64_t key = random();
    const auto hashed = [key](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        std::mt19937_64 local(key ^ (x + 1000003ULL * y + 1000000007ULL * z));
        return uniform(local, 0, 1);
    };
    switch (kind) {
    case 0:
        return [=](auto x, auto y, auto z) {
            return 0.5 + 0.5 * std::sin(scale * x + offset) * std::sin(scale * y) * std::cos(scale * z);
        };
    case 1:
        return [=](auto x, auto y, auto z) { return hashed(x / 9, y / 9, z / 9); };
    case 2:
        return hashed;
    case 3:
        return [=](auto...) { return scale; };
    case 4:
        return [=](auto x, auto y, auto z) { return hashed(x, y, z) < 0.01 ? 1.0 : 0.0; };
    default:
        break;
    }
    return [=](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        double squared = 0;
        const std::uint32_t at[3] = {x, y, z};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double centred = (at[axis] + 0.5) / grid.size[axis] - 0.5;
            squared += centred * centred;
        }
        return std::clamp(1.2 - 2.4 * std::sqrt(squared), 0.0, 1.0);
    };
}

void randomFunction(std::mt19937_64& random, const ValueRange& range, RandomScene& scene) {
    const double width = std::max({range.hi - range.lo, 1e-3 * std::abs(range.hi), 1e-6});
    scene.domain = {range.lo - uniform(random, -0.04, 0.3) * width, range.hi + uniform(random, 0.05, 0.3) * width};
    constexpr std::uint32_t kSizes[] = {2, 3, 16, 255, 256, 1024, 5000};
    scene.tableSize = kSizes[below(random, std::size(kSizes))];
    const double middle = uniform(random, range.lo, range.hi);
    switch (below(random, 5)) {
    case 0: // ramp
        scene.points = {{middle, 0}, {middle + uniform(random, 0.01, 0.5) * width, uniform(random, 0.5, 1)}};
        break;
    case 1: // narrow peak
        scene.points = {{middle - 0.01 * width, 0}, {middle, 1}, {middle + 0.01 * width, 0}};
        break;
    case 2: // falls
        scene.points = {{middle, 1}, {middle + uniform(random, 0.01, 0.5) * width, 0}};
        break;
    case 3: // constant
        scene.points = {{middle, chance(random, 0.5) ? 1 : uniform(random, 0, 1)}};
        break;
    default: // many peaks
        scene.points.clear();
        for (int i = 0; i < 40; ++i) {
            scene.points.push_back({range.lo + width * i / 40, chance(random, 0.5) ? 0.0 : uniform(random, 0, 1)});
        }
    }
    const auto table = take(sampleTable(scene.transferFunction()));
    const double thresholds[] = {
        0, 1, kDefaultThreshold, 0.5, static_cast<double>(table[below(random, table.size())]), uniform(random, 0, 1)};
    scene.threshold = thresholds[below(random, std::size(thresholds))];
}

double sideOf(const Grid& grid) {
    double most = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        most = std::max(most, grid.spacing[axis] * grid.size[axis]);
    }
    return most;
}

/// Triangles of all shapes around the object's origin: `size` is their usual one.
MeshData soup(std::mt19937_64& random, double size, std::size_t triangles) {
    MeshData mesh;
    for (std::size_t i = 0; i < 3 * triangles; ++i) {
        const bool ofLast = i >= 3 && chance(random, 0.3);
        mesh.indices.push_back(
            static_cast<std::uint32_t>(ofLast ? below(random, mesh.positions.size() / 3) : mesh.positions.size() / 3));
        if (ofLast) {
            continue;
        }
        constexpr double kScales[] = {0.01, 0.1, 1, 1, 1, 10, 1e4};
        const double scale = size * kScales[below(random, std::size(kScales))];
        for (int axis = 0; axis < 3; ++axis) {
            mesh.positions.push_back(static_cast<float>(uniform(random, -scale, scale)));
        }
    }
    return mesh;
}

MeshData scaled(MeshData mesh, double scale) {
    for (double& coordinate : mesh.positions) {
        coordinate = static_cast<float>(static_cast<double>(coordinate) * scale);
    }
    return mesh;
}

/// Perspective with the eye near the volume; x and y are turned at random, so that no axis is special.
Mat4 perspective(std::mt19937_64& random, double side) {
    const double nearest = side * uniform(random, 0.001, 1);
    const double farthest = nearest + side * uniform(random, 0.1, 4);
    const double width = uniform(random, 0.2, 2);
    Mat4 clip_from_eye{};
    clip_from_eye[0] = 1 / width;
    clip_from_eye[5] = 1 / width;
    clip_from_eye[10] = farthest / (farthest - nearest);
    clip_from_eye[14] = -nearest * farthest / (farthest - nearest);
    clip_from_eye[11] = 1;
    return clip_from_eye;
}

std::array<std::uint32_t, 2> randomViewport(std::mt19937_64& random) {
    constexpr std::array<std::uint32_t, 2> kViewports[] = {{1, 1},     {7, 3},   {4096, 2}, {2, 1000},
                                                           {16384, 1}, {64, 64}, {128, 96}, {33, 77}};
    return kViewports[below(random, std::size(kViewports))];
}

} // namespace

VolumeData randomVolume(std::mt19937_64& random) {
    const Grid grid = randomGrid(random);
    const auto pattern = randomPatternOf(random, grid);
    const auto stretched = [&](double lo, double hi) {
        return [&pattern, lo, hi](auto x, auto y, auto z) { return lo + (hi - lo) * pattern(x, y, z); };
    };
    switch (below(random, 4)) {
    case 0:
        return makeVolume<std::uint8_t>(grid, ScalarType::UInt8, stretched(0, 255));
    case 1:
        return makeVolume<std::uint16_t>(grid, ScalarType::UInt16, stretched(0, chance(random, 0.5) ? 65535 : 4095));
    case 2:
        return makeVolume<std::int16_t>(grid, ScalarType::Int16, stretched(-1024, chance(random, 0.5) ? 3071 : 32767));
    default:
        break;
    }
    constexpr double kScales[] = {1, 1, 1e-3, 1e6, 3e38};
    const double scale = kScales[below(random, std::size(kScales))];
    return makeVolume<float>(grid, ScalarType::Float32, stretched(-scale, scale));
}

MeshData randomMesh(std::mt19937_64& random, const Grid& grid) {
    const double side = sideOf(grid);
    switch (below(random, 5)) {
    case 0:
        return scaled(take(makeScalpel()), side / 150);
    case 1:
        return scaled(take(makeEllipsoid(static_cast<std::uint32_t>(500 + 2 * below(random, 1500)))), side / 80);
    case 2:
        return makeCube(-side * uniform(random, 0.05, 1), side * uniform(random, 0.05, 1));
    default:
        break;
    }
    return soup(random, side * std::pow(10, uniform(random, -2, 0)), 1 + below(random, 300));
}

View randomView(std::mt19937_64& random, const Grid& grid) {
    const auto [width, height] = randomViewport(random);
    View view{framingCamera(grid, width, height), width, height};
    const Vec3 centre = transformPoint(worldFromTexture(grid), {0.5, 0.5, 0.5});
    const Mat4 toCentre = translation({-centre[0], -centre[1], -centre[2]});
    const double side = sideOf(grid);
    switch (below(random, 4)) {
    case 0:
        break;
    case 1: { // orthographic from anywhere, not all of the volume between near and far
        Mat4 scale = identity();
        const double zoom = std::pow(10, uniform(random, -1, 2));
        scale[0] = zoom / side;
        scale[5] = zoom / side;
        scale[10] = uniform(random, 0.2, 2) / side;
        scale[14] = 0.5;
        view.clip_from_world = multiply(scale, multiply(randomRotation(random), toCentre));
        break;
    }
    default: { // the eye in or near the volume
        const Vec3 eye{uniform(random, -side, side), uniform(random, -side, side), uniform(random, 0, 2 * side)};
        view.clip_from_world =
            multiply(perspective(random, side), multiply(translation(eye), multiply(randomRotation(random), toCentre)));
    }
    }
    return view;
}

RandomScene makeRandomScene(std::mt19937_64& random, std::size_t poses) {
    RandomScene scene;
    scene.volume = randomVolume(random);
    randomFunction(random, rangeOf(scene.volume), scene);
    scene.mesh = randomMesh(random, scene.volume.grid);
    scene.view = randomView(random, scene.volume.grid);
    scene.poses = randomPoses(scene.volume.grid, poses, chance(random, 0.3) ? 3 : 1, random);
    if (chance(random, 0.1)) {
        Mat4 stretch = identity();
        stretch[0] = uniform(random, -3, 3);
        stretch[5] = chance(random, 0.3) ? 0.0 : 1.0;
        scene.poses.front() = multiply(scene.poses.front(), stretch);
    }
    scene.rangeTest = chance(random, 0.7);
    return scene;
}

RandomScene makeRandomSceneForC(std::mt19937_64& random, std::size_t poses) {
    RandomScene scene = makeRandomScene(random, poses);
    scene.threshold = scene.threshold > 0 ? scene.threshold : kDefaultThreshold;
    return scene;
}

RandomScene makeFarCornerScene(std::mt19937_64& random, std::size_t poses) {
    RandomScene scene = makeRandomScene(random, poses);
    scene.volume = makeBytes(scene.volume.grid, [](auto...) { return 255.0; }); // what is inside survives
    scene.points.assign(byteRamp().begin(), byteRamp().end());
    scene.domain = {0, 255};
    scene.threshold = kDefaultThreshold;
    const Grid& grid = scene.volume.grid;
    const double reach =
        std::max({grid.spacing[0] * grid.size[0], grid.spacing[1] * grid.size[1], grid.spacing[2] * grid.size[2]});
    scene.mesh = {};
    scene.mesh.indices = {0, 1, 2};
    for (int i = 0; i < 9; ++i) {
        scene.mesh.positions.push_back(drawn(random, -1.5 * reach, 1.5 * reach));
    }
    double& one = scene.mesh.positions[below(random, 9)];
    one = static_cast<float>(one * std::pow(10, uniform(random, 0, 24)));
    return scene;
}

std::vector<cpu::ReferenceCounts> RandomScene::reference() const {
    std::vector<cpu::ReferenceCounts> counts;
    for (const Mat4& pose : poses) {
        counts.push_back(
            cpu::referenceCounts({mesh.view(), volume.view(), transferFunction(), view, pose, threshold, rangeTest}));
    }
    return counts;
}

} // namespace voxtact::test
