// SPDX-License-Identifier: MIT
// The bone that a screw displaces, against what people use today, in one run and on one thread: counted voxels, counted
// samples of the interpolant at 4^3 a voxel, and the share of the screw's vertices in the bone. Says how far each is
// off, by bounds that are 100 times narrower than those that are timed.
//
//   voxtact_overlap_bench [FOLDER]
//
// FOLDER: the scene is written there. VOXTACT_BENCH_POSES are the poses.
#include "bench/bench_input.h"
#include "bench/measure/machine.h"
#include "bench/measure/numbers.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <iomanip>
#include <numbers>
#include <ostream>
#include <random>
#include <string>

namespace voxtact::bench {
namespace {

using test::makeVolume;
using test::randomRotation;
using test::uniform;

constexpr std::uint64_t kSeed = 1;
constexpr int kRounds = 7;
constexpr double kBone = 250; // HU
constexpr double kSpacing = 0.4;

/// A body of a vertebra: a cortical shell around trabeculae of about a millimetre, in soft tissue, with the noise of a
/// scanner.
VolumeData makeBone(std::mt19937_64& random) {
    Grid grid;
    grid.size = {128, 112, 160};
    grid.spacing = {kSpacing, kSpacing, kSpacing};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.origin[axis] = -0.5 * kSpacing * (grid.size[axis] - 1);
    }
    std::array<std::array<double, 4>, 48> waves{}; // trabeculae: a sum of waves of random directions
    std::normal_distribution<double> normal;
    for (auto& wave : waves) {
        wave = {2.6 * normal(random), 2.6 * normal(random), 2.6 * normal(random), uniform(random, 0, 7)};
    }
    return makeVolume<std::int16_t>(grid, ScalarType::Int16, [&](auto i, auto j, auto k) {
        const Vec3 at{grid.origin[0] + kSpacing * i, grid.origin[1] + kSpacing * j, grid.origin[2] + kSpacing * k};
        const double depth =
            std::min(15 * (1 - std::hypot(at[0] / 20, at[1] / 16)), 26 - std::abs(at[2])); // mm below the surface
        double inside = 0;
        for (const auto& wave : waves) {
            inside += std::cos(wave[0] * at[0] + wave[1] * at[1] + wave[2] * at[2] + wave[3]);
        }
        const double trabeculae = 220 + 180 * inside / std::sqrt(waves.size() / 2.0);
        const auto step = [](double x) { return std::clamp(0.5 + x / 0.8, 0.0, 1.0); };
        const double bone = 1300 + step(depth - 1.2) * (trabeculae - 1300);
        return std::round(40 + step(depth) * (bone - 40) + 25 * normal(random));
    });
}

/// 45 mm along z, from the tip on: a core of 2.1 mm radius, a thread of 3 mm with a pitch of 2.75 mm, a head. Closed.
MeshData makeScrew() {
    constexpr std::uint32_t kAround = 32;
    constexpr std::uint32_t kRings = 121;
    constexpr double kLength = 45;
    MeshData mesh;
    mesh.name = "screw";
    const auto addPoint = [&](double x, double y, double z) { mesh.positions.insert(mesh.positions.end(), {x, y, z}); };
    for (std::uint32_t ring = 0; ring < kRings; ++ring) {
        const double z = kLength * ring / (kRings - 1);
        for (std::uint32_t i = 0; i < kAround; ++i) {
            const double turn = static_cast<double>(i) / kAround;
            const double phase = z / 2.75 - turn;
            const double ridge = std::max(0.0, 1 - 1.6 * std::abs(2 * (phase - std::floor(phase)) - 1));
            const double shaft = (2.1 + 0.9 * ridge) * std::min(1.0, 0.25 + z / 8);
            const double radius = z > kLength - 4 ? 4.5 : shaft;
            addPoint(radius * std::cos(2 * std::numbers::pi * turn), radius * std::sin(2 * std::numbers::pi * turn), z);
        }
    }
    addPoint(0, 0, -0.4);
    addPoint(0, 0, kLength);
    for (std::uint32_t i = 0; i < kAround; ++i) {
        const std::uint32_t next = (i + 1) % kAround;
        for (std::uint32_t ring = 0; ring + 1 < kRings; ++ring) {
            const std::uint32_t low = ring * kAround;
            const std::uint32_t high = low + kAround;
            mesh.indices.insert(mesh.indices.end(), {low + i, low + next, high + next, low + i, high + next, high + i});
        }
        const std::uint32_t top = (kRings - 1) * kAround;
        mesh.indices.insert(mesh.indices.end(), {kRings * kAround, next, i, kRings * kAround + 1, top + i, top + next});
    }
    return mesh;
}

/// With the tip in the body, in a random direction.
std::vector<Mat4> makePoses(std::mt19937_64& random, std::uint32_t number) {
    std::vector<Mat4> poses;
    while (poses.size() < number) {
        const Vec3 tip{uniform(random, -14, 14), uniform(random, -11, 11), uniform(random, -20, 20)};
        poses.push_back(multiply(translation(tip), randomRotation(random)));
    }
    return poses;
}

/// Counts samples inside a mesh, `parts`^3 a voxel, by rows along x: each triangle changes the winding number behind
/// the place where it crosses a row.
class SampleCount {
  public:
    SampleCount(const VolumeData& volume, const MeshData& mesh, std::uint32_t parts)
        : volume_(volume), mesh_(mesh), parts_(parts), world_from_index_(worldFromIndex(volume.grid)),
          index_from_world_(take(inverse(world_from_index_))) {}

