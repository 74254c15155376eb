// SPDX-License-Identifier: MIT
// What DICOM files say beside the usual, and what is wrong with them behind their pixels or their names.
#include "dicom_writer.h"

#include <functional>

namespace voxtact::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

constexpr std::uint32_t kPixels = 0x7FE00010;

class DicomHeader : public testing::Test {
  protected:
    /// Four slices, each as `make` has it.
    template <class Make> Result<VolumeData> readAll(Make&& make) {
        for (int i = 0; i < 4; ++i) {
            folder_.write("s" + std::to_string(i) + ".dcm", make(i));
        }
        return io::readVolume(folder_.path());
    }
    static void expectUsual(const Result<VolumeData>& volume) {
        ASSERT_TRUE(isOk(volume));
        EXPECT_EQ(volume->grid.size, (std::array<std::uint32_t, 3>{kColumns, kRows, 4}));
        ASSERT_EQ(volume->type, ScalarType::Int16);
        for (int slice = 0; slice < 4; ++slice) {
            const std::vector<std::uint16_t> words = ctWords(slice);
            EXPECT_EQ(std::memcmp(volume->voxels.data() + slice * 2 * words.size(), words.data(), 2 * words.size()), 0);
        }
    }
    std::filesystem::path slice(int index) const { return folder_ / ("s" + std::to_string(index) + ".dcm"); }

    TemporaryFolder folder_;
};

TEST_F(DicomHeader, DosesAreScaled) {
    const auto dose = [](int index) {
        return ctSlice(index)
            .text(0x00080060, "CS", "RTDOSE")
            .text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.481.2")
            .remove(0x00281052)
            .remove(0x00281053)
            .text(0x3004000E, "DS", "0.001");
    };
    const auto volume = readAll([&](int i) { return dose(i).file(); });
    ASSERT_TRUE(isOk(volume));
    ASSERT_EQ(volume->type, ScalarType::Float32);
    float value = 0;
    std::memcpy(&value, volume->voxels.data() + sizeof value, sizeof value);
    EXPECT_FLOAT_EQ(value, static_cast<float>(0.001 * ctValue(0, 0, 1)));
    EXPECT_THAT(volume->notes, Contains("voxels are doses: DoseGridScaling is applied"));
    expectRefused(readAll([&](int i) { return dose(i).text(0x3004000E, "DS", "0").file(); }),
                  "its DoseGridScaling (3004,000E) is 0; it must be above 0", slice(0));
    expectRefused(readAll([&](int i) { return dose(i).text(0x3004000E, "DS", "x").file(); }), "not 1 number", slice(0));
    expectRefused(readAll([&](int i) { return ctSlice(i).text(0x3004000E, "DS", "2").file(); }),
                  "and it has a RescaleSlope, too", slice(0));
}

/// The frames of a dose lie along its normal; what begins with the patient's z has places instead of offsets.
TEST_F(DicomHeader, FramesOfADose) {
    const auto read = [&](const std::string& offsets, const std::string& orientation = "1\\0\\0\\0\\1\\0") {
        std::vector<std::uint16_t> words;
        for (int i = 0; i < 4; ++i) {
            const std::vector<std::uint16_t> frame = ctWords(i);
            words.insert(words.end(), frame.begin(), frame.end());
        }
        const TemporaryFolder folder;
        folder.write("d", ctSlice(0)
                              .text(0x00280008, "IS", "4")
                              .text(0x00200037, "DS", orientation)
                              .text(0x3004000C, "DS", offsets)
                              .words(kPixels, words)
                              .file());
        return io::readVolume(folder.path());
    };
    for (const char* offsets : {"0\\2.5\\5\\7.5", "5\\7.5\\10\\12.5"}) {
        const auto volume = read(offsets);
        expectUsual(volume);
        EXPECT_EQ(volume->grid.spacing[2], 2.5);
        EXPECT_EQ(volume->grid.origin, (Vec3{-10, 20, 5}));
    }
    // The normal points down: places along z go against it.
    const auto down = read("5\\2.5\\0\\-2.5", "-1\\0\\0\\0\\1\\0");
    expectUsual(down);
    EXPECT_EQ(down->grid.origin, (Vec3{-10, 20, 5}));
    EXPECT_EQ(down->grid.direction[8], -1);
    expectRefused(read("0\\2.5\\5"), "its GridFrameOffsetVector (3004,000C) is '0\\2.5\\5', which is not 4 numbers");
    expectRefused(read("1\\2\\3\\4"), "begins with 1, which is neither 0 nor the place of the first frame");
    expectRefused(read("5\\2\\3\\4", "0\\1\\0\\0\\0\\1"), "begins with 5, which is neither 0");
}

