// SPDX-License-Identifier: MIT
// The host engine, without Vulkan: whether a scalpel touches a head and where, how near it is and how much of it
// touches, whether the way to the next pose is free, and which straight paths to a target keep clear of a structure.
// The marked parts are the ones that the manual shows.
//
// Exit status: 0 done, 1 something failed.
#include "voxtact/cpu.h"
#include "voxtact/samples.h"

#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

using namespace voxtact;

namespace {

/// voxtact throws nothing: an error is a value, and this program ends with it.
template <class T> T take(Result<T> result) {
    if (!result) {
        std::fprintf(stderr, "host: %s\n", result.error().text.c_str());
        std::exit(EXIT_FAILURE);
    }
    return std::move(*result);
}

void touch(cpu::HostEngine& engine, const cpu::Batch& batch) {
    // [touch]
    const TouchAnswer answer = take(engine.ask(Touch{.witness = true}, batch));
    for (const PairTouch& pair : answer.pairs) {
        std::printf("pose %u touches: %s\n", pair.pose, toString(pair.touch)); // yes, no or undecided
    }
    const BatchAnswer counted =
        take(engine.ask(Count{.projection = Projection::Certified, .outputs = {.contacts = true}}, batch));
    for (const Contact& contact : counted.contacts) { // by pair, then by triangle
        std::printf("pair %u, triangle %u, %.1f mm deep\n", contact.pair, contact.triangle, contact.depth);
    }
    // [/touch]
}

void measure(cpu::HostEngine& engine, const cpu::Batch& batch) {
    // [distance]
    const DistanceAnswer answer = take(engine.ask(Distance{.tolerance = 0.1}, batch));
    for (const PairDistance& pair : answer.pairs) {
        std::printf("pose %u: %.2f to %.2f mm\n", pair.pose, pair.bounds.lower, pair.bounds.upper);
    }
    const TouchAnswer near = take(engine.ask(Touch{.margin = 2}, batch)); // is anything opaque within 2 mm?
    // [/distance]
    std::printf("%zu margins\n", near.pairs.size());
}

void measureArea(cpu::HostEngine& engine, const cpu::Batch& batch) {
    // [area]
    const AreaAnswer answer = take(engine.ask(Area{.tolerance = 1}, batch));
    for (const PairArea& pair : answer.pairs) {
        std::printf("pose %u: %.0f to %.0f mm^2\n", pair.pose, pair.bounds.lower, pair.bounds.upper);
    }
    // [/area]
}

void follow(const cpu::BatchItem& scene, std::span<const Mat4> hand) {
    // [tracker]
    cpu::DistanceTracker tracker = take(cpu::DistanceTracker::create());
    for (const Mat4& pose : hand) {
        cpu::BatchItem tick = scene; // mesh, volume and transfer function are the same at each tick
        tick.world_from_object = {&pose, 1};
        const TrackedDistance now = take(tracker.track(tick));
        std::printf("%s, at least %.2f mm%s\n", now.hit ? "touches" : "free", now.bounds.lower,
                    now.searched ? "" : ", known from before");
    }
    // [/tracker]
}

void move(cpu::HostEngine& engine, const cpu::Batch& batch) {
    // [motion]
    const MotionAnswer answer = take(engine.ask(Motion{.interpolation = Interpolation::Slerp}, batch));
    for (const SegmentMotion& segment : answer.segments) {
        std::printf("segment %u is free until %.3f\n", segment.segment, segment.freeUntil);
        if (segment.touch) {
            std::printf("and touches at %.3f\n", segment.touch->at);
        }
    }
    // Does it touch at any pose that is off by at most 1 mm and 2 degrees?
    const TouchAnswer off = take(engine.ask(Touch{.uncertainty = PoseTolerance{1, 2}}, batch));
    // [/motion]
    std::printf("%zu poses that may be off\n", off.pairs.size());
}

void plan(cpu::HostEngine& engine, const cpu::Volume& volume, const LabelData& labels, const Vec3& target) {
    // [plan]
    const cpu::PlanObstacle vessels{.volume = &volume, .labels = &labels, .avoid = {1}}; // all that has this label
    const PlanAnswer answer = take(engine.ask(cpu::Plan{.target = target,
                                                        .surface = {.entries = 1002, .radius = 80},
                                                        .obstacles = {&vessels, 1},
                                                        .needle = {.diameter = 2, .length = 150},
                                                        .margin = 2}));
    std::size_t safe = 0;
    for (const PlannedPath& path : answer.paths) {
        safe += path.safety == Safety::Safe ? 1 : 0;
    }
    std::printf("%zu of %zu paths are safe, and %.0f of %.0f mm2\n", safe, answer.paths.size(), answer.safeArea,
                answer.area);
    // [/plan]
}

/// A ball of 10 mm beside the middle, on the grid of the volume.
LabelData makeStructure(const Grid& grid) {
    LabelData labels{grid, std::vector<std::uint16_t>(std::size_t{grid.size[0]} * grid.size[1] * grid.size[2]), {0, 1}};
    std::size_t voxel = 0;
    for (std::uint32_t z = 0; z < grid.size[2]; ++z) {
        for (std::uint32_t y = 0; y < grid.size[1]; ++y) {
            for (std::uint32_t x = 0; x < grid.size[0]; ++x, ++voxel) {
                const double across[] = {(x - grid.size[0] / 2.0) * grid.spacing[0] - 25,
                                         (y - grid.size[1] / 2.0) * grid.spacing[1],
                                         (z - grid.size[2] / 2.0) * grid.spacing[2]};
                const double distance2 = across[0] * across[0] + across[1] * across[1] + across[2] * across[2];
                labels.indices[voxel] = distance2 < 100 ? 1 : 0;
            }
        }
    }
    return labels;
}

} // namespace

int main() {
    const VolumeData head = take(makeBuiltinVolume("head:64"));
    // [scene]
    const ControlPoint points[] = {{40, 0}, {80, 1}}; // of the image's own units
    const cpu::Volume volume = take(cpu::Volume::create(head.view()));
    const cpu::TransferFunction function = take(cpu::TransferFunction::create({.points = points}));
    const cpu::Mesh scalpel = take(cpu::Mesh::create(take(makeScalpel()).view()));
    const std::vector<Mat4> poses = {translation({0, 0, 150}), translation({0, 0, 120}), translation({0, 0, 85})};
    const cpu::BatchItem item{&scalpel, &volume, &function, poses};
    const cpu::Batch batch{.items = {&item, 1}, .threshold = 0.1};
    cpu::HostEngine engine = take(cpu::HostEngine::create());
    // [/scene]
    touch(engine, batch);
    measure(engine, batch);
    measureArea(engine, batch);
    const std::vector<Mat4> hand = {translation({0, 0, 150}), translation({0, 0, 149}), translation({0, 0, 148})};
    follow(item, hand);
    move(engine, batch);
    plan(engine, volume, makeStructure(volume.grid()), {0, 0, 0});
}
