// SPDX-License-Identifier: MIT
// What the search for clearances knows of cells: the bits of the bricks that it came near, against a recount of the
// host.
#include "certified/counted_fixture.h"
#include "detect/certified/certified_queues.h"
#include "few_kinds.h"

#include <algorithm>
#include <cmath>
#include <iostream>

namespace voxtact::test {
namespace {

/// Opaque from `first` to `last`, whole numbers, and half a value farther.
struct Band {
    int first;
    int last;
};

/// Bands that do not touch: no whole value is near where opacity crosses the threshold of a half.
std::vector<Band> randomBands(std::mt19937_64& random) {
    std::vector<Band> bands;
    for (int at = 1 + static_cast<int>(random() % 60); at < 240;) {
        const int last = at + static_cast<int>(random() % 25);
        bands.push_back({at, last});
        at = last + 3 + static_cast<int>(random() % 90);
    }
    return bands;
}

std::vector<ControlPoint> pointsOf(const std::vector<Band>& bands) {
    std::vector<ControlPoint> points{{0, 0}};
    for (const Band& band : bands) {
        points.push_back({band.first - 1.0, 0});
        points.push_back({static_cast<double>(band.first), 1});
        points.push_back({static_cast<double>(band.last), 1});
        points.push_back({band.last + 1.0, 0});
    }
    return points;
}

/// A volume as the host recounts it.
struct Voxels {
    VolumeData data;

    [[nodiscard]] double at(int x, int y, int z) const {
        const auto clamped = [&](int voxel, std::size_t axis) {
            return static_cast<std::size_t>(std::clamp(voxel, 0, static_cast<int>(data.grid.size[axis]) - 1));
        };
        const std::size_t number =
            clamped(x, 0) + data.grid.size[0] * (clamped(y, 1) + data.grid.size[1] * clamped(z, 2));
        if (data.type == ScalarType::UInt8) {
            return static_cast<double>(data.voxels[number]);
        }
        float value = 0;
        std::memcpy(&value, data.voxels.data() + number * sizeof value, sizeof value);
        return static_cast<double>(value);
    }
    void set(const VoxelBox& box, double value) {
        for (std::uint32_t z = box.first[2]; z < box.first[2] + box.size[2]; ++z) {
            for (std::uint32_t y = box.first[1]; y < box.first[1] + box.size[1]; ++y) {
                for (std::uint32_t x = box.first[0]; x < box.first[0] + box.size[0]; ++x) {
                    const std::size_t number = x + data.grid.size[0] * (y + std::size_t{data.grid.size[1]} * z);
                    if (data.type == ScalarType::UInt8) {
                        data.voxels[number] = static_cast<std::byte>(value);
                    } else {
                        const auto stored = static_cast<float>(value);
                        std::memcpy(data.voxels.data() + number * sizeof stored, &stored, sizeof stored);
                    }
                }
            }
        }
    }
    /// A cell's interpolant takes all values between its corners.
    [[nodiscard]] bool hasOpaque(int x, int y, int z, const std::vector<Band>& bands) const {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const int last = static_cast<int>(data.grid.size[axis]) - 1;
            if ((axis == 0 ? x : axis == 1 ? y : z) > last) {
                return false;
            }
        }
        double lo = HUGE_VAL;
        double hi = -HUGE_VAL;
        for (int corner = 0; corner < 8; ++corner) {
            const double value = at(x + (corner & 1), y + (corner >> 1 & 1), z + (corner >> 2));
            lo = std::min(lo, value);
            hi = std::max(hi, value);
        }
        return std::ranges::any_of(bands, [&](const Band& band) { return hi >= band.first && lo <= band.last; });
    }
};

/// All zero.
Voxels zeroVoxels(std::mt19937_64& random, ScalarType type) {
    // 24 ends with a brick.
    const auto side = [&] { return random() % 4 == 0 ? 24 : usualSide(random, 4, 31); };
    Voxels out;
    out.data.grid = unitGrid(side(), side(), side());
    out.data.type = type;
    out.data.voxels.resize(voxelCount(out.data.grid) * bytesPerVoxel(type));
    out.set({{}, out.data.grid.size}, 0);
    return out;
}

class ClearanceBitsTest : public CertifiedTest {
  protected:
    VoxelBox randomBox(const Grid& grid) {
        VoxelBox box{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.first[axis] = static_cast<std::uint32_t>(random_() % grid.size[axis]);
            box.size[axis] =
                1 + static_cast<std::uint32_t>(random_() % std::min(grid.size[axis] - box.first[axis], 5U));
        }
        return box;
    }
    /// Of all slots in use, each bit. Returns how many slots there are.
    std::size_t expectBits(const Results& results, const Voxels& voxels, const std::vector<Band>& bands) {
        const ResultsImpl& impl = results.impl();
        const std::vector<std::byte> bytes = raw().readBuffer(impl.transforms.get(), clearancesByte(impl));
        std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
        std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
        const std::uint32_t room = impl.queueRoom;
        const std::span<const std::uint32_t> queues = std::span(words).subspan(firstQueueWord(impl));
        const int countX = static_cast<int>(voxels.data.grid.size[0] >> VOXTACT_BRICK_SHIFT) + 1;
        const int countY = static_cast<int>(voxels.data.grid.size[1] >> VOXTACT_BRICK_SHIFT) + 1;
        std::size_t slots = 0;
        for (std::uint32_t slot = 0; slot < VOXTACT_ROOM_BITS(room); ++slot) {
            const std::uint32_t key = queues[VOXTACT_WORD_BITS(room) + slot];
            if (key == 0) {
                continue;
            }
            ++slots;
            const int brick = static_cast<int>(key) - 1;
            const int corner[] = {brick % countX * 8 - 1, brick / countX % countY * 8 - 1,
                                  brick / countX / countY * 8 - 1};
            const auto bits = queues.subspan(VOXTACT_WORD_BITS_WORDS(room) + VOXTACT_BITS_WORDS * slot);
            for (std::size_t cell = 0; cell < 512 && !HasFailure(); ++cell) {
                const int place = static_cast<int>(cell);
                const bool expected = voxels.hasOpaque(corner[0] + (place & 7), corner[1] + (place >> 3 & 7),
                                                       corner[2] + (place >> 6), bands);
                EXPECT_EQ((bits[cell / 32] >> (cell % 32) & 1U) != 0, expected)
                    << "may, brick " << brick << ", " << cell;
                EXPECT_EQ((bits[16 + cell / 32] >> (cell % 32) & 1U) != 0, expected)
                    << "has, brick " << brick << ", " << cell;
            }
        }
        return slots;
    }

