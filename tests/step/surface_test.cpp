// SPDX-License-Identifier: MIT
// Triangles against the surfaces that they stand for, and touches of what lies between.
#include "cad_files.h"
#include "cli/cli_fixture.h"
#include "support/scenes.h"
#include "support/take.h"
#include "voxtact/cpu.h"
#include "voxtact/io.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace voxtact::test {
namespace {

using glm::dvec3;
using testing::ElementsAre;
using testing::HasSubstr;

dvec3 vertexOf(const MeshData& mesh, std::size_t corner) {
    const double* const at = mesh.positions.data() + std::size_t{3} * mesh.indices[corner];
    return {at[0], at[1], at[2]};
}

double toSegment(const dvec3& point, const dvec3& a, const dvec3& b) {
    const dvec3 along = b - a;
    const double length = glm::dot(along, along);
    const double part = length > 0 ? std::clamp(glm::dot(point - a, along) / length, 0.0, 1.0) : 0;
    return glm::length(point - a - part * along);
}

double toTriangle(const dvec3& point, const dvec3& a, const dvec3& b, const dvec3& c) {
    const dvec3 normal = glm::cross(b - a, c - a);
    const auto inside = [&](const dvec3& from, const dvec3& to) {
        return glm::dot(glm::cross(to - from, point - from), normal) >= 0;
    };
    if (glm::length(normal) > 0 && inside(a, b) && inside(b, c) && inside(c, a)) {
        return std::abs(glm::dot(point - a, glm::normalize(normal)));
    }
    return std::min({toSegment(point, a, b), toSegment(point, b, c), toSegment(point, c, a)});
}

double toMesh(const Vec3& sample, const MeshData& mesh) {
    const dvec3 point(sample[0], sample[1], sample[2]);
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const dvec3 a = vertexOf(mesh, i);
        const dvec3 b = vertexOf(mesh, i + 1);
        const dvec3 c = vertexOf(mesh, i + 2);
        if (glm::length(point - a) - std::max(glm::length(b - a), glm::length(c - a)) < nearest) {
            nearest = std::min(nearest, toTriangle(point, a, b, c));
        }
    }
    return nearest;
}

class StepSurface : public CliTest {
  protected:
    [[nodiscard]] MeshData read(const TopoDS_Shape& shape, const std::string& name, double deflection) const {
        writeCad(path(name), shape);
        return take(io::readMesh(path(name), {.space = {}, .deflection = deflection}));
    }
};

TEST_F(StepSurface, IsWithinTheDeflectionOfItsTriangles) {
    for (const CadCase& one : cadCases()) {
        for (const char* name : {"m.step", "m.igs"}) {
            for (const double wanted : {0.3, 0.01}) {
                SCOPED_TRACE(one.name + " " + name + " " + std::to_string(wanted));
                const MeshData mesh = read(one.shape, name, wanted);
                double farthest = 0;
                for (const Vec3& sample : one.samples) {
                    farthest = std::max(farthest, toMesh(sample, mesh));
                }
                EXPECT_LE(farthest, mesh.deflection);
                EXPECT_LE(mesh.deflection, 2 * std::max(farthest, wanted)) << "farthest " << farthest;
                for (const std::string& note : mesh.notes) {
                    EXPECT_THAT(note, HasSubstr(" off the curved surface"));
                }
                // The edges of IGES have a tolerance: it has no solid.
                const double allowed = std::string_view(name) == "m.igs" ? 1e-5 : 1e-6;
                for (std::size_t i = 0; one.off && i < mesh.positions.size(); i += 3) {
                    EXPECT_LT(one.off({mesh.positions[i], mesh.positions[i + 1], mesh.positions[i + 2]}), allowed);
                }
            }
        }
    }
}

TEST_F(StepSurface, OfASolidIsClosedAndFacesOutward) {
    for (const CadCase& one : cadCases()) {
        const MeshData mesh = read(one.shape, "m.stp", 0.05);
        const SolidFacts facts = take(checkSolid(mesh.view()));
        EXPECT_EQ(facts.holes > 0, one.name.ends_with("patch")) << one.name;
        EXPECT_FALSE(facts.holes == 0 && facts.inward) << one.name;
    }
}

TEST_F(StepSurface, IsInMillimetresWhateverTheFileHas) {
    for (const char* name : {"m.step", "m.iges"}) {
        writeCad(path(name), sphereCase(6).shape, true);
        const MeshData mesh = take(io::readMesh(path(name)));
        const MeshFacts facts = take(checkMesh(mesh.view()));
        EXPECT_NEAR(facts.bounds.hi[2], 6, 1e-6) << name;
        EXPECT_THAT(mesh.notes.front(), HasSubstr("INCH")) << name;
        // A scale is of these millimetres; the deflection stays in those of the mesh.
        const MeshData scaled = take(io::readMesh(path(name), {.space = {}, .scale = 10, .deflection = 0.1}));
        EXPECT_NEAR(take(checkMesh(scaled.view())).bounds.hi[2], 60, 1e-5) << name;
        EXPECT_NEAR(scaled.deflection, 10 * mesh.deflection, 1e-6) << name;
    }
}

