// SPDX-License-Identifier: MIT
// voxtact plan: heat maps.
#include "plan_fixture.h"
#include "voxtact/io.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// The triangles of a surface that plan has written, as corners and whether all is safe from there.
struct SurfaceTriangle {
    std::array<Vec3, 3> corners{};
    bool safe = false;
};
std::vector<SurfaceTriangle> trianglesOf(const std::string& ply, std::size_t vertices, std::size_t faces) {
    const char* at = ply.data() + ply.find("end_header\n") + 11;
    const auto take = [&at](auto& value) {
        std::memcpy(&value, at, sizeof value);
        at += sizeof value;
    };
    std::vector<Vec3> positions(vertices);
    for (Vec3& position : positions) {
        for (double& component : position) {
            float one = 0;
            take(one);
            component = one;
        }
        at += 3 + 4 + 4 + 1;
    }
    std::vector<SurfaceTriangle> triangles(faces);
    for (SurfaceTriangle& triangle : triangles) {
        ++at;
        for (Vec3& corner : triangle.corners) {
            std::uint32_t number = 0;
            take(number);
            corner = positions.at(number);
        }
        triangle.safe = *at++ == 1;
    }
    return triangles;
}

TEST_F(PlanTest, AHeatMapIsCertainOfAllThatEntersThroughAVoxel) {
    const std::string file = path("map.nii.gz");
    const Arguments asked = labelled({"--avoid", "Skull", "--margin", "1", "--mesh", "builtin:needle:2:60",
                                      "--max-angle", "40", "--entries", "2562"});
    Arguments all = asked;
    all.insert(all.end(), {"--heat-map", file, "--surface", path("entries.ply"), "--output", path("rows.csv")});
    output(plan(all));
    const VolumeData map = io::readVolume(file).value();
    const VolumeData head = io::readVolume(path("labels.nii.gz")).value();
    // The space of the input, to the last bit.
    EXPECT_EQ(map.grid.size, head.grid.size);
    EXPECT_EQ(map.grid.spacing, head.grid.spacing);
    EXPECT_EQ(map.grid.origin, head.grid.origin);
    EXPECT_EQ(map.grid.direction, head.grid.direction);
    ASSERT_EQ(map.type, ScalarType::Float32);
    std::vector<float> values(map.voxels.size() / sizeof(float));
    std::memcpy(values.data(), map.voxels.data(), map.voxels.size());
    const Mat4 texture_from_world = textureFromWorld(map.grid).value();
    const auto valueAt = [&](const Vec3& world) {
        const Vec3 texture = transformPoint(texture_from_world, world);
        std::array<std::size_t, 3> voxel{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            voxel[axis] = static_cast<std::size_t>(texture[axis] * map.grid.size[axis]);
        }
        return values.at((voxel[2] * map.grid.size[1] + voxel[1]) * map.grid.size[0] + voxel[0]);
    };
    // No entry keeps less than its voxel says.
    std::size_t some = 0;
    const std::vector<std::string> lines = linesOf(readText(path("rows.csv")));
    for (std::size_t i = 1; i < lines.size(); ++i) {
        const std::vector<std::string> fields = fieldsOf(lines[i]);
        const float value = valueAt({std::stod(fields.at(1)), std::stod(fields.at(2)), std::stod(fields.at(3))});
        EXPECT_LE(value, std::stod(fields.at(6)));
        some += value > 1 ? 1 : 0;
    }
    EXPECT_GT(some, lines.size() / 20);
    // Every voxel that a triangle reaches into has a value, which is no more than the margin where one of them is not
    // safe; and no other voxel has one.
    const std::string ply = readText(path("entries.ply"));
    const auto countOf = [&](const std::string& name) {
        return static_cast<std::size_t>(std::stoul(ply.substr(ply.find(name) + name.size())));
    };
    const auto seed = std::random_device()();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> share(0, 1);
    for (const SurfaceTriangle& triangle : trianglesOf(ply, countOf("element vertex "), countOf("element face "))) {
        for (int sample = 0; sample < 40; ++sample) {
            const double a = share(random);
            const double b = share(random) * (1 - a);
            Vec3 at{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                at[axis] = a * triangle.corners[0][axis] + b * triangle.corners[1][axis] +
                           (1 - a - b) * triangle.corners[2][axis];
            }
            ASSERT_GE(valueAt(at), 0);
        }
    }
    std::size_t with = 0;
    for (const float value : values) {
        EXPECT_TRUE(value == -1 || value >= 0);
        with += value >= 0 ? 1 : 0;
    }
    // As many as a surface of this area has: an area of 1 voxel^2 reaches into 1 to 3 voxels and a few beside.
    double area = 0;
    for (const SurfaceTriangle& t : trianglesOf(ply, countOf("element vertex "), countOf("element face "))) {
        Vec3 a{};
        Vec3 b{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            a[axis] = (t.corners[1][axis] - t.corners[0][axis]) / map.grid.spacing[axis];
            b[axis] = (t.corners[2][axis] - t.corners[0][axis]) / map.grid.spacing[axis];
        }
        area += 0.5 * std::hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]);
    }
    EXPECT_GT(static_cast<double>(with), area);
    EXPECT_LT(static_cast<double>(with), 3 * area + 100);
    // Of a mesh, the voxels of its entries.
    output({"make", "mesh", "builtin:needle:2:60", path("needle.stl")});
    output(plan({"--target", "20,0,30", "--avoid-opacity", "200:0,201:1", "--mesh", path("needle.stl"), "--tip",
                 "0,0,0", "--axis", "0,0,1", "--heat-map", path("mesh.nrrd")}));
    const VolumeData ofMesh = io::readVolume(path("mesh.nrrd")).value();
    std::memcpy(values.data(), ofMesh.voxels.data(), ofMesh.voxels.size());
    const auto entries = std::count_if(values.begin(), values.end(), [](float value) { return value >= 0; });
    EXPECT_GT(entries, 100);
    EXPECT_LE(entries, 162);
}

TEST_F(PlanTest, RefusesHeatMapsThatCannotBe) {
    const Arguments asked{"--target", "20,0,30", "--avoid-opacity", "200:0,201:1"};
    const auto line = [&](const Arguments& more, int status = 2) {
        Arguments all = asked;
        all.insert(all.end(), more.begin(), more.end());
        return refused(status, plan(all));
    };
    EXPECT_THAT(line({"--heat-map", path("map.png")}), HasSubstr("must be .nii.gz, .nii, .nrrd or .mha"));
    EXPECT_THAT(line({"--target", "0,0,20", "--heat-map", path("map.nii")}),
                HasSubstr("--heat-map: there are 2 targets with one file each; put {target} into '"));
    EXPECT_THAT(line({"--labels", path("labels.nii.gz"), "--heat-map", path("labels.nii.gz")}),
                HasSubstr("--heat-map"));
    // A slanted grid is no NIfTI's.
    writeText(path("slanted.mha"),
              "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nDimSize = 4 4 4\n"
              "TransformMatrix = 1 0 0 0.6 0.8 0 0 0 1\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
                  std::string(64, '\7'));
    const Ran slanted = run({"plan", "--volume", path("slanted.mha"), "--target", "2,1,1", "--entry-radius", "2",
                             "--avoid-opacity", "200:0,201:1", "--heat-map", path("map.nii.gz")});
    EXPECT_EQ(slanted.status, 1);
    EXPECT_THAT(slanted.err, HasSubstr("this format cannot hold the image's size, place or direction"));
    EXPECT_FALSE(std::filesystem::exists(path("map.nii.gz")));
}

} // namespace
} // namespace voxtact::test
