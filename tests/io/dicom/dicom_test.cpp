// SPDX-License-Identifier: MIT
// DICOM series that are read: what is in them, and where it lies.
#include "dicom_writer.h"

#include <charls/charls.h>
#include <openjpeg.h>

#include <cmath>
#include <functional>
#include <random>

namespace voxtact::test {
namespace {

template <class Scalar> std::vector<Scalar> voxelsOf(const VolumeData& volume) {
    std::vector<Scalar> voxels(volume.voxels.size() / sizeof(Scalar));
    std::memcpy(voxels.data(), volume.voxels.data(), volume.voxels.size());
    return voxels;
}

/// The voxels of a series of ctSlice(), in the order of their places.
std::vector<std::int16_t> ctVoxels(int slices) {
    std::vector<std::int16_t> voxels;
    for (int slice = 0; slice < slices; ++slice) {
        for (const std::uint16_t word : ctWords(slice)) {
            voxels.push_back(static_cast<std::int16_t>(word));
        }
    }
    return voxels;
}

void expectCt(const Result<VolumeData>& volume, int slices) {
    ASSERT_TRUE(isOk(volume));
    EXPECT_EQ(volume->type, ScalarType::Int16);
    EXPECT_EQ(volume->grid.size, (std::array<std::uint32_t, 3>{kColumns, kRows, static_cast<std::uint32_t>(slices)}));
    EXPECT_EQ(volume->grid.spacing, (Vec3{0.5, 0.8, kGap}));
    EXPECT_EQ(volume->grid.origin, (Vec3{-10, 20, 5}));
    EXPECT_EQ(volume->grid.direction, (std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
    EXPECT_EQ(voxelsOf<std::int16_t>(*volume), ctVoxels(slices));
}

TEST(Dicom, EveryUncompressedSyntax) {
    for (const char* syntax : {kImplicit, kExplicit, kDeflated, kBigEndian, kGeBigPixels}) {
        SCOPED_TRACE(syntax);
        const TemporaryFolder folder;
        writeCt(folder, 3, syntax);
        const auto volume = io::readVolume(folder.path());
        expectCt(volume, 3);
        EXPECT_THAT(volume->notes, testing::ElementsAre("DICOM series of 3 slices, 2.5 mm apart"));
    }
}

TEST(Dicom, WithoutHeaderOrEnding) {
    for (const bool typed : {true, false}) {
        const TemporaryFolder folder;
        for (int i = 0; i < 3; ++i) {
            folder.write("IM" + std::to_string(i), ctSlice(i).body(typed));
        }
        expectCt(io::readVolume(folder.path()), 3);
    }
}

TEST(Dicom, OneOfSeveralSeries) {
    const TemporaryFolder folder;
    writeCt(folder, 3);
    for (int i = 0; i < 2; ++i) {
        folder.write("t" + std::to_string(i) + ".dcm", ctSlice(i).text(0x0020000E, "UI", "5.5.5").file());
    }
    expectCt(io::readVolume(folder.path(), {.frame = {}, .series = "1.2.3.4"}), 3);
    expectCt(io::readVolume(folder.path(), {.frame = {}, .series = "5.5.5"}), 2);
    expectRefused(io::readVolume(folder.path(), {.frame = 0, .series = "5.5.5"}), "no frame (0)", folder.path());
}

TEST(Dicom, OtherFilesBesideTheSlices) {
    const TemporaryFolder folder;
    writeCt(folder, 3);
    folder.write("README.txt", "not an image");
    folder.write("empty", "");
    folder.write("short", "\x08");
    DicomSet directory;
    directory.text(0x00041130, "CS", "DISC");
    std::string content = directory.file();
    content.replace(content.find("1.2.840.10008.5.1.4.1.1.2"), 25, "1.2.840.10008.1.3.10\0\0\0\0\0", 25);
    folder.write("DICOMDIR", content);
    DicomSet report;
    report.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.88.22").text(0x0020000E, "UI", "9.9");
    folder.write("report.dcm", report.file());
    std::filesystem::create_directory(folder / "below");
    std::filesystem::create_symlink("below", folder / "link");
    std::filesystem::create_symlink("somebody@somewhere.1234", folder / ".#README.txt");
    const auto volume = io::readVolume(folder.path());
    expectCt(volume, 3);
    EXPECT_THAT(volume->notes, testing::Contains("2 DICOM files without images left out"));
}

/// Names, numbers and the order in the folder say nothing: positions do. Rows along -z, columns along (0.6, 0.8, 0).
TEST(Dicom, ObliqueAndDescending) {
    const TemporaryFolder folder;
    const Vec3 across{0, 0, -1};
    const Vec3 down{0.6, 0.8, 0};
    const Vec3 normal{0.8, -0.6, 0}; // across x down
    for (int i = 0; i < 4; ++i) {
        std::string at;
        for (std::size_t k = 0; k < 3; ++k) {
            at += (k == 0 ? "" : "\\") + std::to_string(7 + normal[k] * 3 * i);
        }
        DicomSet set = ctSlice(i);
        set.text(0x00200032, "DS", at).text(0x00200037, "DS", "0\\0\\-1\\+0.6\\ 0.8 \\0");
        folder.write("z" + std::to_string(9 - i), set.file());
    }
    const auto volume = io::readVolume(folder.path());
    ASSERT_TRUE(isOk(volume));
    EXPECT_EQ(voxelsOf<std::int16_t>(*volume), ctVoxels(4));
    const Vec3 last = transformPoint(worldFromIndex(volume->grid), {4, 2, 3});
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(last[k], 7 + across[k] * 4 * 0.5 + down[k] * 2 * 0.8 + normal[k] * 9, 1e-5);
    }
}

/// CT in 12 bits: what overlays leave in the other bits is not part of the value.
TEST(Dicom, BitsThatAreNotStored) {
    const TemporaryFolder folder;
    for (int i = 0; i < 2; ++i) {
        DicomSet set = ctSlice(i);
        std::vector<std::uint16_t> words = ctWords(i);
        for (std::uint16_t& word : words) {
            word = static_cast<std::uint16_t>((word & 0x0FFFU) << 2U | 0xC003U);
        }
        set.number(0x00280101, 12).number(0x00280102, 13).words(0x7FE00010, words);
        folder.write("s" + std::to_string(i), set.file());
    }
    expectCt(io::readVolume(folder.path()), 2);
}

TEST(Dicom, BytesAndLongNumbers) {
    const TemporaryFolder bytes;
    const TemporaryFolder longs;
    for (int i = 0; i < 2; ++i) {
        std::string narrow;
        std::string wide;
        for (std::size_t k = 0; k < std::size_t{kColumns} * kRows; ++k) {
            append(narrow, static_cast<std::uint8_t>(20 * k + static_cast<std::size_t>(i)));
            append(wide, static_cast<std::int32_t>(k) * 100000 - i);
        }
        DicomSet set = ctSlice(i);
        set.number(0x00280100, 8).number(0x00280101, 8).number(0x00280102, 7).number(0x00280103, 0);
        set.bytes(0x7FE00010, narrow);
        bytes.write(std::to_string(i), set.file());
        bytes.write(std::to_string(i), set.file(kBigEndian)); // OB has no order
        set.number(0x00280100, 32).number(0x00280101, 32).number(0x00280102, 31).number(0x00280103, 1);
        longs.write(std::to_string(i), set.bytes(0x7FE00010, wide).file());
    }
    const auto narrow = io::readVolume(bytes.path());
    ASSERT_TRUE(isOk(narrow));
    EXPECT_EQ(narrow->type, ScalarType::UInt8);
    EXPECT_EQ(voxelsOf<std::uint8_t>(*narrow)[16], 21);
    const auto wide = io::readVolume(longs.path());
    ASSERT_TRUE(isOk(wide));
    EXPECT_EQ(wide->type, ScalarType::Float32);
    EXPECT_EQ(voxelsOf<float>(*wide)[29], 1399999);
}

/// PET: whole numbers in some slices only. Values are in real units in all of them.
TEST(Dicom, SlopesOfTheirOwn) {
    const TemporaryFolder folder;
    const std::array<double, 3> slopes{2, 0.5, 3};
    for (int i = 0; i < 3; ++i) {
        DicomSet set = ctSlice(i);
        set.text(0x00281053, "DS", std::to_string(slopes[static_cast<std::size_t>(i)])).text(0x00281052, "DS", "-4");
        folder.write(std::to_string(i), set.file());
    }
    const auto volume = io::readVolume(folder.path());
    ASSERT_TRUE(isOk(volume));
    ASSERT_EQ(volume->type, ScalarType::Float32);
    const std::vector<float> voxels = voxelsOf<float>(*volume);
    for (int i = 0; i < 3; ++i) {
        for (int row = 0; row < kRows; ++row) {
            for (int column = 0; column < kColumns; ++column) {
                EXPECT_EQ(voxels[static_cast<std::size_t>((i * kRows + row) * kColumns + column)],
                          slopes[static_cast<std::size_t>(i)] * ctValue(i, row, column) - 4);
            }
        }
    }
    EXPECT_THAT(volume->notes, testing::Contains("RescaleSlope differs from slice to slice (0.5 to 3); voxels are in "
                                                 "real units, as floats"));
}

TEST(Dicom, WholeRescalingStaysWhole) {
    const TemporaryFolder folder;
    for (int i = 0; i < 2; ++i) {
        DicomSet set = ctSlice(i);
        // 12 bits without sign, as most CT is stored.
        std::vector<std::uint16_t> words = ctWords(i);
        for (std::uint16_t& word : words) {
            word = static_cast<std::uint16_t>(word + 1024);
        }
        set.number(0x00280101, 12).number(0x00280102, 11).number(0x00280103, 0);
        set.text(0x00281052, "DS", "-1024").words(0x7FE00010, words);
        folder.write(std::to_string(i), set.file());
    }
    expectCt(io::readVolume(folder.path()), 2);
}

/// Magnetic resonance often says no rescaling at all.
TEST(Dicom, WithoutRescaling) {
    const TemporaryFolder folder;
    for (int i = 0; i < 2; ++i) {
        folder.write(std::to_string(i), ctSlice(i).remove(0x00281052).remove(0x00281053).file());
    }
    expectCt(io::readVolume(folder.path()), 2);
}

// Compressed ---------------------------------------------------------------------------------------------------------

constexpr unsigned kSide = 21;

/// A disc on a ramp: edges, even parts, all 12 bits.
std::vector<std::uint16_t> picture(int slice, unsigned bits) {
    std::vector<std::uint16_t> cells;
    const int most = (1 << bits) - 1;
    for (int y = 0; y < static_cast<int>(kSide); ++y) {
        for (int x = 0; x < static_cast<int>(kSide) - 1; ++x) {
            const bool inside = std::hypot(x - 9, y - 10) < 6;
            cells.push_back(static_cast<std::uint16_t>(inside ? most - slice : most * (x + y + slice) / 60));
        }
    }
    return cells;
}

DicomSet compressedSlice(int index, unsigned bits, std::vector<std::string> pieces) {
    DicomSet set = ctSlice(index);
    set.number(0x00280010, kSide).number(0x00280011, kSide - 1).number(0x00280103, 0);
    set.number(0x00280100, bits <= 8 ? 8 : 16).number(0x00280101, static_cast<std::uint16_t>(bits));
    set.number(0x00280102, static_cast<std::uint16_t>(bits - 1)).pieces(0x7FE00010, std::move(pieces));
    return set;
}

std::string jpegLsFrame(const std::vector<std::uint16_t>& cells, unsigned bits) {
    charls_jpegls_encoder* encoder = charls_jpegls_encoder_create();
    const charls_frame_info info{kSide - 1, kSide, static_cast<int>(bits), 1};
    std::string out(10000, '\0');
    std::size_t length = 0;
    EXPECT_EQ(charls_jpegls_encoder_set_frame_info(encoder, &info), charls_jpegls_errc::success);
    EXPECT_EQ(charls_jpegls_encoder_set_destination_buffer(encoder, out.data(), out.size()),
              charls_jpegls_errc::success);
    EXPECT_EQ(charls_jpegls_encoder_encode_from_buffer(encoder, cells.data(), cells.size() * 2, 0),
              charls_jpegls_errc::success);
    EXPECT_EQ(charls_jpegls_encoder_get_bytes_written(encoder, &length), charls_jpegls_errc::success);
    charls_jpegls_encoder_destroy(encoder);
    return out.substr(0, length);
}

std::string jpeg2000Frame(const std::vector<std::uint16_t>& cells, unsigned bits) {
    const TemporaryFolder folder;
    opj_cparameters_t parameters;
    opj_set_default_encoder_parameters(&parameters);
    parameters.numresolution = 3;
    parameters.tcp_numlayers = 1;
    parameters.cp_disto_alloc = 1;
    opj_image_cmptparm_t component{};
    component.dx = component.dy = 1;
    component.w = kSide - 1;
    component.h = kSide;
    component.prec = bits;
    opj_image_t* image = opj_image_create(1, &component, OPJ_CLRSPC_GRAY);
    image->x1 = kSide - 1;
    image->y1 = kSide;
    std::copy(cells.begin(), cells.end(), image->comps[0].data);
    opj_codec_t* codec = opj_create_compress(OPJ_CODEC_J2K);
    const std::string path = (folder / "a.j2k").string();
    opj_stream_t* stream = opj_stream_create_default_file_stream(path.c_str(), OPJ_FALSE);
    EXPECT_TRUE(opj_setup_encoder(codec, &parameters, image) && opj_start_compress(codec, image, stream) &&
                opj_encode(codec, stream) && opj_end_compress(codec, stream));
    opj_stream_destroy(stream);
    opj_destroy_codec(codec);
    opj_image_destroy(image);
    return contentOf(path);
}

struct Compressed {
    const char* name;
    const char* syntax;
    unsigned bits;
    int off; ///< how far pixels may be from what they were
    std::function<std::string(const std::vector<std::uint16_t>&)> frame;
};

std::vector<Compressed> compressions() {
    std::vector<Compressed> all{
        {"runs", kRle, 12, 0, [](const auto& cells) { return rleFrame(cells, false); }},
        {"literal", kRle, 12, 0, [](const auto& cells) { return rleFrame(cells, true); }},
        {"baseline", kJpegBaseline, 8, 1, [](const auto& cells) { return jpegFrame(cells, kSide - 1, 8, 0); }},
        {"extended", kJpegExtended, 12, 1, [](const auto& cells) { return jpegFrame(cells, kSide - 1, 12, 2); }},
        {"JPEG-LS", kJpegLs, 12, 0, [](const auto& cells) { return jpegLsFrame(cells, 12); }},
        {"JPEG 2000", kJpeg2000, 12, 0, [](const auto& cells) { return jpeg2000Frame(cells, 12); }}};
    for (unsigned predictor = 1; predictor <= 7; ++predictor) {
        all.push_back({"lossless", kJpegLossless, predictor % 2 == 0 ? 12U : 16U, 0, [predictor](const auto& cells) {
                           return jpegLosslessFrame(cells, kSide - 1, predictor % 2 == 0 ? 12 : 16, predictor,
                                                    predictor > 4 ? 2 : 0);
                       }});
    }
    return all;
}

TEST(DicomCompressed, PixelsComeBack) {
    for (const Compressed& compression : compressions()) {
        SCOPED_TRACE(std::string(compression.name) + " " + compression.syntax);
        const TemporaryFolder folder;
        for (int i = 0; i < 2; ++i) {
            const std::string frame = compression.frame(picture(i, compression.bits));
            // One piece, or the frame in two.
            const std::size_t half = i == 0 ? frame.size() : frame.size() / 4 * 2;
            std::vector<std::string> pieces{frame.substr(0, half)};
            if (half < frame.size()) {
                pieces.push_back(frame.substr(half));
            }
            folder.write(std::to_string(i),
                         compressedSlice(i, compression.bits, std::move(pieces)).file(compression.syntax));
        }
        const auto volume = io::readVolume(folder.path());
        ASSERT_TRUE(isOk(volume));
        const std::size_t pixels = picture(0, 8).size();
        for (std::size_t k = 0; k < 2 * pixels; ++k) {
            const int wanted = picture(k < pixels ? 0 : 1, compression.bits)[k % pixels];
            const int got = volume->type == ScalarType::UInt8 ? voxelsOf<std::uint8_t>(*volume)[k]
                                                              : voxelsOf<std::uint16_t>(*volume)[k];
            ASSERT_LE(std::abs(got - wanted), compression.off) << "pixel " << k;
        }
    }
}

/// Whatever is done to compressed data: one line, or pixels of that size; no print, no abort, little memory.
TEST(DicomCompressed, DamageIsRefusedOrHarmless) {
    const unsigned seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    testing::internal::CaptureStderr();
    for (const Compressed& compression : compressions()) {
        SCOPED_TRACE(compression.name);
        const TemporaryFolder folder;
        const std::string frame = compression.frame(picture(1, compression.bits));
        folder.write("0", compressedSlice(0, compression.bits, {compression.frame(picture(0, compression.bits))})
                              .file(compression.syntax));
        for (int round = 0; round < 60; ++round) {
            std::string damaged = frame.substr(0, round % 3 == 0 ? random() % frame.size() : frame.size());
            for (unsigned i = static_cast<unsigned>(random() % 4); i > 0 && !damaged.empty(); --i) {
                damaged[random() % damaged.size()] = static_cast<char>(random());
            }
            folder.write("1", compressedSlice(1, compression.bits, {damaged}).file(compression.syntax));
            const auto volume = io::readVolume(folder.path());
            if (!volume.ok()) {
                expectRefused(volume, "get the file again", folder / "1");
            }
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

// Enhanced multi-frame -----------------------------------------------------------------------------------------------

DicomSet macro(std::uint32_t sequence, const DicomSet& item) {
    return DicomSet().sequence(sequence, {item});
}

/// The slices of writeCt() in one file, the last one first.
DicomSet enhancedCt(int slices) {
    DicomSet file = ctSlice(0);
    std::vector<DicomSet> frames;
    std::vector<std::uint16_t> words;
    for (int i = slices - 1; i >= 0; --i) {
        frames.push_back(
            macro(0x00209113, DicomSet().text(0x00200032, "DS", "-10\\20\\" + std::to_string(5 + kGap * i))));
        const std::vector<std::uint16_t> more = ctWords(i);
        words.insert(words.end(), more.begin(), more.end());
    }
    DicomSet shared;
    shared.sequence(0x00209116, {DicomSet().text(0x00200037, "DS", "1\\0\\0\\0\\1\\0")})
        .sequence(0x00289110, {DicomSet().text(0x00280030, "DS", "0.8\\0.5")})
        .sequence(0x00289145, {DicomSet().text(0x00281052, "DS", "0").text(0x00281053, "DS", "1")});
    file.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.2.1").text(0x00280008, "IS", std::to_string(slices));
    file.remove(0x00200032).remove(0x00200037).remove(0x00280030).remove(0x00281052).remove(0x00281053);
    file.sequence(0x52009229, {shared}).sequence(0x52009230, frames).words(0x7FE00010, words);
    return file;
}

TEST(DicomEnhanced, IsReadByItsFunctionalGroups) {
    for (const char* syntax : {kImplicit, kExplicit, kDeflated, kBigEndian}) {
        const TemporaryFolder folder;
        folder.write("e.dcm", enhancedCt(4).file(syntax));
        expectCt(io::readVolume(folder.path()), 4);
    }
}

TEST(DicomEnhanced, CompressedFrames) {
    const TemporaryFolder folder;
    std::vector<std::string> pieces;
    for (int i = 2; i >= 0; --i) {
        pieces.push_back(rleFrame(ctWords(i), i == 1));
    }
    folder.write("e.dcm", enhancedCt(3).pieces(0x7FE00010, pieces).file(kRle));
    expectCt(io::readVolume(folder.path()), 3);
}

TEST(DicomEnhanced, Refusals) {
    const TemporaryFolder folder;
    const auto read = [&](const DicomSet& set) {
        folder.write("e.dcm", set.file());
        return io::readVolume(folder.path());
    };
    expectRefused(read(enhancedCt(4).remove(0x52009230)), "it holds 4 frames (multi-frame) and does not say where each "
                                                          "lies (PerFrameFunctionalGroupsSequence)");
    expectRefused(read(enhancedCt(4).text(0x00280008, "IS", "3").words(0x7FE00010, std::vector<std::uint16_t>(45))),
                  "it holds 3 frames and says of 4 where they lie");
    expectRefused(read(enhancedCt(4).text(0x00280008, "IS", "3")),
                  "its pixels take 120 bytes, which is not 5 columns x "
                  "3 rows x 3 frames x 2 bytes");
    expectRefused(read(enhancedCt(4).remove(0x52009229)), "frame 1: it has no ImageOrientationPatient (0020,0037)");
    expectRefused(read(enhancedCt(1)), "fewer than 2 slices");
    folder.write("again.dcm", enhancedCt(4).text(0x00080018, "UI", "1.9").file());
    expectRefused(read(enhancedCt(4)), "frame 4 of 'again.dcm' and frame 4 of 'e.dcm' are at the same place (5 mm)");
}

} // namespace
} // namespace voxtact::test