    /// mm^3 of bone.
    double at(const Mat4& pose) {
        crossings_.clear();
        const Mat4 sample_from_object = multiply(sampleFromIndex(), multiply(index_from_world_, pose));
        std::vector<Vec3> points(mesh_.positions.size() / 3);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const double* p = &mesh_.positions[3 * i];
            points[i] = transformPoint(sample_from_object, {p[0], p[1], p[2]});
        }
        for (std::size_t i = 0; i < mesh_.indices.size(); i += 3) {
            addTriangle(points[mesh_.indices[i]], points[mesh_.indices[i + 1]], points[mesh_.indices[i + 2]]);
        }
        std::ranges::sort(crossings_, [](const Crossing& a, const Crossing& b) {
            return a.row != b.row ? a.row < b.row : a.x < b.x;
        });
        std::uint64_t count = 0;
        int winding = 0;
        for (std::size_t i = 0; i + 1 < crossings_.size(); ++i) {
            winding += crossings_[i].sign;
            if (winding != 0 && crossings_[i].row == crossings_[i + 1].row) {
                count += countIn(crossings_[i].row, crossings_[i].x, crossings_[i + 1].x);
            }
        }
        return static_cast<double>(count) * std::pow(kSpacing / parts_, 3);
    }

  private:
    struct Crossing {
        std::uint64_t row = 0;
        double x = 0;
        int sign = 0;
    };
    [[nodiscard]] std::int64_t size(std::size_t axis) const { return std::int64_t{volume_.grid.size[axis]} * parts_; }
    /// Sample i of a voxel's parts is at (i + 0.5) / parts - 0.5 from its centre.
    [[nodiscard]] Mat4 sampleFromIndex() const {
        const double by = parts_;
        const double offset = 0.5 * by - 0.5;
        return {by, 0, 0, 0, 0, by, 0, 0, 0, 0, by, 0, offset, offset, offset, 1};
    }

    void addTriangle(const Vec3& a, const Vec3& b, const Vec3& c) {
        const double area = (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]);
        const auto range = [&](std::size_t axis, std::int64_t& first, std::int64_t& last) {
            const auto [lo, hi] = std::minmax({a[axis], b[axis], c[axis]});
            first = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(lo)));
            last = std::min(size(axis) - 1, static_cast<std::int64_t>(std::floor(hi)));
        };
        std::int64_t y0 = 0;
        std::int64_t y1 = 0;
        std::int64_t z0 = 0;
        std::int64_t z1 = 0;
        range(1, y0, y1);
        range(2, z0, z1);
        for (std::int64_t z = z0; z <= z1; ++z) {
            for (std::int64_t y = y0; y <= y1; ++y) {
                const auto edge = [&](const Vec3& p, const Vec3& q) {
                    return (q[1] - p[1]) * (static_cast<double>(z) - p[2]) -
                           (q[2] - p[2]) * (static_cast<double>(y) - p[1]);
                };
                const double u = edge(b, c);
                const double v = edge(c, a);
                const double w = edge(a, b);
                if ((u >= 0 && v >= 0 && w >= 0 && area > 0) || (u < 0 && v < 0 && w < 0)) {
                    crossings_.push_back({static_cast<std::uint64_t>(z * size(1) + y),
                                          (u * a[0] + v * b[0] + w * c[0]) / (u + v + w), area > 0 ? -1 : 1});
                }
            }
        }
    }

    [[nodiscard]] std::uint64_t countIn(std::uint64_t row, double from, double to) const {
        const auto rows = static_cast<std::uint64_t>(size(1));
        const std::int64_t first = std::max<std::int64_t>(0, static_cast<std::int64_t>(std::ceil(from)));
        const std::int64_t end = std::min(size(0), static_cast<std::int64_t>(std::ceil(to)));
        std::uint64_t count = 0;
        for (std::int64_t x = first; x < end; ++x) {
            count += valueAt(x, static_cast<std::int64_t>(row % rows), static_cast<std::int64_t>(row / rows)) >= kBone;
        }
        return count;
    }

    [[nodiscard]] double voxel(std::size_t x, std::size_t y, std::size_t z) const {
        const auto& size = volume_.grid.size;
        std::int16_t value = 0;
        std::memcpy(&value, volume_.voxels.data() + 2 * ((z * size[1] + y) * size[0] + x), 2);
        return value;
    }
    [[nodiscard]] double valueAt(std::int64_t x, std::int64_t y, std::int64_t z) const {
        const std::array<std::int64_t, 3> sample{x, y, z};
        if (parts_ == 1) {
            return voxel(static_cast<std::size_t>(x), static_cast<std::size_t>(y), static_cast<std::size_t>(z));
        }
        std::array<std::size_t, 3> lo{};
        std::array<std::size_t, 3> hi{};
        Vec3 part{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double most = volume_.grid.size[axis] - 1;
            const double at = std::clamp((static_cast<double>(sample[axis]) + 0.5) / parts_ - 0.5, 0.0, most);
            lo[axis] = static_cast<std::size_t>(at);
            hi[axis] = std::min(lo[axis] + 1, static_cast<std::size_t>(most));
            part[axis] = at - static_cast<double>(lo[axis]);
        }
        const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
        const auto along = [&](std::size_t j, std::size_t k) {
            return mix(voxel(lo[0], j, k), voxel(hi[0], j, k), part[0]);
        };
        return mix(mix(along(lo[1], lo[2]), along(hi[1], lo[2]), part[1]),
                   mix(along(lo[1], hi[2]), along(hi[1], hi[2]), part[1]), part[2]);
    }

    const VolumeData& volume_;
    const MeshData& mesh_;
    std::uint32_t parts_;
    Mat4 world_from_index_;
    Mat4 index_from_world_;
    std::vector<Crossing> crossings_;
};