/// One opaque voxel of 0.02 mm around a point.
VolumeData speck(const dvec3& at) {
    constexpr double kSpacing = 0.02;
    constexpr std::uint32_t kSide = 9;
    Grid grid;
    grid.size = {kSide, kSide, kSide};
    grid.spacing = {kSpacing, kSpacing, kSpacing};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.origin[axis] = at[static_cast<int>(axis)] - kSpacing * (kSide / 2);
    }
    return makeBytes(grid, [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        return x == kSide / 2 && y == kSide / 2 && z == kSide / 2 ? 255 : 0;
    });
}

class StepTouch : public StepSurface {
  protected:
    Verdict touch(const MeshView& view, const dvec3& at, const Touch& question = {}, const Mat4& pose = identity()) {
        const VolumeData data = speck(at);
        const cpu::Volume volume = take(cpu::Volume::create(data.view()));
        const std::vector<ControlPoint> points{{127, 0}, {128, 1}};
        const auto function = take(cpu::TransferFunction::create({points, {0, 255}, 256}));
        const cpu::Mesh mesh = take(cpu::Mesh::create(view));
        const std::vector<Mat4> poses{pose};
        const std::vector<cpu::BatchItem> items{{&mesh, &volume, &function, poses}};
        return take(engine_.ask(question, cpu::Batch{.items = items})).pairs.front().touch;
    }

    cpu::HostEngine engine_ = take(cpu::HostEngine::create(1));
};

/// The triangles are inside of the sphere: a speck between them and it touches the sphere alone.
TEST_F(StepTouch, IsNotDeniedBetweenTheSurfaceAndItsChord) {
    const MeshData mesh = read(sphereCase(6).shape, "m.step", 0.3);
    const MeshView flat{mesh.positions, mesh.indices};
    std::size_t between = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const dvec3 middle = (vertexOf(mesh, i) + vertexOf(mesh, i + 1) + vertexOf(mesh, i + 2)) / 3.0;
        const dvec3 outward = glm::normalize(middle);
        const double gap = 6 - glm::length(middle);
        if (gap < 0.1) {
            continue;
        }
        ++between;
        const dvec3 onSphere = 6.0 * outward;
        EXPECT_EQ(touch(flat, onSphere), Verdict::No) << i << ": the test would not notice";
        EXPECT_EQ(touch(mesh.view(), onSphere), Verdict::Undecided) << i;
        EXPECT_EQ(touch(mesh.view(), middle), Verdict::Yes) << i;
        EXPECT_EQ(touch(mesh.view(), onSphere + (mesh.deflection + 0.05) * outward), Verdict::No) << i;
    }
    EXPECT_GT(between, 10U);
}

TEST_F(StepTouch, AddsTheDeflectionToMarginsUncertaintiesAndScales) {
    const MeshData mesh = read(sphereCase(6).shape, "m.step", 0.3);
    const dvec3 middle = (vertexOf(mesh, 0) + vertexOf(mesh, 1) + vertexOf(mesh, 2)) / 3.0;
    const dvec3 outward = glm::normalize(middle);
    const auto ask = [&](double distance, const Touch& question, const Mat4& pose = identity()) {
        return touch(mesh.view(), middle + distance * outward, question, pose);
    };
    EXPECT_EQ(ask(0.9, {.margin = 1}), Verdict::Yes);
    EXPECT_EQ(ask(1 + mesh.deflection / 2, {.margin = 1}), Verdict::Undecided);
    EXPECT_EQ(ask(1.1 + mesh.deflection, {.margin = 1}), Verdict::No);
    EXPECT_NE(ask(1 + mesh.deflection / 2, {.uncertainty = PoseTolerance{1, 0}}), Verdict::No);
    EXPECT_EQ(ask(1.1 + mesh.deflection, {.uncertainty = PoseTolerance{1, 0}}), Verdict::No);
    Mat4 twice = identity();
    twice[0] = twice[5] = twice[10] = 2;
    const dvec3 scaled = 2.0 * middle;
    EXPECT_EQ(touch(mesh.view(), scaled + 1.5 * mesh.deflection * outward, {}, twice), Verdict::Undecided);
    EXPECT_EQ(touch(mesh.view(), scaled + (2 * mesh.deflection + 0.1) * outward, {}, twice), Verdict::No);
}

TEST_F(StepTouch, ByTheProgram) {
    writeCad(path("m.step"), sphereCase(6).shape);
    const Arguments question{"touch", "--volume", "builtin:sphere:20", "--mesh", path("m.step"), "--iso", "1"};
    const auto with = [&](Arguments more) {
        more.insert(more.begin(), question.begin(), question.end());
        return more;
    };
    const Ran coarse = run(with({"--deflection", "0.3"}));
    EXPECT_EQ(coarse.status, 0);
    EXPECT_THAT(coarse.err, HasSubstr("m.step: triangles are up to 0.4"));
    EXPECT_THAT(rowsOf(coarse.out).front(), testing::Contains(testing::Pair("touch", "1")));
    EXPECT_THAT(refused(2, with({"--deflection", "0"})),
                HasSubstr("--deflection: '0' is not a number from 1e-06 mm on"));
    const Ran onDevice = run(with({"--on", "device"})); // the notes of the file come before the refusal
    EXPECT_EQ(onDevice.status, 2);
    EXPECT_THAT(linesOf(onDevice.err).back(), HasSubstr("needs the host engine"));
}

} // namespace
} // namespace voxtact::test
