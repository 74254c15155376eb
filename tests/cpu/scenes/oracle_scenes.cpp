// SPDX-License-Identifier: MIT
#include "cpu/scenes/oracle_scenes.h"

#include "voxtact/samples.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace voxtact::test {

VolumeData makeUnitImage(std::uint32_t n, const VoxelFunction& value) {
    VolumeData out;
    out.grid.size = {n, n, n};
    out.grid.spacing = {1.0 / n, 1.0 / n, 1.0 / n};
    out.grid.origin = {0.5 / n, 0.5 / n, 0.5 / n};
    out.voxels.reserve(voxelCount(out.grid));
    for (std::uint32_t z = 0; z < n; ++z) {
        for (std::uint32_t y = 0; y < n; ++y) {
            for (std::uint32_t x = 0; x < n; ++x) {
                out.voxels.push_back(static_cast<std::byte>(value(x, y, z)));
            }
        }
    }
    return out;
}

void addTriangle(MeshData& mesh, const Vec3& a, const Vec3& b, const Vec3& c) {
    for (const Vec3& corner : {a, b, c}) {
        mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size() / 3));
        for (const double coordinate : corner) {
            mesh.positions.push_back(static_cast<float>(coordinate));
        }
    }
}

void addRectangle(MeshData& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    addTriangle(mesh, a, b, c);
    addTriangle(mesh, a, c, d);
}

View squareView(double lo, double hi, std::uint32_t width, std::uint32_t height) {
    View view;
    view.width = width;
    view.height = height;
    const double scale = 1 / (hi - lo);
    view.clip_from_world[0] = view.clip_from_world[5] = 2 * scale;
    view.clip_from_world[10] = scale;
    view.clip_from_world[12] = view.clip_from_world[13] = -1 - 2 * lo * scale;
    view.clip_from_world[14] = -lo * scale;
    view.clip_from_world[15] = 1;
    return view;
}

View perspectiveView(const Mat4& world_from_camera, double nearPlane, double farPlane, std::uint32_t size) {
    Mat4 clip_from_camera{};
    clip_from_camera[0] = clip_from_camera[5] = 1;
    clip_from_camera[10] = farPlane / (farPlane - nearPlane);
    clip_from_camera[14] = -nearPlane * farPlane / (farPlane - nearPlane);
    clip_from_camera[11] = 1;
    return {multiply(clip_from_camera, inverse(world_from_camera).value()), size, size};
}

double uniform(std::mt19937& random, double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(random()) / 4294967296.0);
}

Mat4 randomPose(std::mt19937& random, const Vec3& offset) {
    double q[4];
    double length = 0;
    do {
        length = 0;
        for (double& part : q) {
            part = uniform(random, -1, 1);
            length += part * part;
        }
    } while (length > 1 || length < 0.01);
    for (double& part : q) {
        part /= std::sqrt(length);
    }
    const auto [w, x, y, z] = q;
    return {1 - 2 * (y * y + z * z),
            2 * (x * y + w * z),
            2 * (x * z - w * y),
            0,
            2 * (x * y - w * z),
            1 - 2 * (x * x + z * z),
            2 * (y * z + w * x),
            0,
            2 * (x * z + w * y),
            2 * (y * z - w * x),
            1 - 2 * (x * x + y * y),
            0,
            offset[0],
            offset[1],
            offset[2],
            1};
}

std::uint32_t testSeed(std::uint32_t usual) {
    const char* wanted = std::getenv("VOXTACT_TEST_SEED");
    const std::uint32_t seed =
        wanted != nullptr ? static_cast<std::uint32_t>(std::strtoul(wanted, nullptr, 10)) : usual;
    std::printf("VOXTACT_TEST_SEED=%u\n", seed);
    return seed;
}

OracleScene randomScene(std::mt19937& random, const std::string& volume) {
    OracleScene scene;
    scene.volume = makeBuiltinVolume(volume).value();
    scene.domain = checkVolume(scene.volume.view()).value();
    const double width = scene.domain.hi - scene.domain.lo;
    scene.points = {{scene.domain.lo + 0.2 * width, 0}, {scene.domain.lo + 0.8 * width, 1}};
    scene.threshold = uniform(random, 0.1, 0.6);
    scene.mesh = makeBuiltinMesh(random() % 2 == 0 ? "scalpel:1000" : "ellipsoid:500").value();
    const auto offset = [&] { return uniform(random, -90, 90); };
    scene.world_from_object = randomPose(random, {offset(), offset(), offset()});
    if (random() % 2 == 0) {
        scene.view = {framingCamera(scene.volume.grid, 256, 200), 256, 200};
    } else {
        // Often inside the mesh: triangles cross the near plane.
        const Mat4 world_from_camera = randomPose(random, {offset(), offset(), offset()});
        scene.view = perspectiveView(world_from_camera, uniform(random, 0.1, 5), 400, 200);
    }
    return scene;
}

} // namespace voxtact::test
