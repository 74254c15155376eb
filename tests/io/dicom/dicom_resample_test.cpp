// SPDX-License-Identifier: MIT
// DICOM slices that make no regular grid: refused with their numbers, or resampled. A linear field is its own judge:
// linear interpolation must not change it.
#include "dicom_writer.h"

#include <algorithm>
#include <cmath>

namespace voxtact::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

/// Where a slice is, from (-10, 20, 5): pixels of 0.5 mm across and 0.8 mm down, and mm up.
struct Place {
    double across = 0;
    double down = 0;
    double up = 0;
};

constexpr int kWide = 12;
constexpr int kHigh = 9;

/// Whole at all pixels of the places in these tests.
double field(double across, double down, double up) {
    return 4 * across + 5 * down + 2 * up - 30;
}

DicomSet sliceAt(const Place& place, const std::vector<std::uint16_t>& words) {
    DicomSet set = ctSlice(0);
    set.text(0x00200032, "DS",
             std::to_string(-10 + 0.5 * place.across) + "\\" + std::to_string(20 + 0.8 * place.down) + "\\" +
                 std::to_string(5 + place.up));
    set.number(0x00280010, kHigh).number(0x00280011, kWide).words(0x7FE00010, words);
    return set;
}

void writeField(const TemporaryFolder& folder, const std::vector<Place>& places) {
    for (std::size_t i = 0; i < places.size(); ++i) {
        std::vector<std::uint16_t> words;
        for (int row = 0; row < kHigh; ++row) {
            for (int column = 0; column < kWide; ++column) {
                const double value = field(column + places[i].across, row + places[i].down, places[i].up);
                EXPECT_EQ(value, std::round(value));
                words.push_back(static_cast<std::uint16_t>(static_cast<std::int16_t>(std::lround(value))));
            }
        }
        folder.write("s" + std::to_string(i), sliceAt(places[i], words).file());
    }
}

/// Whether a slice has a pixel there.
bool has(const Place& place, double across, double down) {
    constexpr double kRounding = 1e-6;
    return across >= place.across - kRounding && across <= place.across + kWide - 1 + kRounding &&
           down >= place.down - kRounding && down <= place.down + kHigh - 1 + kRounding;
}

/// Whether both slices around a point have it, or the one that it is on.
bool isCovered(const std::vector<Place>& places, double across, double down, double up) {
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (std::abs(places[i].up - up) < 1e-6) {
            return has(places[i], across, down);
        }
        if (i + 1 < places.size() && places[i].up < up && up < places[i + 1].up - 1e-6) {
            return has(places[i], across, down) && has(places[i + 1], across, down);
        }
    }
    return false;
}

std::vector<float> floatsOf(const VolumeData& volume) {
    EXPECT_EQ(volume.type, ScalarType::Float32);
    std::vector<float> voxels(volume.voxels.size() / sizeof(float));
    std::memcpy(voxels.data(), volume.voxels.data(), volume.voxels.size());
    return voxels;
}

/// The field at every voxel that the slices cover, and the least value of all at the others.
void expectField(const VolumeData& volume, const std::vector<Place>& places) {
    double least = 1e9;
    for (const Place& place : places) {
        least = std::min(least, field(place.across, place.down, place.up));
    }
    const std::vector<float> voxels = floatsOf(volume);
    const Mat4 world_from_index = worldFromIndex(volume.grid);
    const auto& size = volume.grid.size;
    ASSERT_EQ(voxels.size(), voxelCount(volume.grid));
    std::size_t covered = 0;
    for (std::size_t i = 0; i < voxels.size(); ++i) {
        const Vec3 world = transformPoint(world_from_index,
                                          {static_cast<double>(i % size[0]), static_cast<double>(i / size[0] % size[1]),
                                           static_cast<double>(i / size[0] / size[1])});
        const Place at{(world[0] + 10) / 0.5, (world[1] - 20) / 0.8, world[2] - 5};
        const bool is = isCovered(places, at.across, at.down, at.up);
        ASSERT_NEAR(voxels[i], is ? field(at.across, at.down, at.up) : least, 1e-4) << i;
        covered += is ? 1 : 0;
    }
    EXPECT_GE(covered, voxels.size() / 2);
}

VolumeData resampled(const TemporaryFolder& folder) {
    Result<VolumeData> volume = io::readVolume(folder.path(), {.resample = true});
    EXPECT_TRUE(isOk(volume));
    return volume.ok() ? std::move(*volume) : VolumeData{};
}

TEST(DicomResample, UnevenGaps) {
    for (const std::vector<double>& heights :
         {std::vector<double>{0, 2.5, 5, 10, 12.5}, std::vector<double>{0, 1.5, 4, 5, 9, 9.5}}) {
        const TemporaryFolder folder;
        std::vector<Place> places;
        for (const double height : heights) {
            places.push_back({0, 0, height});
        }
        writeField(folder, places);
        expectRefused(io::readVolume(folder.path()), "(to the program: --resample)", folder.path());
        const VolumeData volume = resampled(folder);
        EXPECT_EQ(volume.grid.size[0] * 100 + volume.grid.size[1], kWide * 100 + kHigh);
        EXPECT_EQ(volume.grid.origin, (Vec3{-10, 20, 5}));
        EXPECT_TRUE(io::wasResampled(volume));
        expectField(volume, places);
    }
}

