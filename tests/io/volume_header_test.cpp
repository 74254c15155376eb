// SPDX-License-Identifier: MIT
// What headers of NRRD, MetaImage and NIfTI say beside the usual: it is used, noted, or refused by its name.
#include "io_test_support.h"

namespace voxtact::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

const std::string kNrrd = "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: 4 5 6\n"
                          "space directions: (2,0,0) (0,3,0) (0,0,4)\nkinds: domain domain domain\nendian: little\n"
                          "encoding: raw\nspace origin: (-10,-20,-30)\n";
const std::string kMeta = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
                          "TransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = -10 -20 -30\nElementSpacing = 2 3 4\n"
                          "DimSize = 4 5 6\nElementType = MET_SHORT\nElementDataFile = ";

std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

/// 0 to 119, from the `first`-th.
std::string voxels(int first = 0, int count = 120) {
    std::string bytes;
    for (int i = first; i < first + count; ++i) {
        append(bytes, static_cast<std::int16_t>(i));
    }
    return bytes;
}

std::string inText() {
    std::string text;
    for (int i = 0; i < 120; ++i) {
        text += std::to_string(i) + (i % 7 == 6 ? "\n" : " ");
    }
    return text + "\n";
}

/// 4 x 5 x 6 voxels from 0 to 119, 2 x 3 x 4 mm.
void expectUsual(const Result<VolumeData>& volume, std::array<double, 3> spacing = {2, 3, 4}) {
    ASSERT_TRUE(isOk(volume));
    EXPECT_EQ(volume->grid.size, (std::array<std::uint32_t, 3>{4, 5, 6}));
    EXPECT_EQ(volume->grid.spacing, (Vec3{spacing[0], spacing[1], spacing[2]}));
    ASSERT_EQ(volume->type, ScalarType::Int16);
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(volume->voxels.data()), volume->voxels.size()), voxels());
}

TEST(VolumeHeader, DataThatIsNotStatedIsNoted) {
    const TemporaryFolder folder;
    const auto more = Contains(HasSubstr("40 bytes follow the voxels that the header states"));
    folder.write("raw", voxels() + std::string(40, '\1'));
    NiftiFile nifti;
    const std::string zipped = compressed(voxels() + std::string(40, '\1'), Wrapping::Zlib);
    for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{
             {"v.nhdr", kNrrd + "data file: raw\n"},
             {"v.nrrd", kNrrd + "\n" + voxels() + std::string(40, '\1')},
             {"v.mhd", kMeta + "raw\n"},
             {"v.mha", "CompressedData = True\n" + kMeta + "LOCAL\n" + zipped}}) {
        const auto volume = io::readVolume(folder.write(name, content));
        expectUsual(volume);
        EXPECT_THAT(volume->notes, more) << name;
    }
    nifti.voxels += std::string(40, '\1');
    EXPECT_THAT(io::readVolume(folder.write("v.nii", nifti.bytes()))->notes, more);
    // What is not read of a file with several images is no more than it states.
    nifti.sizes = {4, 3, 2, 2};
    nifti.voxels = std::string(48, '\1');
    EXPECT_TRUE(io::readVolume(folder.write("v.nii", nifti.bytes()), {.frame = 0})->notes.empty());
    nifti.voxels += std::string(40, '\1');
    EXPECT_THAT(io::readVolume(folder.write("v.nii", nifti.bytes()), {.frame = 0})->notes, more);
    // Nothing follows where the voxels are the end of the file.
    folder.write("behind", std::string(40, '\1') + voxels());
    const auto end = io::readVolume(folder.write("v.nhdr", kNrrd + "byte skip: -1\ndata file: behind\n"));
    expectUsual(end);
    EXPECT_TRUE(end->notes.empty());
}

