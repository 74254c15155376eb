// SPDX-License-Identifier: MIT
// DICOM folders that are refused: which file, what is wrong with it, and never a guess.
#include "dicom_writer.h"

#include <fstream>
#include <random>

#include <sys/resource.h>
#include <sys/stat.h>

namespace voxtact::test {
namespace {

class DicomRefusal : public testing::Test {
  protected:
    /// A series in which slice `index` is another one.
    Result<VolumeData> readWith(int index, const DicomSet& set, int slices = 4) {
        writeCt(folder_, slices);
        folder_.write("s" + std::to_string(index) + ".dcm", set.file());
        return io::readVolume(folder_.path());
    }
    std::filesystem::path slice(int index) const { return folder_ / ("s" + std::to_string(index) + ".dcm"); }

    TemporaryFolder folder_;
};

TEST_F(DicomRefusal, NothingThatIsMissingIsAssumed) {
    const std::vector<std::pair<std::uint32_t, const char*>> needed{
        {0x00280030, "it has no PixelSpacing (0028,0030), so the size of its pixels is not known"},
        {0x00200037, "it has no ImageOrientationPatient (0020,0037), so how it lies in the patient is not known"},
        {0x00200032, "it has no ImagePositionPatient (0020,0032), so its place in the series is not known"},
        {0x00280010, "it has no Rows (0028,0010)"},
        {0x00280011, "it has no Columns (0028,0011)"},
        {0x00280100, "it has no BitsAllocated (0028,0100)"},
        {0x00280101, "it has no BitsStored (0028,0101)"},
        {0x00280102, "it has no HighBit (0028,0102)"},
        {0x00280103, "it has no PixelRepresentation (0028,0103)"},
        {0x00281052, "it has no RescaleIntercept (0028,1052), but the other half"},
        {0x00281053, "it has no RescaleSlope (0028,1053), but the other half"},
        {0x7FE00010, "it is a DICOM file without an image, or it is truncated"}};
    for (const auto& [tag, reason] : needed) {
        expectRefused(readWith(2, ctSlice(2).remove(tag)), reason, slice(2));
        // In all of them it is no better.
        for (int i = 0; i < 4; ++i) {
            folder_.write("s" + std::to_string(i) + ".dcm", ctSlice(i).remove(tag).file());
        }
        expectRefused(io::readVolume(folder_.path()), reason, slice(0));
    }
}

TEST_F(DicomRefusal, NumbersThatAreNone) {
    const auto with = [&](std::uint32_t tag, const char* value) {
        return readWith(1, ctSlice(1).text(tag, "DS", value));
    };
    expectRefused(with(0x00280030, "0,8\\0,5"), "its PixelSpacing (0028,0030) is '0,8\\0,5', not 2 numbers", slice(1));
    expectRefused(with(0x00280030, "0.8"), "not 2 numbers", slice(1));
    expectRefused(with(0x00280030, "1\\1\\1"), "not 2 numbers", slice(1));
    expectRefused(with(0x00280030, "1\\nan"), "not 2 numbers", slice(1));
    expectRefused(with(0x00280030, "1\\1e999"), "not 2 numbers", slice(1));
    expectRefused(with(0x00280030, "0.8\\-0.5"), "is 0.8 and -0.5 mm; both must be above 0", slice(1));
    expectRefused(with(0x00280030, "0.8\\0"), "both must be above 0", slice(1));
    expectRefused(with(0x00200032, "1\\2"), "its ImagePositionPatient (0020,0032) is '1\\2', not 3 numbers", slice(1));
    expectRefused(with(0x00200037, "1\\0\\0\\1\\0\\0"), "is not two unit vectors at right angles", slice(1));
    expectRefused(with(0x00200037, "2\\0\\0\\0\\1\\0"), "is not two unit vectors at right angles", slice(1));
    expectRefused(with(0x00200037, "0\\0\\0\\0\\0\\0"), "is not two unit vectors at right angles", slice(1));
    expectRefused(with(0x00281053, "0"), "its RescaleSlope (0028,1053) is 0, which makes all voxels equal", slice(1));
    expectRefused(with(0x00281053, "two\n"), "its RescaleSlope (0028,1053) is 'two\\x0a', not 1 number", slice(1));
}

/// As those leave who keep large files elsewhere; the last slice would be missed by nobody.
TEST_F(DicomRefusal, LinksToNothing) {
    writeCt(folder_, 5);
    std::filesystem::remove(slice(4));
    std::filesystem::create_symlink(folder_ / "elsewhere" / "s4.dcm", slice(4));
    expectRefused(io::readVolume(folder_.path()), "it is a link to a file that is not there", slice(4));
    std::filesystem::remove(slice(4));
    std::filesystem::create_symlink(slice(4), slice(4)); // to itself: nobody can look at it
    expectRefused(io::readVolume(folder_.path()), std::generic_category().message(ELOOP), slice(4));
}

TEST_F(DicomRefusal, Gaps) {
    writeCt(folder_, 9);
    std::filesystem::remove(slice(4));
    expectRefused(io::readVolume(folder_.path()),
                  "a slice is missing between 's3.dcm' (at 12.5 mm) and 's5.dcm' (at 17.5 mm): most gaps are 2.5 mm, "
                  "this one is 5 mm",
                  folder_.path());
    std::filesystem::remove(slice(5));
    expectRefused(io::readVolume(folder_.path()),
                  "2 slices are missing between 's3.dcm' (at 12.5 mm) and 's6.dcm' (at 20 mm)");
    std::filesystem::remove(slice(1));
    expectRefused(io::readVolume(folder_.path()),
                  "a slice is missing between 's0.dcm' (at 5 mm) and 's2.dcm' (at 10 mm) (and 1 more such gaps)");
    const TemporaryFolder other;
    const auto shifted = [&](int index, double by) {
        writeCt(other, 6);
        other.write("s" + std::to_string(index) + ".dcm",
                    ctSlice(index).text(0x00200032, "DS", "-10\\20\\" + std::to_string(5 + kGap * index + by)).file());
        return io::readVolume(other.path());
    };
    ASSERT_TRUE(isOk(shifted(2, 0.02)));
    expectRefused(shifted(2, 0.7), "the gaps between its slices are uneven: 3.2 mm between 's1.dcm' (at 7.5 mm) and "
                                   "'s2.dcm' (at 10.7 mm) (and 1 more such gaps), where 2.5 mm are usual");
}

/// Each gap is within the tolerance of the usual one, the last slice far from its place.
TEST_F(DicomRefusal, GapsThatDrift) {
    for (int i = 0; i < 30; ++i) {
        const double at = 5 + 2.5 * i + 0.002 * i * i;
        folder_.write(std::to_string(i), ctSlice(i).text(0x00200032, "DS", "-10\\20\\" + std::to_string(at)).file());
    }
    expectRefused(io::readVolume(folder_.path()), "the gaps between its slices are uneven");
}

TEST_F(DicomRefusal, TwoAtOnePlace) {
    const auto twice = [&](const DicomSet& set) {
        writeCt(folder_, 4);
        folder_.write("t.dcm", set.file());
        return io::readVolume(folder_.path());
    };
    const std::string where = "'s2.dcm' and 't.dcm' are at the same place (10 mm): ";
    expectRefused(twice(ctSlice(2)), where + "they are the same image; take one of them away", folder_.path());
    DicomSet other = ctSlice(2).text(0x00080018, "UI", "7");
    expectRefused(twice(other), where + "the series holds more than one image, or one of them twice");
    expectRefused(twice(other.text(0x00180081, "DS", "4.6")),
                  where + "they differ in EchoTime ('' and '4.6'): the series holds more than one image");
}

/// The odd one is named, wherever it stands.
TEST_F(DicomRefusal, MixedSlices) {
    for (const int odd : {0, 2}) {
        const DicomSet set = ctSlice(odd);
        expectRefused(readWith(odd, DicomSet(set).text(0x00280030, "DS", "0.8\\0.6")),
                      "the pixel spacing in mm of 's" + std::to_string(odd) + ".dcm' is 0.6 x 0.8, that of 's",
                      slice(odd));
        expectRefused(readWith(odd, DicomSet(set).text(0x00200037, "DS", "1\\0\\0\\0\\0\\1")),
                      "the orientation of 's" + std::to_string(odd) + ".dcm' is rows (1, 0, 0), columns (0, 0, 1)",
                      slice(odd));
        expectRefused(
            readWith(odd, DicomSet(set).number(0x00280010, 4).words(0x7FE00010, std::vector<std::uint16_t>(20))),
            "the size of 's" + std::to_string(odd) + ".dcm' is 5 x 4, that of", slice(odd));
        expectRefused(readWith(odd, DicomSet(set).text(0x00200052, "UI", "8.8")),
                      "the frame of reference of 's" + std::to_string(odd) + ".dcm' is '8.8', that of", slice(odd));
        expectRefused(readWith(odd, DicomSet(set).remove(0x00281052).remove(0x00281053)),
                      "the rescaling of 's" + std::to_string(odd) + ".dcm' is neither, that of", slice(odd));
    }
}

TEST_F(DicomRefusal, SeveralSeries) {
    const DicomSet other = ctSlice(1)
                               .text(0x0020000E, "UI", "5.5.5")
                               .text(0x00080060, "CS", "MR")
                               .text(0x0008103E, "LO", "T1\x1b[31m \xC3\xA4");
    expectRefused(
        readWith(1, other),
        "the folder holds 2 DICOM series: 1.2.3.4 (CT, 'Thorax', 3 files), 5.5.5 (MR, 'T1\\x1b[31m \xC3\xA4', 1 file); "
        "name the one that is meant (to the program: FOLDER#UID)",
        folder_.path());
    expectRefused(io::readVolume(folder_.path(), {.frame = {}, .series = "1.2.3"}),
                  "the folder holds no DICOM series 1.2.3; it holds 1.2.3.4 (CT, 'Thorax', 3 files), 5.5.5",
                  folder_.path());
    expectRefused(readWith(1, ctSlice(1).remove(0x0020000E)),
                  "the folder holds 2 DICOM series: one without SeriesInstanceUID (CT, 'Thorax', 1 file), 1.2.3.4");
}

TEST_F(DicomRefusal, TooFew) {
    folder_.write("README", "nothing");
    expectRefused(io::readVolume(folder_.path()), "the folder holds no DICOM series", folder_.path());
    writeCt(folder_, 1);
    expectRefused(io::readVolume(folder_.path()), "fewer than 2 slices; a 3D image is needed");
}

/// 20 degrees: each slice is shifted within its plane by tan(20 degrees) of the gap along the normal.
TEST_F(DicomRefusal, TiltedGantry) {
    for (int i = 0; i < 5; ++i) {
        const double shift = 0.3639702342662024 * kGap * i;
        folder_.write(
            std::to_string(i),
            ctSlice(i)
                .text(0x00200032, "DS", "-10\\" + std::to_string(20 + shift) + "\\" + std::to_string(5 + kGap * i))
                .file());
    }
    expectRefused(io::readVolume(folder_.path()), "its slices are sheared by 20 degrees (tilted gantry)",
                  folder_.path());
}

TEST_F(DicomRefusal, SliceBesideTheOthers) {
    expectRefused(readWith(2, ctSlice(2).text(0x00200032, "DS", "-7\\20\\10")),
                  "'s2.dcm' (at 10 mm) lies 3 mm off the line of the other slices' first pixels", folder_.path());
}

TEST_F(DicomRefusal, PixelsOfOtherKinds) {
    expectRefused(readWith(1, ctSlice(1).text(0x00280004, "CS", "RGB").number(0x00280002, 3)),
                  "its pixels are colours (PhotometricInterpretation 'RGB', 3 samples per pixel)", slice(1));
    expectRefused(readWith(1, ctSlice(1).text(0x00280004, "CS", "PALETTE COLOR")), "its pixels are colours", slice(1));
    expectRefused(readWith(1, ctSlice(1).sequence(0x00283000, {DicomSet().number(0x00283002, 1)})),
                  "its values are given by a table, ModalityLUTSequence (0028,3000)", slice(1));
    expectRefused(readWith(1, ctSlice(1).number(0x00280100, 1)), "its pixels take 1 bits each (BitsAllocated)",
                  slice(1));
    expectRefused(readWith(1, ctSlice(1).number(0x00280102, 9)),
                  "its BitsAllocated 16, BitsStored 16 and HighBit 9 contradict each other", slice(1));
    expectRefused(readWith(1, ctSlice(1).remove(0x7FE00010).words(0x7FE00008, std::vector<std::uint16_t>(30))),
                  "its pixels are floats (7FE0,0008)", slice(1));
    writeCt(folder_, 3);
    folder_.write("s1.dcm", ctSlice(1).file("1.2.840.10008.1.2.4.201"));
    expectRefused(io::readVolume(folder_.path()),
                  "its transfer syntax 1.2.840.10008.1.2.4.201 (high-throughput JPEG 2000) is not supported", slice(1));
    folder_.write("s1.dcm", ctSlice(1).file("1.2.3"));
    expectRefused(io::readVolume(folder_.path()), "its transfer syntax 1.2.3 (unknown) is not supported", slice(1));
}

/// The size that the file states is held against what it has, before anything is allocated.
TEST_F(DicomRefusal, GigabytesThatAreNotThere) {
    rusage before{};
    getrusage(RUSAGE_SELF, &before);
    expectRefused(readWith(1, ctSlice(1).number(0x00280010, 65535).number(0x00280011, 65535)),
                  "its pixels take 30 bytes, which is not 65535 columns x 65535 rows x 1 frames x 2 bytes", slice(1));
    expectRefused(readWith(1, ctSlice(1).text(0x00280008, "IS", "4294967295")), "its pixels take 30 bytes", slice(1));
    expectRefused(readWith(1, ctSlice(1).text(0x00280008, "IS", "99999999999")),
                  "its NumberOfFrames (0028,0008) is '99999999999', which is not a count", slice(1));
    for (const char* syntax : {kRle, kJpegLossless, kJpegLs, kJpeg2000, kDeflated}) {
        for (int i = 0; i < 3; ++i) {
            DicomSet set = ctSlice(i).number(0x00280010, 60000).number(0x00280011, 60000);
            if (syntax != kDeflated) {
                set.pieces(0x7FE00010, {std::string(64, '\1')});
            }
            folder_.write("s" + std::to_string(i) + ".dcm", set.file(syntax));
        }
        std::filesystem::remove(slice(3));
        expectRefused(io::readVolume(folder_.path()),
                      syntax == kDeflated ? "its pixels take 30 bytes" : "far more than", slice(0).parent_path());
    }
    std::string lying = ctSlice(1).file();
    const std::size_t pixels = lying.rfind(std::string("\xE0\x7F\x10\0OW\0\0", 8));
    lying.replace(pixels + 8, 4, "\xF0\xFF\xFF\xFF");
    folder_.write("s1.dcm", lying);
    folder_.write("s0.dcm", ctSlice(0).file());
    folder_.write("s2.dcm", ctSlice(2).file());
    expectRefused(io::readVolume(folder_.path()),
                  "it is truncated: its pixels take 4294967280 bytes, 30 are left; get the file again", slice(1));
    rusage after{};
    getrusage(RUSAGE_SELF, &after);
    EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 64 * 1024) << "KiB";
    EXPECT_LT(after.ru_utime.tv_sec - before.ru_utime.tv_sec, 20) << "seconds of the processor";
}

/// Pipes are not waited for, and what stands in other files is nobody's business: a system's configuration once ended
/// the program.
TEST_F(DicomRefusal, FoldersOfOtherFiles) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    for (int i = 0; i < 300; ++i) {
        std::string content(random() % 400, '\0');
        for (char& c : content) {
            c = static_cast<char>(random() % (i % 2 == 0 ? 256 : 9));
        }
        if (i % 4 == 0) {
            content = std::string("\x08\0", 2) + content;
        }
        folder_.write("f" + std::to_string(i), content);
    }
    const auto volume = io::readVolume(folder_.path());
    ASSERT_FALSE(volume.ok());
    EXPECT_EQ(volume.error().text.find('\n'), std::string::npos);
}

