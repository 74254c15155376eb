// SPDX-License-Identifier: MIT
// The pairs that a search lists between its steps (shaders/open_pairs.h): all that are open, and no others.
#include "certified/along.h"
#include "certified/counted_fixture.h"
#include "certified/head_scene.h"
#include "detect/certified/open_pairs.h"
#include "open_pairs.h"

#include <cstring>

namespace voxtact::test {
namespace {

DetectorDesc searchingFor(const ClearanceSearch& search) {
    return {.method = CountingMethod::Compute,
            .projection = Projection::Conservative,
            .stopAtFirst = true,
            .clearance = search};
}

class OpenPairsTest : public CertifiedTest {
  protected:
    /// The words of both sets as a batch of one item leaves them.
    std::vector<std::uint32_t> setsAfter(const DetectorDesc& desc, const Batch& batch, std::uint32_t room) {
        const BatchItem& item = batch.items[0];
        const auto pairs = static_cast<std::uint32_t>(item.pairs());
        Results results = take(Results::create(context(), {.maxPairs = pairs,
                                                           .clustersAtOnce = room,
                                                           .clearances = desc.clearance.has_value(),
                                                           .motions = desc.motion.has_value()}));
        const Detector device = take(Detector::create(context(), desc));
        const VkCommandBuffer commands = raw().begin();
        take(device.cmdDetect(commands, batch, results));
        take(results.cmdReadBack(commands));
        raw().submitAndWait(commands);
        const RoundCut any{{.pairs = 1, .clusters = 1}, {.clusters = 1, .pairs = 1}};
        const shader::OpenPairs open = OpenPairs(results.impl(), item).listing(0, nullptr, any);
        const std::vector<std::byte> bytes =
            raw().readBuffer(results.impl().transforms.get(), VkDeviceSize{open.list} * sizeof(std::uint32_t));
        std::vector<std::uint32_t> words(VOXTACT_OPEN_SETS_WORDS(pairs));
        std::memcpy(words.data(), bytes.data() + open.set * sizeof(std::uint32_t),
                    words.size() * sizeof(std::uint32_t));
        return words;
    }
    static void expectEmpty(const std::vector<std::uint32_t>& sets, std::size_t pairs, bool touches) {
        const std::size_t words = sets.size() / 2;
        bool listed = false;
        bool touched = false;
        for (std::size_t set = 0; set < sets.size(); set += words) {
            EXPECT_EQ(sets[set], 0U) << "pairs are listed";
            for (std::size_t slot = 0; slot < pairs; ++slot) {
                const std::size_t touch = set + VOXTACT_OPEN_TOUCH(slot);
                const std::size_t look = set + VOXTACT_OPEN_LOOK(pairs, slot);
                EXPECT_EQ(sets[touch + 1], 0U) << "a round of the touch has pairs";
                EXPECT_EQ(sets[look + 1], 0U) << "a round has pairs";
                listed = listed || sets[look] != 0;
                touched = touched || sets[touch] != 0;
            }
        }
        EXPECT_TRUE(listed) << "nothing was ever listed";
        EXPECT_EQ(touched, touches);
    }
};

/// A search has many steps more than most segments take: those have no work groups.
TEST_F(OpenPairsTest, NoneIsListedOfAMotionThatIsDone) {
    constexpr std::size_t kPoses = 9;
    Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, testSeed());
    for (std::size_t i = 0; i < kPoses; ++i) { // one goes by far outside, the others stay there
        scene.poses[i] = translation({i == 4 ? 30.0 : 0.0, 0, 400});
    }
    for (const std::uint32_t room : {16U, 48U, 2048U}) {
        expectEmpty(setsAfter(along(), scene.batch(), room), kPoses, true);
    }
}

TEST_F(OpenPairsTest, NoneIsListedOfAClearanceThatIsKnown) {
    constexpr std::size_t kPoses = 9;
    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, testSeed(), true, 2);
    for (const std::uint32_t room : {16U, 160U, 2048U}) {
        expectEmpty(setsAfter(searchingFor({}), scene.batch(), room), kPoses, false);
    }
}

/// However many go into one round, and behind other items, a pair is as near as it is.
TEST_F(OpenPairsTest, AllThatAreOpenAreMeasured) {
    const std::uint64_t seed = testSeed();
    constexpr std::size_t kPoses = 7;
    constexpr std::size_t kItems = 3;
    const Head scene(context(), queue(), take(makeBuiltinMesh("scalpel:300")), kPoses, seed, true, 2);
    const ClearanceSearch search{.tolerance = 0.1 * scene.head.grid.spacing[0]};
    const Detector device = take(Detector::create(context(), searchingFor(search)));
    const std::vector<BatchItem> items(kItems, scene.item);
    std::vector<PairClearance> first;
    for (const std::uint32_t room : {16U, 160U, 16384U}) { // a part of a pair, two pairs, all of them
        const std::vector<PairClearance> found =
            detect(device, {items, {}, kDefaultThreshold}, kItems * kPoses, room).clearances;
        ASSERT_EQ(found.size(), kItems * kPoses);
        if (first.empty()) {
            first = found;
        }
        for (std::size_t i = 0; i < found.size(); ++i) {
            const ClearanceBounds& bounds = found[i].bounds;
            const ClearanceBounds& other = first[i % kPoses].bounds;
            EXPECT_LE(bounds.lo, other.hi) << "pair " << i << ", room " << room << ", seed " << seed;
            EXPECT_LE(other.lo, bounds.hi) << "pair " << i << ", room " << room << ", seed " << seed;
            EXPECT_TRUE(room == 16 || found[i].end == ClearanceEnd::Closed) // or it may be too much for so little room
                << "pair " << i << ", room " << room << ", seed " << seed;
        }
    }
}

} // namespace
} // namespace voxtact::test
