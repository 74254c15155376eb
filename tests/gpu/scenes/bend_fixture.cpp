// SPDX-License-Identifier: MIT
#include "bend_fixture.h"

#include "core/geometry/clusters.h"
#include "core/method/method_table.h"
#include "cpu/scenes/random_scene.h"
#include "device/scene/mesh_layout.h"
#include "support/scenes.h"
#include "vulkan/barriers.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace voxtact::test {

namespace {

constexpr std::uint32_t kMostPairs = 2;
constexpr std::uint32_t kContacts = 1U << 14U;
constexpr Outputs kAll{.triangles = true, .contacts = true, .bounds = true, .labels = true};

/// Whether it depends on which fragments lanes have together how many are counted: one that is divided as far as any
/// may be can use up the rounds of loops that llvmpipe lets all of them have (docs/facts.md). That pair is undecided
/// then.
bool mayBeCut(const PassDesc& desc, const BatchAnswer& answer) {
    return desc.projection == Projection::Certified && !desc.stopAtFirst &&
           std::ranges::any_of(answer.pairs,
                               [](const PairAnswer& pair) { return pair.exactness == Exactness::LowerBound; });
}

std::vector<bool> hitsOf(const BatchAnswer& answer) {
    std::vector<bool> hits;
    for (const PairAnswer& pair : answer.pairs) {
        hits.push_back(pair.hit);
    }
    return hits;
}

std::vector<std::byte> spread(std::span<const double> positions, const Spacing& spacing) {
    const std::size_t vertices = positions.size() / 3;
    std::vector<float> out((spacing.offset + spacing.stride * (vertices - 1)) / sizeof(float) + 3,
                           std::numeric_limits<float>::quiet_NaN());
    for (std::size_t at = 0; at < positions.size(); ++at) {
        out[(spacing.offset + spacing.stride * (at / 3)) / sizeof(float) + at % 3] = static_cast<float>(positions[at]);
    }
    const auto bytes = std::as_bytes(std::span(out));
    return {bytes.begin(), bytes.end()};
}

} // namespace

Spacing randomSpacing(std::mt19937_64& random) {
    constexpr std::uint32_t kStrides[] = {12, 12, 16, 20, 44};
    constexpr std::uint32_t kOffsets[] = {0, 0, 4, 52};
    return {kStrides[below(random, std::size(kStrides))], kOffsets[below(random, std::size(kOffsets))]};
}

void BendFixture::SetUp() {
    RawGpuTest::SetUp();
    if (IsSkipped() || HasFatalFailure()) {
        return;
    }
    // One image: a kind more is a second for each shader on lavapipe, and what is asked here is about meshes.
    Grid grid;
    grid.size = {18, 13, 15};
    grid.spacing = {1, 1.5, 0.8};
    std::mt19937 noise(5);
    image_ = makeBytes(grid, [&](std::uint32_t x, auto, std::uint32_t z) {
        const double smooth = 128 + 100 * std::sin(0.4 * x) * std::cos(0.3 * z);
        return std::clamp(std::floor(smooth + static_cast<double>(noise() % 60) - 30), 0.0, 255.0);
    });
    volume_.emplace(take(Volume::upload(context(), queue(), image_.view(), {.bricks = true})));
    constexpr ControlPoint kPoints[] = {{120, 0}, {220, 1}};
    function_.emplace(upload(kPoints, {0, 255}));
    labels_.emplace(take(LabelMap::upload(context(), queue(), {unitGrid(2), {0, 1, 2, 1, 0, 2, 0, 1}, {0, 3, 9}})));
    view_ = {framingCamera(grid, 48, 40), 48, 40};
}

void BendFixture::TearDown() {
    labels_.reset();
    function_.reset();
    volume_.reset();
    RawGpuTest::TearDown();
}

std::vector<BendFixture::Way> BendFixture::allWays() const {
    std::vector<AnyDesc> descs;
    for (const MethodSupport& method : context().methods()) {
        if (!method.available) {
            continue;
        }
        for (const Projection projection :
             {Projection::View, Projection::TwoView, Projection::DominantAxis, Projection::Certified}) {
            if (answers(method.method, projection)) {
                descs.push_back(
                    {.method = method.method, .projection = projection, .filter = defaultFilter(method.method)});
                descs.back().outputs = kAll;
            }
        }
    }
    descs.push_back({.method = CountingMethod::Compute, .projection = Projection::Certified, .stopAtFirst = true});
    std::vector<Way> ways;
    for (const AnyDesc& desc : descs) {
        ways.push_back({take(Detector::create(context(), desc)), {}});
    }
    return ways;
}

