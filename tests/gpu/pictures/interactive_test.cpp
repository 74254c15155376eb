// SPDX-License-Identifier: MIT
// A viewer whose user drags the transfer function about: every frame brings a new one, to pictures and counts alike,
// while the frames before it are still on the device.
#include "own_image.h"
#include "render_fixture.h"
#include "support/host_meters.h"
#include "support/scenes.h"
#include "voxtact/cpu.h"
#include "voxtact/samples.h"

#include <algorithm>
#include <array>
#include <deque>
#include <iostream>
#include <optional>
#include <set>
#include <string>

namespace voxtact::test {
namespace {

constexpr VkExtent2D kFrameExtent{56, 48};
constexpr std::uint64_t kChanges = 100;
constexpr std::uint32_t kInFlight = 3;
constexpr double kThreshold = 0.25;
constexpr std::uint32_t kTableSize = 200;

/// The ways to count, as far as they read the table in ways of their own.
constexpr AnyDesc kWays[] = {
    {.method = CountingMethod::Query},
    {.method = CountingMethod::Atomic},
    {.method = CountingMethod::Compute, .filter = Filter::Exact},
    {.method = CountingMethod::Compute, .projection = Projection::Certified},
};
constexpr std::size_t kWayCount = std::size(kWays);
constexpr std::size_t kExact = 2;
constexpr std::size_t kCertified = 3;

enum class Kind : std::uint32_t { Curve, Peak, Steps, Opaque, Faint, Clear };

/// What the user has dragged the function to.
struct Change {
    Kind kind = Kind::Curve;
    std::vector<ControlPoint> points;
    std::vector<ColourPoint> colours;
    ValueRange domain;
    double opacityUnit = 1;
    double step = 1;

    [[nodiscard]] TransferFunctionDesc opacity() const { return {points, domain, kTableSize}; }
    [[nodiscard]] RenderTransferFunctionDesc desc() const { return {opacity(), colours, opacityUnit, step}; }
};

std::vector<ControlPoint> randomPoints(Kind kind, std::mt19937_64& random) {
    const double at = uniform(random, 20, 200);
    switch (kind) {
    case Kind::Peak: {
        const double width = uniform(random, 0.5, 6);
        return {{at - width, 0}, {at, uniform(random, 0.5, 1)}, {at + width, 0}};
    }
    case Kind::Steps:
        return {{at, 0}, {at, 0.6}, {at + 30, 0.6}, {at + 30, 0.1}};
    case Kind::Opaque:
        return {{at, 1}};
    case Kind::Faint:
        return {{at, 0.05}, {at + 20, kThreshold - 0.05}};
    case Kind::Clear:
        return {{at, 0}};
    case Kind::Curve:
        break;
    }
    std::vector<ControlPoint> points;
    for (double value = uniform(random, 0, 60); value < 255; value += uniform(random, 5, 90)) {
        points.push_back({value, random() % 3 == 0 ? 0 : uniform(random, 0, 1)});
    }
    return points;
}

Change randomChange(Kind kind, std::mt19937_64& random) {
    Change out{.kind = kind, .points = randomPoints(kind, random), .colours = {}, .domain = {}};
    for (double value = 0; value < 255; value += uniform(random, 30, 200)) {
        out.colours.push_back({value, {uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)}});
    }
    out.domain.lo = uniform(random, -300, 60);
    out.domain.hi = uniform(random, 120, 600);
    out.opacityUnit = uniform(random, 5, 40);
    out.step = uniform(random, 2, 8);
    return out;
}

/// What the user saw of a change.
struct Frame {
    Change change;
    const std::uint8_t* pixels = nullptr;
    std::array<PairAnswer, kWayCount> answers{};
};

/// What one frame in flight has for itself.
struct Slot {
    Slot(const device::VulkanDevice& device, const Renderer& renderer)
        : image(device, kFrameExtent), targets(take(RenderTargets::create(renderer, kFrameExtent))) {}

    OwnImage image;
    RenderTargets targets;
    VkFence fence = VK_NULL_HANDLE;
};

class InteractiveTest : public PictureTest {
  protected:
    void SetUp() override {
        PictureTest::SetUp();
        if (IsSkipped() || HasFatalFailure()) {
            return;
        }
        for (const AnyDesc& way : kWays) {
            detectors_.push_back(detector(way));
            rings_.push_back(take(ResultRing::create(detectors_.back().detector(), kInFlight, {.maxPairs = 1})));
        }
        volume_.emplace(take(Volume::upload(context(), queue(), head_.view(), {.bricks = true})));
        mesh_.emplace(take(Mesh::upload(context(), queue(), ellipsoid_.view(), {.clusters = true})));
        bricks_.emplace(take(RenderBricks::create(renderer(), *volume_)));
        scene_.volume = &*volume_;
        scene_.bricks = &*bricks_;
        scene_.mesh = &*mesh_;
        scene_.clip_from_world = framingCamera(head_.grid, kFrameExtent.width, kFrameExtent.height);
        scene_.background = {0.1, 0.3, 0.2};
    }
    void TearDown() override {
        slots_.clear();
        bricks_.reset();
        mesh_.reset();
        volume_.reset();
        rings_.clear();
        detectors_.clear();
        PictureTest::TearDown();
    }

