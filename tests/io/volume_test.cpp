// SPDX-License-Identifier: MIT
#include "io_test_support.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <thread>

namespace voxtact::test {
namespace {

Grid plainGrid() {
    Grid grid;
    grid.size = {7, 5, 4};
    return grid;
}

/// Turned about two axes, anisotropic, far from the origin.
Grid obliqueGrid() {
    Grid grid;
    grid.size = {7, 5, 4};
    grid.spacing = {0.7, 1.25, 3.1};
    grid.origin = {-123.456789, 78.9, 1011.121314};
    const double a = 0.3;
    const double b = -0.8;
    grid.direction = {std::cos(a),
                      std::sin(a) * std::cos(b),
                      std::sin(a) * std::sin(b),
                      -std::sin(a),
                      std::cos(a) * std::cos(b),
                      std::cos(a) * std::sin(b),
                      0,
                      -std::sin(b),
                      std::cos(b)};
    return grid;
}

Grid leftHandedGrid() {
    Grid grid = obliqueGrid();
    for (std::size_t i = 6; i < 9; ++i) {
        grid.direction[i] = -grid.direction[i];
    }
    return grid;
}

template <class Scalar> VolumeData ramp(const Grid& grid, ScalarType type, double lo, double step) {
    VolumeData volume;
    volume.grid = grid;
    volume.type = type;
    std::string bytes;
    for (std::uint64_t i = 0; i < voxelCount(grid); ++i) {
        append(bytes, static_cast<Scalar>(lo + step * static_cast<double>(i)));
    }
    volume.voxels.resize(bytes.size());
    std::memcpy(volume.voxels.data(), bytes.data(), bytes.size());
    return volume;
}

VolumeData volumeOf(const Grid& grid, ScalarType type) {
    switch (type) {
    case ScalarType::UInt8:
        return ramp<std::uint8_t>(grid, type, 0, 1);
    case ScalarType::Int16:
        return ramp<std::int16_t>(grid, type, -32768, 400);
    case ScalarType::UInt16:
        return ramp<std::uint16_t>(grid, type, 100, 460);
    case ScalarType::Float32:
        break;
    }
    return ramp<float>(grid, type, -1.5e-3, 0.1);
}

void expectSameGrid(const Grid& read, const Grid& written, double tolerance) {
    EXPECT_EQ(read.size, written.size);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(read.spacing[i], written.spacing[i], tolerance);
        EXPECT_NEAR(read.origin[i], written.origin[i], tolerance * std::max(1.0, std::abs(written.origin[i])));
    }
    for (std::size_t i = 0; i < 9; ++i) {
        EXPECT_NEAR(read.direction[i], written.direction[i], tolerance);
    }
}

using RoundTripCase = std::tuple<ScalarType, std::string, int>;
class RoundTrip : public testing::TestWithParam<RoundTripCase> {};

TEST_P(RoundTrip, KeepsVoxelsAndPlace) {
    const auto& [type, ending, which] = GetParam();
    const TemporaryFolder folder;
    const VolumeData written = volumeOf(which == 0 ? plainGrid() : which == 1 ? obliqueGrid() : leftHandedGrid(), type);
    const auto path = folder / ("v" + ending);
    ASSERT_TRUE(isOk(io::writeVolume(path, written.view())));
    EXPECT_EQ(folder.entries(), 1U);
    const auto read = io::readVolume(path);
    ASSERT_TRUE(isOk(read));
    EXPECT_EQ(read->type, type);
    EXPECT_EQ(read->voxels, written.voxels);
    EXPECT_EQ(read->name, "v" + ending);
    EXPECT_THAT(read->notes, testing::IsEmpty());
    // NIfTI holds the matrix in single precision (24 bits: 6e-8 relative, a few times through the products).
    const bool isNifti = ending.starts_with(".nii");
    expectSameGrid(read->grid, written.grid, isNifti ? 1e-6 : 1e-14);
}

std::string caseName(const testing::TestParamInfo<RoundTripCase>& tested) {
    const auto& [type, ending, which] = tested.param;
    std::string name = toString(type) + ending + (which == 0 ? "_plain" : which == 1 ? "_oblique" : "_leftHanded");
    std::replace(name.begin(), name.end(), '.', '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(
    Volume, RoundTrip,
    testing::Combine(testing::Values(ScalarType::UInt8, ScalarType::Int16, ScalarType::UInt16, ScalarType::Float32),
                     testing::Values(".nii", ".nii.gz", ".nrrd", ".mha"), testing::Values(0, 1, 2)),
    caseName);

TEST(Volume, NiftiIsTurnedFromRasToLps) {
    const TemporaryFolder folder;
    NiftiFile nifti;
    nifti.spacing = {2, 3, 4};
    // +i is anterior, +j is right, +k is superior.
    nifti.sform = {0, 3, 0, 10, 2, 0, 0, 20, 0, 0, 4, 30};
    const auto volume = io::readVolume(folder.write("v.nii", nifti.bytes()));
    ASSERT_TRUE(isOk(volume));
    EXPECT_EQ(volume->grid.size, (std::array<std::uint32_t, 3>{4, 3, 2}));
    EXPECT_EQ(volume->grid.origin, (Vec3{-10, -20, 30}));
    EXPECT_THAT(volume->grid.spacing, testing::Pointwise(testing::DoubleEq(), Vec3{2, 3, 4}));
    const Vec3 voxel = transformPoint(worldFromIndex(volume->grid), {1, 1, 1});
    EXPECT_NEAR(voxel[0], -13, 1e-5);
    EXPECT_NEAR(voxel[1], -22, 1e-5);
    EXPECT_NEAR(voxel[2], 34, 1e-5);
    EXPECT_THAT(volume->notes, testing::IsEmpty());
}

TEST(Volume, NiftiPairByEitherName) {
    const TemporaryFolder folder;
    NiftiFile nifti;
    std::string header = nifti.bytes().substr(0, 348);
    header.replace(344, 4, std::string("ni1\0", 4));
    const float offset = 0;
    std::memcpy(header.data() + 108, &offset, sizeof offset);
    folder.write("v.hdr", header);
    folder.write("v.img", nifti.voxels);
    for (const char* name : {"v.hdr", "v.img"}) {
        const auto volume = io::readVolume(folder / name);
        ASSERT_TRUE(isOk(volume));
        EXPECT_EQ(volume->voxels, std::vector<std::byte>(24, std::byte{7}));
    }
    folder.write("v.img", nifti.voxels.substr(1));
    expectRefused(io::readVolume(folder / "v.hdr"), "v.img': it is truncated: its voxels take 24 bytes, 23 are there");
    std::filesystem::remove(folder / "v.img");
    expectRefused(io::readVolume(folder / "v.hdr"), "v.img': there is no such file");
}

TEST(Volume, FourDimensionsWithOneImage) {
    const TemporaryFolder folder;
    NiftiFile nifti;
    nifti.sizes = {4, 3, 2, 1};
    const auto volume = io::readVolume(folder.write("v.nii", nifti.bytes()));
    ASSERT_TRUE(isOk(volume));
    EXPECT_EQ(volume->grid.size, (std::array<std::uint32_t, 3>{4, 3, 2}));
}

TEST(Volume, NiftiSlopeIsApplied) {
    const TemporaryFolder folder;
    NiftiFile nifti;
    nifti.slope = 0.5F;
    const auto volume = io::readVolume(folder.write("v.nii", nifti.bytes()));
    ASSERT_TRUE(isOk(volume));
    EXPECT_EQ(volume->type, ScalarType::Float32);
    EXPECT_EQ(checkVolume(volume->view())->hi, 3.5);
}

std::string nrrd(const std::string& space, const std::string& encoding, const std::string& voxels) {
    return "NRRD0004\ntype: uint8\ndimension: 3\n" + (space.empty() ? "" : "space: " + space + "\n") +
           "sizes: 4 3 2\nspace directions: (0,2,0) (3,0,0) (0,0,4)\nkinds: domain domain domain\nendian: little\n"
           "encoding: " +
           encoding + "\nspace origin: (10,20,30)\n\n" + voxels;
}

TEST(Volume, NrrdSpaces) {
    const TemporaryFolder folder;
    const std::string voxels(24, '\1');
    struct Case {
        const char* space;
        Vec3 origin;
        Vec3 second; ///< voxel (1, 1, 1)
    };
    for (const Case& known : {Case{"right-anterior-superior", {-10, -20, 30}, {-13, -22, 34}},
                              Case{"left-anterior-superior", {10, -20, 30}, {13, -22, 34}},
                              Case{"left-posterior-superior", {10, 20, 30}, {13, 22, 34}}}) {
        for (const bool zipped : {false, true}) {
            const auto volume =
                io::readVolume(folder.write("v.nrrd", nrrd(known.space, zipped ? "gzip" : "raw",
                                                           zipped ? compressed(voxels, Wrapping::Gzip) : voxels)));
            ASSERT_TRUE(isOk(volume)) << known.space;
            EXPECT_EQ(volume->grid.origin, known.origin) << known.space;
            EXPECT_EQ(transformPoint(worldFromIndex(volume->grid), {1, 1, 1}), known.second) << known.space;
            EXPECT_EQ(volume->voxels, std::vector<std::byte>(24, std::byte{1}));
        }
    }
}

TEST(Volume, NrrdSpacesThatAreUnknown) {
    const TemporaryFolder folder;
    const std::string voxels(24, '\1');
    const auto volume = io::readVolume(folder.write("v.nrrd", nrrd("3D-right-handed", "raw", voxels)));
    ASSERT_TRUE(isOk(volume));
    EXPECT_EQ(volume->grid.origin, (Vec3{10, 20, 30}));
    EXPECT_THAT(volume->notes, testing::ElementsAre(testing::HasSubstr("does not say how the patient lies")));
}

TEST(Volume, MetaImageCompressedAndDetached) {
    const TemporaryFolder folder;
    const std::string voxels(24, '\5');
    const std::string zipped = compressed(voxels, Wrapping::Zlib);
    const std::string head = "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n";
    const std::string tail = "DimSize = 4 3 2\nElementType = MET_UCHAR\nElementDataFile = ";
    folder.write("z.mha", head + "CompressedData = True\nCompressedDataSize = " + std::to_string(zipped.size()) + "\n" +
                              tail + "LOCAL\n" + zipped);
    folder.write("d.mhd", head + tail + "d.raw\n");
    folder.write("d.raw", voxels);
    for (const char* name : {"z.mha", "d.mhd"}) {
        const auto volume = io::readVolume(folder / name);
        ASSERT_TRUE(isOk(volume));
        EXPECT_EQ(volume->voxels, std::vector<std::byte>(24, std::byte{5}));
    }
}

/// Without a space: from `axis mins` on.
std::string plainNrrd(const std::string& fields) {
    return "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n" + fields + "\n" + std::string(24, '\1');
}

TEST(Volume, WhatANrrdHeaderDoesNotSayIsNoted) {
    using testing::ElementsAre;
    using testing::HasSubstr;
    const TemporaryFolder folder;
    const auto lies = HasSubstr("how the patient lies");
    const auto notesOf = [&](const std::string& fields) {
        return io::readVolume(folder.write("v.nrrd", plainNrrd(fields))).value().notes;
    };
    EXPECT_THAT(notesOf(""), ElementsAre(lies, HasSubstr("its spacing"), HasSubstr("where its first voxel is")));
    EXPECT_THAT(notesOf("spacings: 1 2 3\n"), ElementsAre(lies, HasSubstr("where its first voxel is")));
    EXPECT_THAT(notesOf("spacings: 1 2 3\naxis mins: 1 2 3\n"), ElementsAre(lies, HasSubstr("'centerings'")));
    EXPECT_THAT(notesOf("spacings: 1 2 3\naxis mins: 1 2 3\ncenterings: cell cell ???\n"),
                ElementsAre(lies, HasSubstr("'centerings'")));
    EXPECT_THAT(notesOf("spacings: 1 2 3\naxis mins: 1 2 3\ncenterings: cell node cell\n"), ElementsAre(lies));
}

TEST(Volume, TheFirstVoxelOfANrrdIsAtItsAxesMins) {
    const TemporaryFolder folder;
    const auto originOf = [&](const std::string& fields) {
        return io::readVolume(folder.write("v.nrrd", plainNrrd(fields))).value().grid.origin;
    };
    const std::string mins = "axis mins: 10 20 30\n";
    EXPECT_EQ(originOf("spacings: 1 2 4\n" + mins), (Vec3{10.5, 21, 32}));
    EXPECT_EQ(originOf("spacings: 1 2 4\ncenterings: node cell node\n" + mins), (Vec3{10, 21, 30}));
    EXPECT_EQ(originOf(mins), (Vec3{10.5, 20.5, 30.5})) << "1 mm is taken";
}

TEST(Volume, TheSpacingOfANrrdIsThatOfItsAxesIfItSaysNoOther) {
    using testing::Contains;
    using testing::HasSubstr;
    const TemporaryFolder folder;
    const auto read = [&](const std::string& fields) {
        return io::readVolume(folder.write("v.nrrd", plainNrrd("axis mins: 10 20 30\n" + fields))).value();
    };
    const VolumeData cells = read("axis maxs: 14 26 38\ncenterings: cell cell cell\n");
    EXPECT_EQ(cells.grid.spacing, (Vec3{1, 2, 4}));
    EXPECT_EQ(cells.grid.origin, (Vec3{10.5, 21, 32}));
    EXPECT_THAT(cells.notes, Contains(HasSubstr("what 'axis mins' and 'axis maxs' say of it is taken")));
    const VolumeData nodes = read("axis maxs: 13 24 34\ncenterings: node node node\n");
    EXPECT_EQ(nodes.grid.spacing, (Vec3{1, 2, 4}));
    EXPECT_EQ(nodes.grid.origin, (Vec3{10, 20, 30}));
    const auto contradicts = Contains(HasSubstr("do not fit its 'spacings'"));
    EXPECT_THAT(read("axis maxs: 14 26 38\nspacings: 1 2 4\n").notes, Not(contradicts));
    const VolumeData other = read("axis maxs: 14 26 38\nspacings: 1 2 5\n");
    EXPECT_THAT(other.notes, contradicts);
    EXPECT_EQ(other.grid.spacing, (Vec3{1, 2, 5}));
    EXPECT_EQ(read("axis maxs: 10 26 38\n").grid.spacing, (Vec3{1, 2, 4})) << "they say nothing of the first axis";
}

TEST(Volume, ANrrdsSpaceHasThreeDimensions) {
    const TemporaryFolder folder;
    const auto read = [&](const std::string& fields) {
        return io::readVolume(folder.write("v.nrrd", plainNrrd(fields)));
    };
    const std::string directions = "space directions: (1,0,0,0) (0,1,0,0) (0,0,1,0)\n";
    for (const char* space : {"left-posterior-superior-time", "LPST", "scanner-xyz-time"}) {
        expectRefused(read(std::string("space: ") + space + "\n" + directions), "its space has time, too");
    }
    expectRefused(read("space dimension: 4\n" + directions), "its space has 4 dimensions");
    EXPECT_TRUE(read("space dimension: 3\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n").ok());
}

/// One image is there, and no series.
TEST(Volume, OneImageOfAFileThatHoldsOne) {
    const TemporaryFolder folder;
    const std::filesystem::path path = folder.write("v.nrrd", plainNrrd("spacings: 1 2 3\n"));
    EXPECT_TRUE(isOk(io::readVolume(path, {.frame = 0})));
    expectRefused(io::readVolume(path, {.frame = 1}), "it has no frame 1: it holds 1 image", path);
    expectRefused(io::readVolume(path, {.frame = {}, .series = "1.2.3"}),
                  "no folder that holds the DICOM series '1.2.3'", path);
}

TEST(Volume, LengthsAreMillimetres) {
    using testing::Contains;
    using testing::HasSubstr;
    const TemporaryFolder folder;
    const auto nrrd = [&](const std::string& unit) {
        const std::string quoted = '"' + unit + '"';
        return io::readVolume(folder.write("v.nrrd", plainNrrd("space: LPS\nspace directions: (1,0,0) (0,2,0) (0,0,3)\n"
                                                               "space origin: (4,5,6)\nspace units: " +
                                                               quoted + " " + quoted + " " + quoted + "\n")))
            .value();
    };
    const auto meta = [&](const std::string& unit) {
        return io::readVolume(folder.write("v.mha", "NDims = 3\nOffset = 4 5 6\nElementSpacing = 1 2 3\n"
                                                    "TransformMatrix = 1 0 0 0 1 0 0 0 1\nDistanceUnits = " +
                                                        unit + "\nDimSize = 4 3 2\nElementType = MET_UCHAR\n" +
                                                        "ElementDataFile = LOCAL\n" + std::string(24, '\1')))
            .value();
    };
    const std::map<std::string, double> units{{"mm", 1},      {"Millimeter", 1},    {"cm", 10},        {"m", 1000},
                                              {"um", 1e-3},   {"\xC2\xB5m", 1e-3},  {"microns", 1e-3}, {"nm", 1e-6},
                                              {"inch", 25.4}, {"micrometer", 1e-3}, {"?", 1}};
    for (const auto& [unit, millimetres] : units) {
        for (const VolumeData& volume : {nrrd(unit), meta(unit)}) {
            SCOPED_TRACE(unit);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                EXPECT_DOUBLE_EQ(volume.grid.spacing[axis], static_cast<double>(axis + 1) * millimetres);
                EXPECT_DOUBLE_EQ(volume.grid.origin[axis], static_cast<double>(axis + 4) * millimetres);
            }
            EXPECT_EQ(volume.notes.size(), millimetres == 1 ? 0U : 1U);
        }
    }
    // An axis of another kind, and what is taken where no spacing is said.
    const VolumeData other =
        io::readVolume(folder.write("v.nrrd", plainNrrd("spacings: 1 2 3\nunits: \"cm\" \"cm\" \"CM\"\n"))).value();
    EXPECT_EQ(other.grid.spacing, (Vec3{10, 20, 30}));
    const VolumeData mixed =
        io::readVolume(folder.write("v.nrrd", plainNrrd("spacings: 1 2 3\nunits: \"mm\" \"mm\" \"s\"\n"))).value();
    EXPECT_EQ(mixed.grid.spacing, (Vec3{1, 2, 3}));
    EXPECT_THAT(mixed.notes, Contains(HasSubstr("'s', is none that is known")));
    expectRefused(io::readVolume(folder.write("v.nrrd", plainNrrd("spacings: 1 2 3\nunits: \"mm\" \"mm\" \"cm\"\n"))),
                  "its axes have different units of length");
    const VolumeData unsaid =
        io::readVolume(folder.write("v.nrrd", plainNrrd("units: \"cm\" \"cm\" \"cm\"\n"))).value();
    EXPECT_EQ(unsaid.grid.spacing, (Vec3{1, 1, 1}));
    for (const VolumeData& volume : {nrrd("Mm"), meta("Mm")}) {
        EXPECT_EQ(volume.grid.spacing, (Vec3{1, 2, 3}));
        EXPECT_THAT(volume.notes, Contains(HasSubstr("'Mm', is none that is known; millimetres are taken")));
    }
}

TEST(Volume, WhatAMetaImageHeaderDoesNotSayIsNoted) {
    using testing::HasSubstr;
    const TemporaryFolder folder;
    const std::map<std::string, std::string> fields{{"ElementSpacing = 1 2 3\n", "its spacing"},
                                                    {"Offset = 4 5 6\n", "where its first voxel is"},
                                                    {"TransformMatrix = 1 0 0 0 1 0 0 0 1\n", "how its axes lie"},
                                                    {"BinaryDataByteOrderMSB = False\n", "its byte order"}};
    const auto notesWithout = [&](const std::string& left, const char* type, std::size_t bytes) {
        std::string head = "ObjectType = Image\nNDims = 3\n";
        for (const auto& [field, note] : fields) {
            head += field == left ? "" : field;
        }
        head += std::string("DimSize = 4 3 2\nElementType = ") + type + "\nElementDataFile = LOCAL\n";
        return io::readVolume(folder.write("v.mha", head + std::string(24 * bytes, '\1'))).value().notes;
    };
    EXPECT_THAT(notesWithout("", "MET_SHORT", 2), testing::IsEmpty());
    for (const auto& [field, note] : fields) {
        EXPECT_THAT(notesWithout(field, "MET_SHORT", 2), testing::ElementsAre(HasSubstr(note))) << field;
    }
    EXPECT_THAT(notesWithout("BinaryDataByteOrderMSB = False\n", "MET_UCHAR", 1), testing::IsEmpty());
}

template <class Scalar> Result<VolumeData> readNifti(std::int16_t type, const std::vector<Scalar>& values) {
    const TemporaryFolder folder;
    NiftiFile nifti;
    nifti.sizes = {2, 1, 2};
    nifti.type = type;
    nifti.bits = sizeof(Scalar) * 8;
    nifti.voxels.clear();
    for (const Scalar value : values) {
        append(nifti.voxels, value);
    }
    return io::readVolume(folder.write("v.nii", nifti.bytes()));
}

template <class Scalar> std::vector<Scalar> valuesOf(const VolumeData& volume) {
    std::vector<Scalar> values(volume.voxels.size() / sizeof(Scalar));
    std::memcpy(values.data(), volume.voxels.data(), volume.voxels.size());
    return values;
}

TEST(VolumeTypes, OthersAreNarrowedExactlyAndSaySo) {
    const auto int8 = readNifti<std::int8_t>(256, {-128, 0, 1, 127});
    ASSERT_TRUE(isOk(int8));
    EXPECT_EQ(int8->type, ScalarType::Int16);
    EXPECT_THAT(valuesOf<std::int16_t>(*int8), testing::ElementsAre(-128, 0, 1, 127));
    EXPECT_THAT(int8->notes, testing::ElementsAre("voxels converted from int8 to int16, exactly"));

    const auto int32 = readNifti<std::int32_t>(8, {-32768, 0, 1, 32767});
    ASSERT_TRUE(isOk(int32));
    EXPECT_EQ(int32->type, ScalarType::Int16);
    EXPECT_THAT(valuesOf<std::int16_t>(*int32), testing::ElementsAre(-32768, 0, 1, 32767));

    const auto uint32 = readNifti<std::uint32_t>(768, {0, 1, 2, 65535});
    ASSERT_TRUE(isOk(uint32));
    EXPECT_EQ(uint32->type, ScalarType::UInt16);
    EXPECT_THAT(valuesOf<std::uint16_t>(*uint32), testing::ElementsAre(0, 1, 2, 65535));

    const auto wide = readNifti<std::int32_t>(8, {-1, 65536, 16777216, -2147483647 - 1});
    ASSERT_TRUE(isOk(wide));
    EXPECT_EQ(wide->type, ScalarType::Float32);
    EXPECT_THAT(valuesOf<float>(*wide), testing::ElementsAre(-1.0F, 65536.0F, 16777216.0F, -2147483648.0F));

    const auto real = readNifti<double>(64, {0.1, -1, 2, 1e30});
    ASSERT_TRUE(isOk(real));
    EXPECT_EQ(real->type, ScalarType::Float32);
    EXPECT_THAT(valuesOf<float>(*real), testing::ElementsAre(0.1F, -1.0F, 2.0F, 1e30F));
    EXPECT_THAT(real->notes, testing::ElementsAre("voxels converted from double to float, rounded"));
}

TEST(VolumeTypes, WhatDoesNotFitIsRefused) {
    expectRefused(readNifti<std::int32_t>(8, {0, 0, 16777217, 0}),
                  "voxel (0, 0, 1) is 16777217, which neither 16-bit integers nor floats hold exactly");
    expectRefused(readNifti<std::int64_t>(1024, {0, (std::int64_t{1} << 62) + 1, 0, 0}),
                  "voxel (1, 0, 0) is 4611686018427387905");
    expectRefused(readNifti<double>(64, {0, 0, 0, 1e300}), "voxel (1, 0, 1) is too large for a float");
    expectRefused(readNifti<double>(64, {0, 0, std::nan(""), 0}), "voxel (0, 0, 1) is NaN");
    expectRefused(readNifti<float>(16, {0, 0, 0, std::nanf("")}), "voxel (1, 0, 1) is NaN");
    expectRefused(readNifti<float>(16, {0, INFINITY, 0, 0}), "voxel (1, 0, 0) is infinite");
}

TEST(VolumeWrite, Refusals) {
    const TemporaryFolder folder;
    const VolumeData volume = volumeOf(plainGrid(), ScalarType::UInt8);
    expectRefused(io::writeVolume(folder / "v.png", volume.view()),
                  "the ending of a volume is .nii, .nii.gz, .nrrd or .mha");
    expectRefused(io::writeVolume(folder / "absent" / "v.nii", volume.view()), "absent' does not exist");
    VolumeView half = volume.view();
    half.voxels = half.voxels.first(3);
    expectRefused(io::writeVolume(folder / "v.nii", half), "v.nii': the image has 3 bytes");
    VolumeData sheared = volume;
    sheared.grid.direction = {1, 0, 0, 0.6, 0.8, 0, 0, 0, 1};
    expectRefused(io::writeVolume(folder / "v.nii", sheared.view()), "this format cannot hold");
    EXPECT_EQ(folder.entries(), 0U);
    ASSERT_TRUE(isOk(io::writeVolume(folder / "v.nrrd", sheared.view())));
    const auto read = io::readVolume(folder / "v.nrrd");
    ASSERT_TRUE(isOk(read));
    expectSameGrid(read->grid, sheared.grid, 1e-14);
}

TEST(Volume, ReadsFromManyThreads) {
    const TemporaryFolder folder;
    const VolumeData volume = volumeOf(obliqueGrid(), ScalarType::Int16);
    ASSERT_TRUE(isOk(io::writeVolume(folder / "good.nrrd", volume.view())));
    const std::string good = contentOf(folder / "good.nrrd");
    folder.write("bad.nrrd", good.substr(0, good.size() - 1));
    std::vector<std::thread> threads;
    std::array<int, 4> right{};
    for (int& count : right) {
        threads.emplace_back([&] {
            for (int i = 0; i < 10; ++i) {
                count += io::readVolume(folder / "good.nrrd").ok() && !io::readVolume(folder / "bad.nrrd").ok() ? 1 : 0;
            }
        });
    }
    for (std::thread& thread : threads) {
        thread.join();
    }
    EXPECT_THAT(right, testing::Each(10));
}

} // namespace
} // namespace voxtact::test
