// SPDX-License-Identifier: MIT
#include "device/detector/self_test.h"
#include "core/base/guard.h"
#include "core/base/try.h"

#include <algorithm>
#include <array>

namespace voxtact {

namespace {

constexpr std::uint32_t kSide = 32; ///< pixels; the square covers every pixel centre exactly once
constexpr std::uint32_t kVoxels = 8;

/// A volume and the number of fragments of a full viewport that must survive in it.
struct Scene {
    const char* name;
    std::uint32_t opaqueSlabs; ///< voxels with x below this are opaque
    std::uint64_t expected;
};

constexpr std::array kScenes{Scene{"opaque", kVoxels, kSide* kSide}, Scene{"transparent", 0, 0},
                             Scene{"half-opaque", kVoxels / 2, kSide* kSide / 2}};

/// World is the texture space of the volume: a unit cube.
Grid unitGrid() {
    Grid grid;
    grid.size = {kVoxels, kVoxels, kVoxels};
    grid.spacing = {1.0 / kVoxels, 1.0 / kVoxels, 1.0 / kVoxels};
    grid.origin = {0.5 / kVoxels, 0.5 / kVoxels, 0.5 / kVoxels};
    return grid;
}

Result<Volume> makeVolume(const Context& context, const QueueAccess& queue, const Scene& scene) {
    std::array<std::byte, kVoxels * kVoxels * kVoxels> voxels{};
    for (std::size_t i = 0; i < voxels.size(); ++i) {
        voxels[i] = i % kVoxels < scene.opaqueSlabs ? std::byte{255} : std::byte{0};
    }
    return Volume::upload(context, queue, {unitGrid(), ScalarType::UInt8, voxels}, {.name = "self-test volume"});
}

Result<Mesh> makeSquare(const Context& context, const QueueAccess& queue) {
    constexpr std::array<double, 12> kCorners{0, 0, 0.5, 1, 0, 0.5, 1, 1, 0.5, 0, 1, 0.5};
    constexpr std::array<std::uint32_t, 6> kTriangles{0, 1, 2, 0, 2, 3};
    return Mesh::upload(context, queue, {kCorners, kTriangles}, {.name = "self-test square"});
}

/// x and y of the unit square fill the viewport.
Mat4 squareCamera() {
    Mat4 clip_from_world = identity();
    clip_from_world[0] = 2;
    clip_from_world[5] = 2;
    clip_from_world[12] = -1;
    clip_from_world[13] = -1;
    return clip_from_world;
}

struct SelfTestScene {
    Mesh square;
    TransferFunction transferFunction;
    std::vector<Volume> volumes; ///< by kScenes
};

Result<SelfTestScene> makeScene(const Context& context, const QueueAccess& queue) {
    constexpr std::array kRamp{ControlPoint{0, 0}, ControlPoint{255, 1}};
    Result<Mesh> square = makeSquare(context, queue);
    VOXTACT_TRY(square);
    Result<TransferFunction> ramp = TransferFunction::upload(context, queue, {.points = kRamp}, "self-test ramp");
    VOXTACT_TRY(ramp);
    SelfTestScene out{std::move(*square), std::move(*ramp), {}};
    for (const Scene& scene : kScenes) {
        Result<Volume> volume = makeVolume(context, queue, scene);
        VOXTACT_TRY(volume);
        out.volumes.push_back(std::move(*volume));
    }
    return out;
}

Result<SelfTestVerdict> judge(const Context& context, const QueueAccess& queue, const SelfTestScene& scene,
                              CountingMethod method, std::uint32_t arithmeticGroups) {
    SelfTestVerdict verdict{method, true, true, {}};
    Result<BlockingDetector> detector =
        BlockingDetector::create(context, RasterDesc{.method = method, .filter = defaultFilter(method)}, queue);
    VOXTACT_TRY(detector);
    const Mat4 pose = identity();
    std::vector<BatchItem> items;
    for (const Volume& volume : scene.volumes) {
        items.push_back({&scene.square, &volume, &scene.transferFunction, std::span(&pose, 1)});
    }
    const Result<BatchAnswer> answer = detector->detect({items, {squareCamera(), kSide, kSide}, 0.5});
    VOXTACT_TRY(answer);
    for (const PairAnswer& pair : answer->pairs) {
        const Scene& expected = kScenes[pair.item];
        const bool right =
            pair.exactness == Exactness::Exact ? pair.count == expected.expected : pair.hit == (expected.expected > 0);
        verdict.trusted = verdict.trusted && right;
        verdict.text += (verdict.text.empty() ? "" : ", ") + std::string(expected.name) + " " +
                        (pair.exactness == Exactness::Exact
                             ? std::to_string(pair.count) + " of " + std::to_string(expected.expected)
                             : std::string(pair.hit ? "hit" : "no hit")) +
                        (right ? "" : " WRONG");
    }
    if (defaultFilter(method) == Filter::Exact) {
        const Result<ArithmeticVerdict> arithmetic = checkArithmetic(context, queue, arithmeticGroups);
        VOXTACT_TRY(arithmetic);
        verdict.trusted = verdict.trusted && arithmetic->wrong.empty();
        verdict.text += arithmetic->wrong.empty()
                            ? ", " + std::to_string(arithmetic->operations) + " operations as on the host"
                            : ", not as on the host: " + arithmetic->wrong;
    }
    return verdict;
}

} // namespace

Result<std::vector<SelfTestVerdict>> selfTest(const Context& context, const QueueAccess& queue,
                                              std::span<const CountingMethod> methods) {
    return selfTest(context, queue, methods, kArithmeticGroups);
}

Result<std::vector<SelfTestVerdict>> selfTest(const Context& context, const QueueAccess& queue,
                                              std::span<const CountingMethod> methods, std::uint32_t arithmeticGroups) {
    return guard([&]() -> Result<std::vector<SelfTestVerdict>> {
        const Result<SelfTestScene> scene = makeScene(context, queue);
        VOXTACT_TRY(scene);
        std::vector<SelfTestVerdict> verdicts;
        for (const MethodSupport& support : context.methods()) {
            if (!methods.empty() && std::ranges::find(methods, support.method) == methods.end()) {
                continue;
            }
            if (!support.available) {
                verdicts.push_back({support.method, false, false, support.reason});
                continue;
            }
            Result<SelfTestVerdict> verdict = judge(context, queue, *scene, support.method, arithmeticGroups);
            if (!verdict.ok() && verdict.error().code == ErrorCode::DeviceLost) {
                return verdict.error();
            }
            verdicts.push_back(verdict.ok() ? std::move(*verdict)
                                            : SelfTestVerdict{support.method, true, false, verdict.error().text});
        }
        return verdicts;
    });
}

} // namespace voxtact