TEST_F(DicomHeader, MosaicsAreNamed) {
    expectRefused(
        readAll([](int i) { return ctSlice(i).text(0x00080008, "CS", "ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC").file(); }),
        "it is a Siemens mosaic (ImageType (0008,0008) 'ORIGINAL\\PRIMARY\\M\\ND\\MOSAIC')", slice(0));
}

TEST_F(DicomHeader, OtherUnitsAreNoted) {
    const auto volume =
        readAll([](int i) { return ctSlice(i).sequence(0x00409096, {DicomSet().text(0x00409225, "DS", "2")}).file(); });
    expectUsual(volume);
    EXPECT_THAT(volume->notes, Contains(HasSubstr("RealWorldValueMappingSequence (0040,9096) is not applied")));
}

TEST_F(DicomHeader, SlicesThatLieSidewaysAreNoted) {
    const auto read = [&](double step) {
        return readAll([&](int i) {
            return ctSlice(i)
                .text(0x00200032, "DS", std::to_string(-10 + step * i) + "\\20\\" + std::to_string(5 + kGap * i))
                .file();
        });
    };
    const auto volume = read(0.015);
    expectUsual(volume);
    EXPECT_THAT(volume->notes, Contains("the slices lie up to 0.045 mm off the first one's normal (0.34 degrees in "
                                        "all); they are stacked upright"));
    EXPECT_THAT(read(0.003)->notes, testing::SizeIs(1));
}

TEST_F(DicomHeader, PaddingOfPixelsIsNoted) {
    const auto padded = [&](std::size_t words) {
        return readAll([&](int i) {
            std::vector<std::uint16_t> cells = ctWords(i);
            cells.resize(cells.size() + words, 7);
            return ctSlice(i).words(kPixels, cells).file();
        });
    };
    const auto volume = padded(2);
    expectUsual(volume);
    EXPECT_THAT(volume->notes, Contains(HasSubstr("4 files with more bytes of pixels than")));
    // A whole frame more is none.
    expectRefused(padded(15), "its pixels take 60 bytes, which is not 5 columns x 3 rows", slice(0));
}

TEST_F(DicomHeader, ElementsByTheOtherSyntax) {
    const auto expectNoted = [](const Result<VolumeData>& volume) {
        expectUsual(volume);
        EXPECT_THAT(volume->notes, Contains(HasSubstr("4 files whose elements are not stored by the transfer syntax")));
    };
    expectNoted(readAll([](int i) { // explicit is named, implicit is there
        const DicomSet set = ctSlice(i);
        const std::string whole = set.file(kExplicit);
        return whole.substr(0, whole.size() - set.body().size()) + set.body(false);
    }));
    expectNoted(readAll([](int i) {
        const DicomSet set = ctSlice(i);
        const std::string whole = set.file(kImplicit);
        return whole.substr(0, whole.size() - set.body(false).size()) + set.body(true);
    }));
}

/// Files that may have been slices.
TEST_F(DicomHeader, OtherFilesAreNamed) {
    const auto make = [](int i) { return ctSlice(i).file(); };
    ASSERT_TRUE(isOk(readAll(make)));
    for (const std::size_t length : {0U, 1U, 100U, 131U}) {
        folder_.write("s3.dcm", ctSlice(3).file().substr(0, length));
        expectRefused(io::readVolume(folder_.path()),
                      length == 0
                          ? "it is empty, and its name ends in .dcm"
                          : "it is no DICOM file (" + std::to_string(length) + " bytes), and its name ends in .dcm",
                      slice(3));
    }
    folder_.write("s3.dcm", "a note that somebody gave the name of a slice, and that goes on for more than the "
                            "hundred and thirty-two bytes that a file of DICOM begins with");
    expectRefused(io::readVolume(folder_.path()), "and its name ends in .dcm", slice(3));
    std::filesystem::remove(slice(3));
    folder_.write("LONG", std::string(200, 'x'));
    folder_.write("IM4", ctSlice(3).file().substr(0, 100));
    folder_.write("IM5", "");
    const auto volume = io::readVolume(folder_.path());
    ASSERT_TRUE(isOk(volume));
    EXPECT_EQ(volume->grid.size[2], 3U);
    EXPECT_THAT(volume->notes, Contains("3 files left out that are not DICOM: 'IM5' (empty), 'IM4', 'LONG'"));
    for (int i = 0; i < 4; ++i) {
        folder_.write("z" + std::to_string(i), "");
    }
    EXPECT_THAT(io::readVolume(folder_.path())->notes, Contains(testing::EndsWith("'z0' (empty), ...")));
}