TEST(VolumeHeader, AxesOfANrrdThatAreNotInSpace) {
    const TemporaryFolder folder;
    const auto read = [&](const std::string& header) {
        return io::readVolume(folder.write("v.nrrd", header + "\n" + voxels()));
    };
    for (const char* kind : {"stub", "list", "none", "???"}) {
        const std::string four = with(with(with(kNrrd, "dimension: 3", "dimension: 4"), "sizes: 4", "sizes: 1 4"),
                                      "(2,0,0)", "none (2,0,0)");
        expectUsual(read(with(four, "kinds: ", std::string("kinds: ") + kind + " ")));
    }
    // Without a space, all that an axis says goes with it.
    const std::string plain = "NRRD0004\ntype: short\ndimension: 5\nsizes: 4 1 5 6 1\n"
                              "kinds: domain list domain domain stub\nendian: little\nencoding: raw\n"
                              "spacings: 2 nan 3 4 nan\naxis mins: 1 nan 2 3 nan\ncenterings: node ??? cell node ???\n"
                              "units: \"mm\" \"s\" \"mm\" \"mm\" \"\"\n";
    const auto volume = read(plain);
    expectUsual(volume);
    EXPECT_EQ(volume->grid.origin, (Vec3{1, 3.5, 3}));
    expectRefused(read(with(plain, "4 1 5 6 1", "2 2 5 6 1")), "(axis 1 is 'list')");
}

TEST(VolumeHeader, NumbersOfANrrdThatAreNotKnown) {
    const TemporaryFolder folder;
    const auto read = [&](const std::string& fields) {
        return io::readVolume(folder.write("v.nrrd", "NRRD0004\ntype: short\ndimension: 3\nsizes: 4 5 6\n"
                                                     "endian: little\nencoding: raw\n" +
                                                         fields + "\n" + voxels()));
    };
    const auto unknown = read("spacings: 2 3 4\naxis mins: nan NaN nan\n");
    expectUsual(unknown);
    EXPECT_THAT(unknown->notes, Contains(HasSubstr("does not say where its first voxel is")));
    const auto one = read("spacings: NaN 3 4\n");
    expectUsual(one, {1, 3, 4});
    EXPECT_THAT(one->notes, Contains("the file does not say its spacing along axis 0; 1 mm is taken"));
    // What is taken where nothing is said is in millimetres, whatever the rest is in.
    expectUsual(read("spacings: NaN 0.003 0.004\nunits: \"m\" \"m\" \"m\"\n"), {1, 3, 4});
    expectUsual(read("spacings: NaN 3 4\naxis mins: 0 0 0\naxis maxs: 8 15 24\n"));
    expectRefused(read("spacings: nanx 3 4\n"), "header is damaged ('spacings'");
    const auto origin =
        io::readVolume(folder.write("v.nrrd", with(kNrrd, "(-10,-20,-30)", "(nan,nan,nan)") + "\n" + voxels()));
    expectUsual(origin);
    EXPECT_THAT(origin->notes, Contains(HasSubstr("does not say where its first voxel is")));
    expectRefused(io::readVolume(folder.write("v.nrrd", with(kNrrd, "(-10,-20,-30)", "(nan,0,0)") + "\n" + voxels())),
                  "header is damaged ('space origin'");
    EXPECT_THAT(read("spacings: 2 3 4\naxis mins: 0 0 0\nold min: -5\n")->notes, Contains(HasSubstr("'old min'")));
}

