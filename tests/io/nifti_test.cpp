// SPDX-License-Identifier: MIT
#include "io_test_support.h"
#include "support/special.h"

#include <cmath>
#include <limits>

namespace voxtact::test {
namespace {

Result<VolumeData> readBytes(const std::string& bytes, const io::VolumeReadOptions& options = {}) {
    return io::readVolume("v.nii", std::as_bytes(std::span(bytes)), options);
}

Result<VolumeData> readFile(const NiftiFile& file) {
    return readBytes(file.bytes());
}

/// 45 degrees about z, spacing 2, 3, 4; as a quaternion and as an sform.
NiftiFile turned(bool second) {
    NiftiFile file;
    file.second = second;
    const double half = std::sqrt(0.5);
    file.spacing = {2, 3, 4};
    file.quaternion = {0, 0, std::sin(std::atan(1.0) / 2)};
    file.qoffset = {10, 20, 30};
    file.sform = {2 * half, -3 * half, 0, 10, 2 * half, 3 * half, 0, 20, 0, 0, 4, 30};
    return file;
}

TEST(Nifti, LengthsInMetresAndMicrometresBecomeMillimetres) {
    for (const bool second : {false, true}) {
        for (const bool qform : {false, true}) {
            NiftiFile file = turned(second);
            file.sformCode = qform ? 0 : 1;
            file.qformCode = qform ? 1 : 0;
            const auto plain = readFile(file);
            ASSERT_TRUE(isOk(plain));
            EXPECT_THAT(plain->notes, testing::IsEmpty());
            for (const auto& [units, scale] : {std::pair{1, 1e3}, std::pair{2, 1.0}, std::pair{3, 1e-3},
                                               std::pair{2 + 8, 1.0}, std::pair{3 + 16, 1e-3}}) {
                file.units = units;
                const auto volume = readFile(file);
                ASSERT_TRUE(isOk(volume));
                for (std::size_t i = 0; i < 3; ++i) {
                    EXPECT_NEAR(volume->grid.spacing[i], scale * plain->grid.spacing[i], 1e-12 * scale) << units;
                    EXPECT_NEAR(volume->grid.origin[i], scale * plain->grid.origin[i], 1e-12 * scale) << units;
                }
                EXPECT_EQ(volume->notes.size(), scale == 1 ? 0U : 1U);
            }
            file.units = 5;
            expectRefused(readFile(file), "its unit of length (xyzt_units 5) is none that NIfTI defines");
        }
    }
}

TEST(Nifti, TheSformCountsAndAQformThatDiffersIsNoted) {
    for (const bool second : {false, true}) {
        NiftiFile file = turned(second);
        file.sformCode = 2;
        file.qformCode = 1;
        const auto same = readFile(file);
        ASSERT_TRUE(isOk(same));
        EXPECT_THAT(same->notes, testing::IsEmpty());
        file.qoffset = {-10, 20, 30};
        const auto differs = readFile(file);
        ASSERT_TRUE(isOk(differs));
        EXPECT_EQ(differs->grid.origin, same->grid.origin);
        EXPECT_THAT(differs->notes, testing::ElementsAre("the file says two places: its sform (code 2) and its qform "
                                                         "(code 1) lie up to 20 mm apart; the sform is taken"));
        file.sformCode = 0;
        const auto qform = readFile(file);
        ASSERT_TRUE(isOk(qform));
        EXPECT_THAT(qform->notes, testing::IsEmpty());
        EXPECT_NEAR(qform->grid.origin[0], 10, 1e-9);
    }
}

/// Half a turn: the quaternion's first number is all rounding.
TEST(Nifti, RoundingIsNoDifferenceBetweenQformAndSform) {
    NiftiFile file;
    file.sizes = {64, 64, 1};
    file.voxels.assign(64 * 64, '\1');
    for (double angle = 3.14159; angle < 3.14160; angle += 1e-7) {
        file.quaternion = {0, 0, std::sin(angle / 2)};
        file.sform = {std::cos(angle), -std::sin(angle), 0, 0, std::sin(angle), std::cos(angle), 0, 0, 0, 0, 1, 0};
        file.qformCode = 1;
        const auto volume = readFile(file);
        ASSERT_TRUE(isOk(volume));
        EXPECT_THAT(volume->notes, testing::IsEmpty()) << angle;
    }
}

/// nibabel: x reversed, the image's centre at the origin. In LPS that is +x, -y, +z.
TEST(Nifti, WithoutEitherTheCentreIsTheOriginAsInNibabel) {
    for (const bool second : {false, true}) {
        NiftiFile file;
        file.second = second;
        file.sformCode = 0;
        file.spacing = {2, 3, 4};
        const auto volume = readFile(file);
        ASSERT_TRUE(isOk(volume));
        EXPECT_EQ(volume->grid.origin, (Vec3{-3, 3, -2}));
        EXPECT_EQ(volume->grid.direction, (std::array<double, 9>{1, 0, 0, 0, -1, 0, 0, 0, 1}));
        EXPECT_THAT(volume->notes, testing::ElementsAre(testing::HasSubstr("does not say how the patient lies")));
    }
}

TEST(Nifti, NumbersThatAreNoneAreRefusedByName) {
    for (const bool second : {false, true}) {
        for (const double bad : {kNan, kInfinity, -kInfinity}) {
            for (std::size_t i = 0; i < 12; ++i) {
                NiftiFile file = turned(second);
                file.sform[i] = bad;
                const std::string name = std::string("srow_") + "xyz"[i / 4] + "[" + std::to_string(i % 4) + "] is ";
                expectRefused(readFile(file), name + (std::isnan(bad) ? "NaN" : "infinite"));
            }
            for (std::size_t i = 0; i < 3; ++i) {
                for (const bool sform : {false, true}) {
                    NiftiFile file = turned(second);
                    file.qformCode = 1;
                    file.sformCode = sform ? 1 : 0;
                    file.quaternion[i] = bad;
                    expectRefused(readFile(file), std::string("quatern_") + "bcd"[i] + " is ");
                    file = turned(second);
                    file.qformCode = 1;
                    file.sformCode = sform ? 1 : 0;
                    file.qoffset[i] = bad;
                    expectRefused(readFile(file), std::string("qoffset_") + "xyz"[i] + " is ");
                    file = turned(second);
                    file.sformCode = sform ? 1 : 0;
                    file.spacing[i] = bad;
                    expectRefused(readFile(file), "pixdim[" + std::to_string(i + 1) + "] is ");
                }
            }
            NiftiFile file = turned(second);
            file.qfac = bad;
            expectRefused(readFile(file), "pixdim[0] is ");
        }
    }
}

TEST(Nifti, PlacesThatCannotBeAreRefused) {
    NiftiFile file = turned(true);
    file.sform[3] = 1e300;
    expectRefused(readFile(file), "its origin is -1e+300 mm away, which cannot be");
    file = turned(true);
    file.sform[10] = 1e-300;
    expectRefused(readFile(file), "its voxels along axis 2 are 1e-300 mm apart, which cannot be");
    file = turned(false);
    file.sformCode = 0;
    file.qformCode = 1;
    file.quaternion = {0.9, 0.9, 0};
    expectRefused(readFile(file), "its quaternion is longer than 1 (its square is 1.62)");
}

TEST(Nifti, ShearIsRefusedWithItsSize) {
    for (const bool second : {false, true}) {
        NiftiFile file;
        file.second = second;
        const double angle = 7.5 * std::atan(1.0) / 45;
        file.sform = {1, std::sin(angle), 0, 0, 0, std::cos(angle), 0, 0, 0, 0, 1, 0};
        expectRefused(readFile(file), "its sform shears the image by 7.5 degrees");
        file.sform[1] = 1e-3; // 0.06 degrees: what rounding of a written matrix gives is taken as it is
        const auto volume = readFile(file);
        ASSERT_TRUE(isOk(volume));
        EXPECT_NEAR(worldFromIndex(volume->grid)[4], -1e-3, 1e-9);
    }
}

TEST(Nifti, SlopesThatAreNoNumbers) {
    NiftiFile file;
    file.slope = kNan;
    file.intercept = kNan;
    const auto volume = readFile(file);
    ASSERT_TRUE(isOk(volume));
    EXPECT_EQ(volume->type, ScalarType::UInt8);
    EXPECT_THAT(volume->notes, testing::ElementsAre(testing::HasSubstr("scl_slope is NaN; its voxels are taken as")));
    file.intercept = 5;
    expectRefused(readFile(file), "its voxels have no scale: scl_slope is nan, scl_inter is 5");
    file.slope = kInfinity;
    file.intercept = 0;
    expectRefused(readFile(file), "its voxels have no scale: scl_slope is inf, scl_inter is 0");
    file.slope = 2;
    file.intercept = kNan;
    expectRefused(readFile(file), "its voxels have no scale: scl_slope is 2, scl_inter is nan");
    file.slope = 3e38;
    file.intercept = 0;
    expectRefused(readFile(file), "voxel (0, 0, 0) is too large for a float");
}

TEST(Nifti, BothByteOrders) {
    for (const bool second : {false, true}) {
        for (const bool swapped : {false, true}) {
            NiftiFile file = turned(second);
            file.swapped = swapped;
            file.sizes = {3, 1, 1};
            file.type = 4;
            file.bits = 16;
            file.voxels =
                swapped ? std::string("\x01\x02\xFF\xFE\x00\x03", 6) : std::string("\x02\x01\xFE\xFF\x03\x00", 6);
            const auto volume = readFile(file);
            ASSERT_TRUE(isOk(volume));
            std::array<std::int16_t, 3> values{};
            ASSERT_EQ(volume->voxels.size(), sizeof values);
            std::memcpy(values.data(), volume->voxels.data(), sizeof values);
            EXPECT_THAT(values, testing::ElementsAre(258, -2, 3));
            EXPECT_NEAR(volume->grid.spacing[1], 3, 1e-6);
        }
    }
}

TEST(Nifti, ExtensionsAreSkipped) {
    for (const bool second : {false, true}) {
        NiftiFile file;
        file.second = second;
        file.extension = std::string("\1\0\0\0", 4) + std::string(320, '\xEE');
        for (const bool zipped : {false, true}) {
            const auto volume = readBytes(zipped ? compressed(file.bytes(), Wrapping::Gzip) : file.bytes());
            ASSERT_TRUE(isOk(volume));
            EXPECT_EQ(volume->voxels, std::vector<std::byte>(24, std::byte{7}));
        }
    }
}

TEST(Nifti, FramesAreChosen) {
    NiftiFile file;
    file.sizes = {2, 1, 1, 3};
    file.voxels = "abcdef";
    expectRefused(readFile(file), "it is 4D and holds 3 images; name the one that is meant (frame 0 to 2;");
    for (std::uint32_t frame = 0; frame < 3; ++frame) {
        const auto volume = readBytes(file.bytes(), {frame});
        ASSERT_TRUE(isOk(volume));
        EXPECT_EQ(volume->voxels[0], std::byte('a' + 2 * frame));
        EXPECT_EQ(volume->voxels[1], std::byte('b' + 2 * frame));
        EXPECT_EQ(volume->voxels.size(), 2U);
    }
    expectRefused(readBytes(file.bytes(), {3}), "it has no frame 3: it holds 3 images, counted from 0");
    file.voxels.pop_back();
    EXPECT_TRUE(isOk(readBytes(file.bytes(), {1})));
    expectRefused(readBytes(file.bytes(), {2}), "it is truncated: its voxels take 2 bytes, 1 are there");
    file.sizes = {2, 1, 1, 3, 2};
    expectRefused(readBytes(file.bytes(), {1}), "it is 5D and holds 2 images or components");
}

/// What a header claims is not set aside before it is there.
TEST(Nifti, SizesThatLieCostNothing) {
    NiftiFile file;
    file.sizes = {32767, 32767, 500};
    for (const bool zipped : {false, true}) {
        expectRefused(readBytes(zipped ? compressed(file.bytes(), Wrapping::Gzip) : file.bytes()),
                      "it is truncated: its voxels take 536838144500 bytes, 24 are there");
    }
    file.second = true;
    file.sizes = {std::int64_t{1} << 40, 1, 1};
    expectRefused(readFile(file), "its header asks for more voxels than memory can hold");
    file.sizes = {1 << 20, 1 << 20, 1, std::int64_t{1} << 40};
    expectRefused(readBytes(file.bytes(), {1U << 31}), "its header asks for more voxels than memory can hold");
}

TEST(Nifti, SecondHeadersAreCheckedLikeTheFirst) {
    NiftiFile file;
    file.second = true;
    std::string bytes = file.bytes();
    bytes[8] = '\n'; // as a transfer as text leaves it
    expectRefused(readBytes(bytes), "its NIfTI-2 header is damaged (its magic bytes)");
    expectRefused(readBytes(file.bytes().substr(0, 500)), "a NIfTI header takes 540 bytes, 500 are there");
    file.pair = true;
    expectRefused(readFile(file), "in a separate .img file; name it .hdr");
    file = NiftiFile();
    bytes = file.bytes();
    const float offset = 0;
    std::memcpy(bytes.data() + 108, &offset, sizeof offset);
    expectRefused(readBytes(bytes), "its voxels cannot begin at its vox_offset");
}

TEST(Nifti, PairsOfBothVersions) {
    const TemporaryFolder folder;
    for (const bool second : {false, true}) {
        NiftiFile file = turned(second);
        file.pair = true;
        folder.write("p.hdr.gz", compressed(file.bytes(), Wrapping::Gzip));
        folder.write("p.img", file.voxels);
        const auto volume = io::readVolume(folder / "p.img");
        ASSERT_TRUE(isOk(volume));
        EXPECT_EQ(volume->voxels, std::vector<std::byte>(24, std::byte{7}));
        // Voxels may look like gzip.
        folder.write("p.img", "\x1F\x8B" + file.voxels.substr(2));
        const auto looks = io::readVolume(folder / "p.img");
        ASSERT_TRUE(isOk(looks));
        EXPECT_EQ(looks->voxels[0], std::byte{0x1F});
    }
    NiftiFile file;
    file.pair = true;
    const std::string bytes = file.bytes();
    // The file that is named is read, and what is beside it, compressed as it is.
    for (const char value : {'\1', '\2'}) {
        const bool zipped = value == '\2';
        const auto write = [&](const std::string& name, const std::string& content) {
            folder.write(zipped ? name + ".gz" : name, zipped ? compressed(content, Wrapping::Gzip) : content);
        };
        file.sform[3] = zipped ? 5 : 0;
        write("both.hdr", file.bytes());
        write("both.img", std::string(file.voxels.size(), value));
    }
    for (const char* name : {"both.hdr", "both.img", "both.hdr.gz", "both.img.gz"}) {
        const auto both = io::readVolume(folder / name);
        ASSERT_TRUE(isOk(both)) << name;
        const bool zipped = std::string_view(name).ends_with(".gz");
        EXPECT_EQ(both->voxels[0], std::byte(zipped ? 2 : 1)) << name;
        EXPECT_EQ(both->grid.origin[0], zipped ? -5 : 0) << name;
    }
    expectRefused(io::readVolume("p.hdr", std::as_bytes(std::span(bytes))), "p.img': only one file is in memory");
}

} // namespace
} // namespace voxtact::test