/// Cut anywhere, a slice is refused by its name.
TEST_F(DicomRefusal, TruncatedAtEveryLength) {
    for (const char* syntax : {kImplicit, kExplicit, kBigEndian}) {
        writeCt(folder_, 3, syntax);
        const std::string whole = ctSlice(1).file(syntax);
        for (std::size_t length = 132; length < whole.size(); length += length < whole.size() - 60 ? 3 : 1) {
            folder_.write("s1.dcm", whole.substr(0, length));
            const auto volume = io::readVolume(folder_.path());
            ASSERT_FALSE(volume.ok()) << length << " of " << whole.size();
            EXPECT_THAT(volume.error().text, testing::HasSubstr(slice(1).string())) << length;
        }
    }
}

/// A byte of one slice is another: the series is refused in one line, or read with the size that it had. Nothing is
/// printed, and nothing takes long.
TEST_F(DicomRefusal, DamagedAtEveryByte) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    writeCt(folder_, 3);
    const std::string whole = ctSlice(1).file();
    testing::internal::CaptureStderr();
    for (std::size_t at = 132; at < whole.size(); ++at) {
        std::string damaged = whole;
        damaged[at] = static_cast<char>(random());
        folder_.write("s1.dcm", damaged);
        const auto volume = io::readVolume(folder_.path());
        if (volume.ok()) {
            ASSERT_EQ(volume->grid.size, (std::array<std::uint32_t, 3>{kColumns, kRows, 3})) << at;
        } else {
            ASSERT_EQ(volume.error().text.find('\n'), std::string::npos) << at;
            ASSERT_LT(volume.error().text.size(), 2000) << at;
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// An element in the place of a count: what stopped the old reader's library.
TEST_F(DicomRefusal, ElementsOfAnotherLength) {
    expectRefused(readWith(1, ctSlice(1).text(0x00280002, "US", std::string(944, '\1'))), "element (0028,0002) at byte",
                  slice(1));
    std::string content = ctSlice(1).file();
    content.replace(content.find(std::string("\x28\0\x53\x10"
                                             "DS",
                                             6)) +
                        4,
                    2, "LG");
    folder_.write("s1.dcm", content);
    expectRefused(io::readVolume(folder_.path()), "element (0028,1053) at byte", slice(1));
    expectRefused(io::readVolume(folder_.path()), "is of no known type; get the file again", slice(1));
    // The same element twice: which one is meant?
    content = ctSlice(1).file();
    const std::size_t at = content.find(std::string("\x28\0\x53\x10"
                                                    "DS",
                                                    6));
    content.insert(at, content.substr(at, 10));
    folder_.write("s1.dcm", content);
    expectRefused(io::readVolume(folder_.path()), "element (0028,1053) at byte", slice(1));
    expectRefused(io::readVolume(folder_.path()), "comes a second time", slice(1));
}

} // namespace
} // namespace voxtact::test
