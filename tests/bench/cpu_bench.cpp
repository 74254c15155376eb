// SPDX-License-Identifier: MIT
// Counted pairs per second of the host engine, for the two built-in instruments against a head, over poses near the
// volume, around the onset of contact, and deep inside. Each scene is verified against the reference before it is
// timed. VOXTACT_BENCH_VOLUME names another volume (a file) where voxtact::io is built.
#include "host/count/reference.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/samples.h"
#ifdef VOXTACT_BENCH_IO
#include "voxtact/io.h"
#endif

#include <benchmark/benchmark.h>

#include <array>
#include <cstdlib>
#include <iostream>
#include <optional>

namespace voxtact::test {
namespace {

constexpr std::size_t kPoses = 256;
constexpr std::size_t kVerified = 8;
constexpr std::array kRamp{ControlPoint{40, 0}, ControlPoint{80, 1}};

enum class Where { Near, Onset, Inside };

struct Subject {
    VolumeData volume;
    MeshData mesh;
    View view;
    std::optional<cpu::Volume> volumeOn;
    std::optional<cpu::Mesh> meshOn;
    std::optional<cpu::TransferFunction> function;
    std::array<std::vector<Mat4>, 3> poses;
};

std::uint64_t countOf(const Subject& subject, const Mat4& pose) {
    return cpu::referenceCounts({subject.mesh.view(), subject.volume.view(), {kRamp, {0, 255}}, subject.view, pose})
        .survivors;
}

/// The object's origin within `share` of the volume's box, around its centre.
Mat4 poseWithin(const Grid& grid, double share, std::mt19937_64& random) {
    return randomPoses(grid, 1, share, random).front();
}

/// Moves along a line until the count changes from none to some, to within a fifth of a millimetre.
Mat4 onsetPose(const Subject& subject, std::mt19937_64& random) {
    const Vec3 centre = transformPoint(worldFromTexture(subject.volume.grid), {0.5, 0.5, 0.5});
    const Mat4 turn = randomRotation(random);
    const Vec3 direction = transformPoint(randomRotation(random), {0, 0, 1});
    const auto at = [&](double distance) {
        return multiply(translation({centre[0] + distance * direction[0], centre[1] + distance * direction[1],
                                     centre[2] + distance * direction[2]}),
                        turn);
    };
    double touching = 0;
    double clear = 400;
    while (clear - touching > 0.2) {
        const double middle = (touching + clear) / 2;
        (countOf(subject, at(middle)) > 0 ? touching : clear) = middle;
    }
    return at(uniform(random, touching - 1, clear + 1));
}

VolumeData loadVolume() {
#ifdef VOXTACT_BENCH_IO
    if (const char* path = std::getenv("VOXTACT_BENCH_VOLUME"); path != nullptr) {
        return std::move(io::readVolume(path)).value();
    }
#endif
    return std::move(makeBuiltinVolume("head:256")).value();
}

void verify(const Subject& subject) {
    cpu::Detector detector = std::move(cpu::Detector::create()).value();
    for (const std::vector<Mat4>& poses : subject.poses) {
        const cpu::BatchItem item{&*subject.meshOn, &*subject.volumeOn, &*subject.function,
                                  std::span(poses).first(kVerified)};
        const BatchAnswer answer = std::move(detector.detect({std::span(&item, 1), subject.view})).value();
        for (std::size_t i = 0; i < kVerified; ++i) {
            if (answer.pairs[i].count != countOf(subject, poses[i])) {
                std::cerr << "pose " << i << ": the engine counts " << answer.pairs[i].count << ", the reference "
                          << countOf(subject, poses[i]) << "\n";
                std::exit(1);
            }
        }
    }
}

Subject makeSubject(const char* mesh) {
    Subject subject;
    subject.volume = loadVolume();
    subject.mesh = std::move(makeBuiltinMesh(mesh)).value();
    subject.view = {framingCamera(subject.volume.grid, 512, 512), 512, 512};
    subject.volumeOn = std::move(cpu::Volume::create(subject.volume.view())).value();
    subject.meshOn = std::move(cpu::Mesh::create(subject.mesh.view())).value();
    subject.function = std::move(cpu::TransferFunction::create({kRamp, {0, 255}})).value();
    std::mt19937_64 random(20240501);
    for (std::size_t i = 0; i < kPoses; ++i) {
        subject.poses[0].push_back(poseWithin(subject.volume.grid, 1, random));
        if (i < kPoses / 4) {
            subject.poses[1].push_back(onsetPose(subject, random));
        }
        subject.poses[2].push_back(poseWithin(subject.volume.grid, 0.2, random));
    }
    verify(subject);
    return subject;
}

const Subject& subjectOf(const char* mesh) {
    static std::vector<std::pair<std::string, std::unique_ptr<Subject>>> made;
    for (const auto& [name, subject] : made) {
        if (name == mesh) {
            return *subject;
        }
    }
    made.emplace_back(mesh, std::make_unique<Subject>(makeSubject(mesh)));
    return *made.back().second;
}

void count(benchmark::State& state, const char* mesh, Where where, bool stopAtFirst) {
    const Subject& subject = subjectOf(mesh);
    const std::vector<Mat4>& poses = subject.poses[static_cast<std::size_t>(where)];
    cpu::Detector detector = std::move(cpu::Detector::create({.threads = static_cast<std::uint32_t>(state.range(0)),
                                                              .stopAtFirst = stopAtFirst}))
                                 .value();
    const cpu::BatchItem item{&*subject.meshOn, &*subject.volumeOn, &*subject.function, poses};
    std::size_t hits = 0;
    std::uint64_t survivors = 0;
    for (auto _ : state) {
        const BatchAnswer answer = std::move(detector.detect({std::span(&item, 1), subject.view})).value();
        hits = 0;
        survivors = 0;
        for (const PairAnswer& pair : answer.pairs) {
            hits += pair.hit ? 1U : 0U;
            survivors += pair.count;
        }
    }
    const auto pairs = static_cast<double>(poses.size());
    state.counters["pairs"] =
        benchmark::Counter(pairs * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
    state.counters["hits"] = static_cast<double>(hits) / pairs;
    state.counters["survivors"] = static_cast<double>(survivors) / pairs;
}

void scenes(benchmark::internal::Benchmark* bench) {
    bench->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
}

BENCHMARK_CAPTURE(count, scalpel_near, "scalpel", Where::Near, false)->Apply(scenes);
BENCHMARK_CAPTURE(count, scalpel_onset, "scalpel", Where::Onset, false)->Apply(scenes);
BENCHMARK_CAPTURE(count, scalpel_inside, "scalpel", Where::Inside, false)->Apply(scenes);
BENCHMARK_CAPTURE(count, scalpel_near_first, "scalpel", Where::Near, true)->Apply(scenes);
BENCHMARK_CAPTURE(count, scalpel_onset_first, "scalpel", Where::Onset, true)->Apply(scenes);
BENCHMARK_CAPTURE(count, ellipsoid_near, "ellipsoid", Where::Near, false)->Apply(scenes);
BENCHMARK_CAPTURE(count, ellipsoid_onset, "ellipsoid", Where::Onset, false)->Apply(scenes);
BENCHMARK_CAPTURE(count, ellipsoid_inside, "ellipsoid", Where::Inside, false)->Apply(scenes);
BENCHMARK_CAPTURE(count, ellipsoid_near_first, "ellipsoid", Where::Near, true)->Apply(scenes);

} // namespace
} // namespace voxtact::test

BENCHMARK_MAIN();