TEST_F(DicomHeader, ElementsBehindThePixels) {
    const auto read = [&](const std::function<std::string(std::string)>& change, const char* syntax = kExplicit) {
        return readAll([&](int i) { return i == 1 ? change(ctSlice(i).file(syntax)) : ctSlice(i).file(syntax); });
    };
    const auto behind = [&](const std::string& bytes) { return read([&](auto file) { return file + bytes; }); };
    const std::string padding("\xFC\xFF\xFC\xFFOB\0\0\4\0\0\0\0\0\0\0", 16);
    expectUsual(behind(padding));
    expectUsual(behind(std::string("\xE1\x7F\x10\0LO\2\0AB", 10) + padding));
    expectRefused(behind(padding.substr(0, 15)), "element (FFFC,FFFC) at byte", slice(1));
    expectRefused(behind("\n"), "bytes that are no element follow its pixels", slice(1));
    const std::size_t zeros = ctSlice(1).file().size() % 512 == 510 ? 4 : 2; // that fill no block
    expectRefused(behind(std::string(zeros, '\0')), "bytes that are no element follow its pixels", slice(1));
    expectRefused(behind(ctSlice(1).body().substr(0, 60)), "stands behind the pixels", slice(1));
    // Blocks of media are filled up with zeros.
    const auto filled = read([](auto file) {
        file.resize((file.size() + 511) / 512 * 512);
        return file;
    });
    expectUsual(filled);
    EXPECT_THAT(filled->notes, Contains("1 file with blocks of zeros behind the last element"));
    // Anything that is put in among the pixels moves their end.
    for (const std::size_t more : {1U, 2U, 3U, 8U, 14U, 40U}) {
        for (const char filler : {'\0', '\1', '\xFF'}) {
            expectRefused(read([&](auto file) { return file.insert(file.size() - 16, more, filler); }),
                          "get the file again", slice(1));
        }
    }
}

TEST_F(DicomHeader, DeflatedToTheEnd) {
    ASSERT_TRUE(isOk(readAll([](int i) { return ctSlice(i).file(kDeflated); })));
    const std::string whole = ctSlice(1).file(kDeflated);
    const auto read = [&](const std::string& file) {
        folder_.write("s1.dcm", file);
        return io::readVolume(folder_.path());
    };
    EXPECT_TRUE(isOk(read(whole + '\0')));
    expectRefused(read(whole + "ab"), "its compressed data is cut off or damaged", slice(1));
    for (std::size_t length = whole.size() - 6; length < whole.size(); ++length) {
        expectRefused(read(whole.substr(0, length)), "get the file again", slice(1));
    }
}

/// A deflate stream of some kilobytes that becomes many megabytes: what its tags do not need is not inflated.
TEST_F(DicomHeader, ADeflateBombIsNotInflated) {
    for (const std::uint32_t tag : {0x00091001U, kPixels}) {
        writeCt(folder_, 4, kDeflated);
        DicomSet set = ctSlice(1).bytes(tag, std::string(std::size_t{5} << 24, '\0'));
        const auto volume = [&] {
            folder_.write("s1.dcm", set.file(kDeflated));
            return io::readVolume(folder_.path());
        }();
        ASSERT_FALSE(volume.ok());
        EXPECT_THAT(volume.error().text, HasSubstr("get the file again"));
        EXPECT_THAT(volume.error().text, HasSubstr("are left"));
    }
}

} // namespace
} // namespace voxtact::test