void BendFixture::detect(VkCommandBuffer commands, std::vector<Way>& ways, const Mesh& mesh, std::size_t which) const {
    const BatchItem asked = item(mesh);
    const auto pairs = static_cast<std::uint32_t>(poses_.size());
    for (Way& way : ways) {
        while (way.results.size() <= which) {
            way.results.push_back(take(
                Results::create(way.detector, {.maxPairs = kMostPairs,
                                               .room = {.triangles = 20000, .labels = 12, .contacts = kContacts}})));
        }
        ASSERT_LE(pairs, kMostPairs);
        take(way.detector.cmdDetect(commands, {{&asked, 1}, view_, 0.5}, way.results[which]));
        take(way.results[which].cmdReadBack(commands));
    }
}

BatchAnswer BendFixture::answerOf(Way& way, std::size_t which) {
    BatchAnswer answer;
    take(way.results[which].readOutputs(answer));
    for (const PairResult& pair : take(way.results[which].read())) {
        answer.pairs.push_back(unpack(pair));
    }
    if (answer.contactsFound > kContacts) {
        answer.contacts.clear(); // which of them there was room for is arbitrary
    }
    return answer;
}

void BendFixture::expectFresh(std::vector<Way>& ways, const MeshData& shape, std::size_t which, bool clusters) {
    const Mesh fresh = take(Mesh::upload(context(), queue(), shape.view(), {.clusters = clusters}));
    const VkCommandBuffer commands = raw().begin();
    detect(commands, ways, fresh, 0);
    raw().submitAndWait(commands);
    for (Way& way : ways) {
        const BatchAnswer expected = answerOf(way, 0);
        const BatchAnswer found = answerOf(way, which);
        const PassDesc& desc = way.detector.impl().desc;
        if (mayBeCut(desc, expected) || mayBeCut(desc, found)) {
            ASSERT_EQ(hitsOf(found), hitsOf(expected));
            ++cut_;
        } else {
            ASSERT_EQ(everythingOf(found), everythingOf(expected))
                << toString(desc.projection) << " by " << toString(desc.method);
            ++whole_;
        }
        for (const PairAnswer& pair : expected.pairs) {
            hits_ += pair.hit ? 1U : 0U;
        }
    }
}

VkBuffer BendFixture::written(VkCommandBuffer commands, std::span<const double> positions, const Spacing& spacing,
                              VkBufferUsageFlags usage) {
    const RawVulkan::HostBuffer out =
        raw().makeBuffer(spread(positions, spacing).size(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    write(commands, out.buffer, positions, spacing);
    return out.buffer;
}

void BendFixture::write(VkCommandBuffer commands, VkBuffer buffer, std::span<const double> positions,
                        const Spacing& spacing) {
    const std::vector<std::byte> bytes = spread(positions, spacing);
    const VkBuffer source =
        raw().makeBuffer(std::span<const std::byte>(bytes), VK_BUFFER_USAGE_TRANSFER_SRC_BIT).buffer;
    barrier(context().impl(), commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, VK_ACCESS_2_MEMORY_WRITE_BIT,
            VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT);
    const VkBufferCopy all{0, 0, bytes.size()};
    raw().vk().vkCmdCopyBuffer(commands, source, buffer, 1, &all);
}

std::vector<std::uint32_t> BendFixture::wordsOf(const Buffer& buffer) {
    const std::vector<std::byte> bytes = raw().readBuffer(buffer.get(), buffer.size);
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes.data(), bytes.size());
    return words;
}

void BendFixture::expectBoxes(const Mesh& mesh, const MeshData& shape) {
    const std::vector<std::uint32_t> words = wordsOf(mesh.impl().buffer);
    const std::size_t first = mesh.impl().clusterWord.value();
    const std::size_t triangles = shape.indices.size() / 3;
    const std::vector<float> floats = floatsOf(shape.positions);
    MeshClusters clusters;
    clusters.triangles.assign(words.end() - static_cast<std::ptrdiff_t>(triangles), words.end());
    const std::vector<RunBox> runs = runBoxes({floats, shape.indices}, clusters);
    const std::size_t count = (triangles + kClusterTriangles - 1) / kClusterTriangles;
    ASSERT_EQ(words.size() - first, 6 * (count + runs.size()) + triangles);
    const auto expectBox = [&](std::size_t number, const RunBox& box) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(std::bit_cast<float>(words[first + 6 * number + axis]), box.lo[axis]) << number;
            EXPECT_EQ(std::bit_cast<float>(words[first + 6 * number + 3 + axis]), box.hi[axis]) << number;
        }
    };
    for (std::size_t run = 0; run < runs.size(); ++run) {
        expectBox(count + run, runs[run]);
    }
    constexpr std::size_t kRuns = kClusterTriangles / kRunTriangles;
    for (std::size_t cluster = 0; cluster < count; ++cluster) {
        RunBox box = runs[kRuns * cluster];
        for (std::size_t run = kRuns * cluster; run < std::min(kRuns * (cluster + 1), runs.size()); ++run) {
            grow(box, runs[run]);
        }
        expectBox(cluster, box);
    }
}

} // namespace voxtact::test