TEST(VolumeHeader, VoxelsAsText) {
    const TemporaryFolder folder;
    const std::string nrrd = with(with(kNrrd, "raw", "ascii"), "endian: little\n", "");
    const std::string meta =
        with(with(kMeta, "BinaryData = True", "BinaryData = False"), "Offset", "Comment = \nOffset");
    for (const auto& [name, head] : {std::pair{"v.nrrd", nrrd + "\n"}, std::pair{"v.mha", meta + "LOCAL\n"}}) {
        const auto whole = io::readVolume(folder.write(name, head + inText()));
        expectUsual(whole);
        EXPECT_TRUE(whole->notes.empty()) << whole->notes[0];
        // A number that is cut is a number.
        const auto open = io::readVolume(folder.write(name, head + inText().substr(0, inText().size() - 2)));
        ASSERT_TRUE(isOk(open));
        EXPECT_THAT(open->notes, Contains(HasSubstr("ends in a number and not in a line end")));
        EXPECT_THAT(io::readVolume(folder.write(name, head + inText() + "1 2\n"))->notes,
                    Contains(HasSubstr("3 bytes")));
        expectRefused(io::readVolume(folder.write(name, head + inText().substr(0, 60))), "of 120 voxels");
        for (const char* bad : {"1e3", "70000", "1,5", "-", "nan"}) {
            expectRefused(io::readVolume(folder.write(name, head + bad + (" " + inText()))),
                          "voxel 0 is '" + std::string(bad) + "'");
        }
    }
    const auto real =
        io::readVolume(folder.write("v.nrrd", "NRRD0004\ntype: float\ndimension: 3\nsizes: 1 2 2\nencoding: text\n\n"
                                              "1.5 -2e3 +.25\t7\n"));
    ASSERT_TRUE(isOk(real));
    float last = 0;
    std::memcpy(&last, real->voxels.data() + 8, sizeof last);
    EXPECT_EQ(last, 0.25F);
}

TEST(VolumeHeader, VoxelsInSeveralFiles) {
    const TemporaryFolder folder;
    for (int slice = 0; slice < 6; ++slice) {
        folder.write("s" + std::to_string(slice) + ".raw", voxels(20 * slice, 20));
        folder.write("s0" + std::to_string(slice) + ".gz", compressed(voxels(20 * slice, 20), Wrapping::Gzip));
    }
    folder.write("low", voxels(0, 60));
    folder.write("high", voxels(60, 60));
    const std::string list = "s0.raw\ns1.raw\ns2.raw\ns3.raw\ns4.raw\ns5.raw\n";
    for (const auto& [name, content] : std::vector<std::pair<std::string, std::string>>{
             {"v.nhdr", kNrrd + "data file: LIST\n" + list},
             {"v.nhdr", kNrrd + "data file: LIST 3\nlow\nhigh\n"},
             {"v.nhdr", kNrrd + "data file: s%d.raw 0 5 1\n"},
             {"v.nhdr", with(kNrrd, "raw", "gzip") + "datafile: s%02d.gz 0 5 1 2\n"},
             {"v.mhd", kMeta + "LIST\n" + list},
             {"v.mhd", kMeta + "LIST 3D\nlow\nhigh"},
             {"v.mhd", kMeta + "s%1d.raw 0 5 1\n"}}) {
        const auto volume = io::readVolume(folder.write(name, content));
        expectUsual(volume);
        EXPECT_TRUE(volume->notes.empty()) << content;
    }
    // Backwards is backwards.
    const auto turned = io::readVolume(folder.write("v.mhd", kMeta + "s%d.raw 5 0 -1\n"));
    ASSERT_TRUE(isOk(turned));
    EXPECT_EQ(turned->voxels[0], std::byte{100});
    folder.write("s3.raw", voxels(60, 20) + "more");
    EXPECT_THAT(io::readVolume(folder.write("v.mhd", kMeta + "LIST\n" + list))->notes,
                testing::ElementsAre(HasSubstr("4 bytes follow")));
    folder.write("s3.raw", voxels(60, 19));
    expectRefused(io::readVolume(folder.write("v.mhd", kMeta + "LIST\n" + list)), "s3.raw': it is truncated");
    expectRefused(io::readVolume(folder.write("v.mhd", kMeta + "LIST\n" + list.substr(7))),
                  "its voxels are in 5 files, its 6 slices cannot be spread over them evenly");
    expectRefused(io::readVolume(folder.write("v.mhd", kMeta + "LIST\n")), "lists no file of voxels");
    expectRefused(io::readVolume(folder.write("v.nhdr", kNrrd + "data file: LIST\nabsent\ns0.raw\n")),
                  "absent': there is no such file");
    for (const char* bad :
         {"s%s.raw 0 5 1", "s%d.raw", "s%d.raw 0 x 1", "s%d.raw 0 5 0", "s%d.raw 5 0 1", "s%d%d.raw 0 5 1", "%",
          "s%99999d.raw 0 5 1", "s%d.raw -1 5 1", "s%d.raw 0 9999999 1", "s%d.raw 0 5 -9223372036854775808"}) {
        expectRefused(io::readVolume(folder.write("v.nhdr", kNrrd + "data file: " + bad + "\n")), "is no pattern");
        expectRefused(io::readVolume(folder.write("v.mhd", kMeta + bad + "\n")), "is no pattern");
    }
}