/// Shifts of parts of a pixel along both axes, to both sides.
TEST(DicomResample, TiltedGantry) {
    for (const double side : {1.0, -1.0}) {
        const TemporaryFolder folder;
        std::vector<Place> places;
        for (int i = 0; i < 8; ++i) {
            places.push_back({side * 0.25 * i, 0.4 * i, 2.5 * i});
        }
        writeField(folder, places);
        expectRefused(io::readVolume(folder.path()), "its slices are sheared by", folder.path());
        const VolumeData volume = resampled(folder);
        EXPECT_EQ(volume.grid.size, (std::array<std::uint32_t, 3>{kWide + 2, kHigh + 3, 8}));
        EXPECT_EQ(volume.grid.origin, (Vec3{side > 0 ? -10.0 : -11.0, 20, 5}));
        EXPECT_THAT(volume.notes, Contains(HasSubstr(" degrees becomes 0; ")));
        expectField(volume, places);
    }
}

TEST(DicomResample, TiltedAndUneven) {
    const TemporaryFolder folder;
    const std::vector<Place> places{{0, 0, 0}, {0, 0.2, 0.5}, {0, 1, 2.5}, {0, 1.2, 3}, {0, 1.8, 4.5}};
    writeField(folder, places);
    const VolumeData volume = resampled(folder);
    EXPECT_EQ(volume.grid.spacing, (Vec3{0.5, 0.8, 0.5}));
    expectField(volume, places);
}

/// A ball with an edge of two voxels: a slice that is missing becomes the mean of its neighbours, and no other voxel
/// changes.
TEST(DicomResample, AMissingSlice) {
    const TemporaryFolder folder;
    const TemporaryFolder whole;
    constexpr int kSlices = 15;
    constexpr int kMissing = 6;
    for (int i = 0; i < kSlices; ++i) {
        std::vector<std::uint16_t> words;
        for (int row = 0; row < kHigh; ++row) {
            for (int column = 0; column < kWide; ++column) {
                const double away = std::hypot(0.5 * (column - 5), 0.8 * (row - 4), 0.6 * (i - 7));
                const double inside = std::clamp((3.5 - away) / 2, 0.0, 1.0);
                words.push_back(static_cast<std::uint16_t>(static_cast<std::int16_t>(-1000 + 1400 * inside)));
            }
        }
        const std::string file = sliceAt({0, 0, 0.6 * i}, words).file();
        whole.write("s" + std::to_string(i), file);
        if (i != kMissing) {
            folder.write("s" + std::to_string(i), file);
        }
    }
    const Result<VolumeData> original = io::readVolume(whole.path(), {.resample = true});
    ASSERT_TRUE(isOk(original));
    EXPECT_EQ(original->type, ScalarType::Int16) << "nothing is to be resampled";
    EXPECT_FALSE(io::wasResampled(*original));
    const VolumeData volume = resampled(folder);
    EXPECT_EQ(volume.grid.size, original->grid.size);
    EXPECT_NEAR(volume.grid.spacing[2], 0.6, 1e-12);
    EXPECT_THAT(volume.notes,
                testing::ElementsAre("DICOM series of 14 slices",
                                     "resampled to a regular grid by linear interpolation, as floats: gaps of 0.6 to "
                                     "1.2 mm become 0.6 mm, a shear of 0 degrees becomes 0"));
    const std::vector<float> voxels = floatsOf(volume);
    std::vector<std::int16_t> expected(original->voxels.size() / 2);
    std::memcpy(expected.data(), original->voxels.data(), original->voxels.size());
    constexpr std::size_t kPixelsOfSlice = std::size_t{kWide} * kHigh;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        const bool isMissing = i / kPixelsOfSlice == kMissing;
        const double mean =
            isMissing ? (expected[i - kPixelsOfSlice] + expected[i + kPixelsOfSlice]) / 2.0 : expected[i];
        ASSERT_NEAR(voxels[i], mean, 1e-3) << i;
    }
}

TEST(DicomResample, RefusesWhatNoGridIsMadeOf) {
    const TemporaryFolder far;
    writeField(far, {{0, 0, 0}, {0, 0, 2.5}, {0, 0, 5}, {0, 0, 500}});
    expectRefused(io::readVolume(far.path(), {.resample = true}),
                  "its 4 slices, 2.5 to 495 mm apart, lie too far from each other to be resampled", far.path());
    const TemporaryFolder beside;
    writeField(beside, {{0, 0, 0}, {0, 0, 2.5}, {400, 0, 5}});
    expectRefused(io::readVolume(beside.path(), {.resample = true}), "lie too far from each other", beside.path());
    const TemporaryFolder twice;
    writeField(twice, {{0, 0, 0}, {0, 0, 2.5}, {0, 0, 2.5}});
    expectRefused(io::readVolume(twice.path(), {.resample = true}), "are at the same place", twice.path());
    const TemporaryFolder labels;
    writeField(labels, {{0, 0, 0}, {0, 0, 2.5}, {0, 0, 7.5}});
    expectRefused(io::readLabels(labels.path(), {.resample = true}), "a slice is missing", labels.path());
}

/// One slice twice as near as the others does not double them.
TEST(DicomResample, ANearPairAmongManySlices) {
    const TemporaryFolder folder;
    std::vector<Place> places;
    for (int i = 0; i < 10; ++i) {
        places.push_back({0, 0, 2.5 * i});
    }
    places.insert(places.begin() + 1, {0, 0, 0.5});
    writeField(folder, places);
    const VolumeData volume = resampled(folder);
    EXPECT_EQ(volume.grid.size[2], 10U);
    expectField(volume, places);
}

} // namespace
} // namespace voxtact::test