struct Scene {
    std::mt19937_64 random{kSeed};
    VolumeData data = makeBone(random);
    MeshData shape = makeScrew();
    std::vector<Mat4> poses = makePoses(random, numberFrom("VOXTACT_BENCH_POSES", 200));
    cpu::Volume volume = take(cpu::Volume::create(data.view()));
    cpu::Mesh mesh = take(cpu::Mesh::create(shape.view()));
    cpu::TransferFunction function =
        take(cpu::TransferFunction::create({std::array{ControlPoint{kBone, 0}, ControlPoint{kBone, 1}}, {0, 4000}}));
    cpu::HostEngine engine = take(cpu::HostEngine::create(1));
    double whole = 0; ///< mm^3 of the screw

    /// `share`: of the screw's volume, the tolerance.
    std::vector<PairOverlap> ask(double share) {
        const cpu::BatchItem item{&mesh, &volume, &function, poses};
        return take(engine.ask(Overlap{.tolerance = share * whole}, cpu::Batch{{&item, 1}, {}, 1})).pairs;
    }
    std::vector<double> middles(double share) {
        std::vector<double> out;
        for (const PairOverlap& pair : ask(share)) {
            out.push_back((pair.bounds.lower + pair.bounds.upper) / 2);
        }
        return out;
    }
};

/// A way to measure, timed in turn with the others.
struct Way {
    const char* name;
    std::function<std::vector<double>()> measure; ///< mm^3 of all poses
    std::vector<double> found{};
    std::vector<double> rates{};  ///< poses per second of CPU time
    std::vector<double> ratios{}; ///< to the first way in the same round
};

void print(const Way& way, const std::vector<double>& truth, double whole) {
    std::vector<double> errors;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        errors.push_back(100 * std::abs(way.found[i] - truth[i]) / whole);
    }
    const lab::Spread rate = lab::spreadOf(way.rates);
    const lab::Spread ratio = lab::spreadOf(way.ratios);
    const lab::Spread error = lab::spreadOf(errors);
    std::printf(
        "%-34s %9s poses per CPU second (%s to %s), %s times the first (%s to %s); off by %s %% of the screw in "
        "the median, %s %% at most\n",
        way.name, lab::shortNumber(rate.median).c_str(), lab::shortNumber(rate.min).c_str(),
        lab::shortNumber(rate.max).c_str(), lab::shortNumber(ratio.median).c_str(), lab::shortNumber(ratio.min).c_str(),
        lab::shortNumber(ratio.max).c_str(), lab::shortNumber(error.median).c_str(),
        lab::shortNumber(error.max).c_str());
}