    [[nodiscard]] BatchItem itemOf(const TransferFunction& function) const {
        return {&*mesh_, &*volume_, &function, {&scene_.world_from_object, 1}};
    }
    [[nodiscard]] View view() const { return {scene_.clip_from_world, kFrameExtent.width, kFrameExtent.height}; }

    /// Puts the mesh somewhere in the head.
    void placeMesh(std::mt19937_64& random) { scene_.world_from_object = randomPoses(head_.grid, 1, 0.3, random)[0]; }
    void makeSlots() {
        for (std::uint32_t i = 0; i < kInFlight; ++i) {
            slots_.emplace_back(gpu().device, renderer());
        }
    }

    /// One command buffer: the change, the picture, the counts. Submits it and does not wait.
    void show(std::uint64_t number, Frame& frame, TransferFunction& counted, RenderTransferFunction& seen) {
        Slot& slot = slots_[number % kInFlight];
        const VkCommandBuffer commands = slot.image.raw.begin(VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT);
        take(counted.cmdUpdate(commands, frame.change.opacity()));
        take(seen.cmdUpdate(commands, frame.change.desc()));
        scene_.transferFunction = &seen;
        take(renderer().cmdRender(commands, scene_, slot.image.target(slot.targets)));
        frame.pixels = slot.image.cmdCopy(commands);
        const BatchItem item = itemOf(counted);
        for (std::size_t way = 0; way < kWayCount; ++way) {
            Results* results = take(rings_[way].begin(number));
            take(detectors_[way].detector().cmdDetect(commands, {{&item, 1}, view(), kThreshold}, *results));
            take(results->cmdReadBack(commands));
        }
        slot.fence = slot.image.raw.makeFence();
        slot.image.raw.submit(commands, slot.fence);
    }

    /// Waits for a frame and takes its counts out of the rings.
    void finish(std::uint64_t number, Frame& frame) {
        Slot& slot = slots_[number % kInFlight];
        slot.image.raw.wait(slot.fence);
        for (std::size_t way = 0; way < kWayCount; ++way) {
            frame.answers[way] = unpack(take(rings_[way].read(number))[0]);
        }
    }

    /// All changes, most of them while the ones before are on the device; now and then the user pauses.
    std::vector<Frame> drag(std::vector<Frame> frames, std::mt19937_64& random) {
        makeSlots();
        TransferFunction counted =
            take(TransferFunction::upload(context(), queue(), {byteRamp(), {0, 255}, kTableSize}));
        RenderTransferFunction seen =
            take(RenderTransferFunction::upload(renderer(), queue(), frames.front().change.desc()));
        std::deque<std::uint64_t> inFlight;
        const auto leave = [&](std::size_t most) {
            for (; inFlight.size() > most; inFlight.pop_front()) {
                finish(inFlight.front(), frames[inFlight.front()]);
            }
        };
        for (std::uint64_t number = 0; number < frames.size(); ++number) {
            leave(random() % 8 == 0 ? 0 : kInFlight - 1);
            show(number, frames[number], counted, seen);
            inFlight.push_back(number);
        }
        leave(0);
        return frames;
    }

    void expectFresh(const Frame& frame) {
        const RenderTransferFunction seen =
            take(RenderTransferFunction::upload(renderer(), queue(), frame.change.desc()));
        scene_.transferFunction = &seen;
        EXPECT_TRUE(pixelsOf(frame) == take(blocking().render(scene_, kFrameExtent)).rgba) << "the picture";
        const TransferFunction counted = take(TransferFunction::upload(context(), queue(), frame.change.opacity()));
        const BatchItem item = itemOf(counted);
        for (std::size_t way = 0; way < kWayCount; ++way) {
            expectSame(frame.answers[way], take(detectors_[way].detect({{&item, 1}, view(), kThreshold})).pairs.front(),
                       "fresh", way);
        }
    }