    std::uint64_t seed_ = testSeed();
    std::mt19937_64 random_{seed_};
};

/// Edits and new tables between searches: in a command buffer of their own, and in the one of the search before.
TEST_F(ClearanceBitsTest, AreThoseOfTheHostAfterEditsAndTables) {
    const Detector device = take(Detector::create(context(), {.method = CountingMethod::Compute,
                                                              .projection = Projection::Conservative,
                                                              .stopAtFirst = true,
                                                              .clearance = ClearanceSearch{}}));
    std::size_t slots = 0;
    for (int round = 0; round < 12 && !HasFailure(); ++round) {
        SCOPED_TRACE("seed " + std::to_string(seed_) + ", round " + std::to_string(round));
        const ScalarType type = round % 2 == 0 ? ScalarType::UInt8 : ScalarType::Float32;
        Voxels voxels = zeroVoxels(random_, type);
        std::vector<Band> bands = randomBands(random_);
        Volume volume =
            take(Volume::upload(context(), queue(), voxels.data.view(), {.bricks = true, .editable = true}));
        TransferFunction function = upload(pointsOf(bands), {0, 255});
        // Beside the volume, so that all of it is searched.
        const Mesh mesh = upload(makeFlat(0.1, 0.9, 0.1, 0.9, 1.6));
        const Mat4 pose = identity();
        const BatchItem item{&mesh, &volume, &function, {&pose, 1}};
        Results results = take(Results::create(context(), {.maxPairs = 1, .clearances = true}));
        for (int time = 0; time < 3 && !HasFailure(); ++time) {
            const VkCommandBuffer commands = raw().begin();
            if (time % 2 == 1) {
                take(device.cmdDetect(commands, {{&item, 1}, {}, 0.5}, results));
            }
            for (std::uint64_t edits = 1 + random_() % 6; edits > 0; --edits) {
                const VoxelBox box = randomBox(voxels.data.grid);
                const auto value = static_cast<double>(random_() % 256);
                take(volume.cmdSet(commands, box, value));
                voxels.set(box, value);
            }
            if (random_() % 2 == 0) {
                bands = randomBands(random_);
                take(function.cmdUpdate(commands, {pointsOf(bands), {0, 255}, kDefaultTableSize}));
            }
            take(device.cmdDetect(commands, {{&item, 1}, {}, 0.5}, results));
            raw().submitAndWait(commands);
            slots += expectBits(results, voxels, bands);
        }
    }
    std::cout << "  " << slots << " bricks\n";
    EXPECT_GT(slots, 30U);
}

} // namespace
} // namespace voxtact::test