void write(const Scene& scene, const std::filesystem::path& folder) {
    std::filesystem::create_directories(folder);
    const auto check = [](const Result<void>& written) {
        if (!written.ok()) {
            std::fprintf(stderr, "%s\n", written.error().text.c_str());
            std::exit(1);
        }
    };
    check(io::writeVolume(folder / "bone.nrrd", scene.data.view()));
    check(io::writeMesh(folder / "screw.stl", scene.shape.view()));
    check(io::writeFile(folder / "poses.txt", [&](std::ostream& out) -> Result<void> {
        out << std::setprecision(17);
        for (const Mat4& pose : scene.poses) {
            for (std::size_t i = 0; i < 16; ++i) {
                out << pose[4 * (i % 4) + i / 4] << (i == 15 ? '\n' : ' ');
            }
        }
        return {};
    }));
}

/// The share of vertices in bone, of the screw's volume.
std::vector<double> byVertices(const Scene& scene) {
    const Mat4 index_from_world = take(inverse(worldFromIndex(scene.data.grid)));
    const auto& size = scene.data.grid.size;
    std::vector<double> out;
    for (const Mat4& pose : scene.poses) {
        const Mat4 index_from_object = multiply(index_from_world, pose);
        std::size_t count = 0;
        for (std::size_t i = 0; i < scene.shape.positions.size(); i += 3) {
            const double* at = &scene.shape.positions[i];
            const Vec3 index = transformPoint(index_from_object, {at[0], at[1], at[2]});
            std::array<std::int64_t, 3> voxel{};
            bool isIn = true;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                voxel[axis] = std::lround(index[axis]);
                isIn = isIn && voxel[axis] >= 0 && voxel[axis] < size[axis];
            }
            if (isIn) {
                std::int16_t value = 0;
                const auto number = static_cast<std::size_t>((voxel[2] * size[1] + voxel[1]) * size[0] + voxel[0]);
                std::memcpy(&value, scene.data.voxels.data() + 2 * number, 2);
                count += value >= kBone ? 1 : 0;
            }
        }
        out.push_back(scene.whole * static_cast<double>(3 * count) / static_cast<double>(scene.shape.positions.size()));
    }
    return out;
}

void measure(Scene& scene) {
    SampleCount voxels(scene.data, scene.shape, 1);
    SampleCount samples(scene.data, scene.shape, 4);
    const auto count = [&](SampleCount& by) {
        std::vector<double> out;
        for (const Mat4& pose : scene.poses) {
            out.push_back(by.at(pose));
        }
        return out;
    };
    std::vector<Way> ways{{"overlap, to 1 % of the screw", [&] { return scene.middles(1e-2); }},
                          {"overlap, to 0.1 %", [&] { return scene.middles(1e-3); }},
                          {"voxels counted", [&] { return count(voxels); }},
                          {"4^3 samples a voxel counted", [&] { return count(samples); }},
                          {"share of vertices", [&] { return byVertices(scene); }}};
    std::vector<double> truth;
    double widest = 0;
    for (const PairOverlap& pair : scene.ask(1e-5)) {
        truth.push_back((pair.bounds.lower + pair.bounds.upper) / 2);
        widest = std::max(widest, pair.bounds.upper - pair.bounds.lower);
    }
    const lab::Spread share = lab::spreadOf(truth);
    std::printf(
        "bone in the screw: %.4g to %.4g mm^3, %.4g in the median, known to %.2g mm^3; the screw has %.4g mm^3\n",
        share.min, share.max, share.median, widest, scene.whole);
    for (int round = 0; round <= kRounds; ++round) {
        for (Way& way : ways) {
            const std::clock_t begin = std::clock();
            way.found = way.measure();
            if (round > 0) {
                const auto ticks = static_cast<double>(std::clock() - begin);
                way.rates.push_back(static_cast<double>(truth.size()) * CLOCKS_PER_SEC / ticks);
                way.ratios.push_back(way.rates.back() / ways.front().rates.back());
            }
        }
    }
    for (const Way& way : ways) {
        print(way, truth, scene.whole);
    }
}

} // namespace
} // namespace voxtact::bench

int main(int count, char** arguments) {
    using namespace voxtact::bench;
    Scene scene;
    scene.whole = take(voxtact::checkSolid(scene.shape.view())).signedVolume;
    if (count > 1) {
        write(scene, arguments[1]);
    }
    std::printf("%u x %u x %u voxels of %g mm, bone from %g on; a screw with %zu triangles; %zu poses, seed %llu\n%s, "
                "one thread, %d rounds\n",
                scene.data.grid.size[0], scene.data.grid.size[1], scene.data.grid.size[2], kSpacing, kBone,
                scene.shape.indices.size() / 3, scene.poses.size(), static_cast<unsigned long long>(kSeed),
                voxtact::lab::describeHost({}).cpu.c_str(), kRounds);
    measure(scene);
    return 0;
}