    void expectHost(const Frame& frame) {
        const cpu::TransferFunction counted = take(cpu::TransferFunction::create(frame.change.opacity()));
        const cpu::BatchItem item{&hostMesh_, &hostVolume_, &counted, {&scene_.world_from_object, 1}};
        const cpu::Batch batch{{&item, 1}, view(), kThreshold};
        expectSame(frame.answers[kExact], take(hostExact_.detect(batch)).pairs.front(), "host", kExact);
        expectSame(frame.answers[kCertified], take(hostCertified_.detect(batch)).pairs.front(), "host", kCertified);
    }

    /// Without anything opaque nothing touches; without opacity the volume is not to be seen either.
    void expectNothing(const Frame& frame, const std::vector<std::uint8_t>& meshAlone) {
        for (std::size_t way = 0; way < kWayCount; ++way) {
            EXPECT_EQ(frame.answers[way].count, 0U) << way;
            EXPECT_FALSE(frame.answers[way].hit || frame.answers[way].possible) << way;
        }
        EXPECT_EQ(pixelsOf(frame) == meshAlone, frame.change.kind == Kind::Clear) << "the picture";
    }

    /// The mesh before the background, with the volume out of sight.
    std::vector<std::uint8_t> meshAlone() {
        const Volume elsewhere = upload(moved(head_, translation({1e5, 0, 0})));
        const RenderTransferFunction function =
            take(RenderTransferFunction::upload(renderer(), queue(), {{byteRamp(), {0, 255}}, {}, 1, 5}));
        Scene scene = scene_;
        scene.volume = &elsewhere;
        scene.bricks = nullptr;
        scene.transferFunction = &function;
        return take(blocking().render(scene, kFrameExtent)).rgba;
    }

    static void expectSame(const PairAnswer& frame, const PairAnswer& other, const char* what, std::size_t way) {
        EXPECT_EQ(frame.count, other.count) << what << ", way " << way;
        EXPECT_EQ(frame.hit, other.hit) << what << ", way " << way;
        EXPECT_EQ(frame.possible, other.possible) << what << ", way " << way;
    }
    static std::vector<std::uint8_t> pixelsOf(const Frame& frame) {
        return {frame.pixels, frame.pixels + std::size_t{4} * kFrameExtent.width * kFrameExtent.height};
    }

  private:
    VolumeData head_ = take(makeBuiltinVolume("head:32"));
    MeshData ellipsoid_ = take(makeEllipsoid(500));
    cpu::Volume hostVolume_ = take(cpu::Volume::create(head_.view()));
    cpu::Mesh hostMesh_ = take(cpu::Mesh::create(ellipsoid_.view()));
    cpu::Detector hostExact_ = take(cpu::Detector::create());
    cpu::Detector hostCertified_ = take(cpu::Detector::create({.projection = Projection::Certified}));
    std::vector<BlockingDetector> detectors_;
    std::vector<ResultRing> rings_;
    std::optional<Volume> volume_;
    std::optional<Mesh> mesh_;
    std::optional<RenderBricks> bricks_;
    std::deque<Slot> slots_;
    Scene scene_;
};

TEST_F(InteractiveTest, AHundredChanges) {
    std::mt19937_64 random(testSeed());
    constexpr Kind kKinds[] = {Kind::Curve, Kind::Peak,  Kind::Steps, Kind::Clear, Kind::Opaque,
                               Kind::Curve, Kind::Faint, Kind::Curve, Kind::Peak,  Kind::Steps};
    placeMesh(random);
    std::vector<Frame> planned(kChanges);
    for (std::uint64_t i = 0; i < kChanges; ++i) {
        planned[i].change = randomChange(kKinds[i % std::size(kKinds)], random);
    }
    const std::vector<Frame> frames = drag(std::move(planned), random);
    const std::vector<std::uint8_t> alone = meshAlone();
    std::set<std::string> pictures;
    std::set<std::uint64_t> counts;
    for (std::size_t i = 0; i < frames.size() && !HasFailure(); ++i) {
        SCOPED_TRACE("change " + std::to_string(i));
        expectFresh(frames[i]);
        expectHost(frames[i]);
        if (frames[i].change.kind == Kind::Clear || frames[i].change.kind == Kind::Faint) {
            expectNothing(frames[i], alone);
        }
        const std::vector<std::uint8_t> pixels = pixelsOf(frames[i]);
        pictures.emplace(pixels.begin(), pixels.end());
        counts.insert(frames[i].answers[kExact].count);
    }
    // A frame that showed another's table would be seen.
    std::cout << "  " << pictures.size() << " pictures, " << counts.size() << " counts\n";
    EXPECT_GT(pictures.size(), kChanges / 2);
    EXPECT_GT(counts.size(), kChanges / 10);
}

} // namespace
} // namespace voxtact::test