TEST(VolumeHeader, AMetaImageWithColons) {
    const TemporaryFolder folder;
    std::string colons = kMeta;
    for (std::size_t at = colons.find(" ="); at != std::string::npos; at = colons.find(" =")) {
        colons.replace(at, 2, ":");
    }
    expectUsual(io::readVolume(folder.write("v.mha", colons + "LOCAL\n" + voxels())));
    const auto mixed =
        io::readVolume(folder.write("v.mha", "Comment = a: b\nName: c = d\n" + kMeta + "LOCAL\n" + voxels()));
    expectUsual(mixed);
}

TEST(VolumeHeader, AxesOfANiftiThatAreNotUsed) {
    const TemporaryFolder folder;
    NiftiFile nifti;
    nifti.sizes = {4, 3, 2, 0, 0};
    const auto volume = io::readVolume(folder.write("v.nii", nifti.bytes()));
    ASSERT_TRUE(isOk(volume));
    EXPECT_EQ(volume->grid.size, (std::array<std::uint32_t, 3>{4, 3, 2}));
    EXPECT_THAT(volume->notes,
                testing::ElementsAre("the file's dim[4] is 0; 1 is taken", "the file's dim[5] is 0; 1 is "
                                                                           "taken"));
}

TEST(VolumeHeader, LabelsThatFloatsDoNotHold) {
    const TemporaryFolder folder;
    const auto write = [&](const char* type, const std::string& bytes) {
        return folder.write("l.nrrd", std::string("NRRD0004\ntype: ") + type +
                                          "\ndimension: 3\nspace: LPS\nsizes: 1 1 3\nspace directions: (1,0,0) (0,1,0) "
                                          "(0,0,1)\nendian: little\nencoding: raw\nspace origin: (0,0,0)\n\n" +
                                          bytes);
    };
    const auto bytesOf = [](auto... labels) {
        std::string bytes;
        (append(bytes, labels), ...);
        return bytes;
    };
    const auto expectLabels = [](const Result<io::LabelFile>& file, std::int32_t least, std::int32_t most) {
        ASSERT_TRUE(isOk(file));
        EXPECT_THAT(file->labels.values, testing::ElementsAre(std::min(least, 0), std::max(least, 0), most));
        EXPECT_EQ(file->labels.values[file->labels.indices[2]], most);
    };
    const auto path = write("unsigned int", bytesOf(0U, 16777217U, 614454277U));
    expectRefused(io::readVolume(path), "voxel (0, 0, 1) is 16777217");
    expectLabels(io::readLabels(path), 16777217, 614454277);
    expectLabels(io::readLabels(write("int64", bytesOf(std::int64_t{0}, std::int64_t{-2147483647}, std::int64_t{5}))),
                 -2147483647, 5);
    expectLabels(io::readLabels(write("double", bytesOf(0.0, 16777217.0, 2147483647.0))), 16777217, 2147483647);
    expectLabels(io::readLabels(write("short", bytesOf(std::int16_t{0}, std::int16_t{7}, std::int16_t{9}))), 7, 9);
    expectRefused(io::readLabels(write("unsigned int", bytesOf(0U, 1U, 2147483648U))),
                  "voxel (0, 0, 2) is 2147483648, a label is a whole number that an int32 holds");
    expectRefused(io::readLabels(write("double", bytesOf(0.0, 1.5, 2.0))), "voxel (0, 0, 1) is 1.5");
    expectRefused(io::readLabels(write("float", bytesOf(0.0F, 1.5F, 2.0F))),
                  "as a label map: voxel (0, 0, 1) of the label map is 1.5");
    expectRefused(io::readLabels(folder / "absent.nii"), "there is no such file");
}

} // namespace
} // namespace voxtact::test
