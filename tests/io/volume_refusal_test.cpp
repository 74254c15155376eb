// SPDX-License-Identifier: MIT
#include "io_test_support.h"

namespace voxtact::test {
namespace {

std::string metaImage(const std::string& extra, const std::string& voxels) {
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n" + extra +
           "DimSize = 8 8 8\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" + voxels;
}

std::string nrrd(const std::string& encoding, const std::string& voxels) {
    return "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 8 8 8\n"
           "space directions: (1,0,0) (0,1,0) (0,0,1)\nencoding: " +
           encoding + "\nspace origin: (0,0,0)\n\n" + voxels;
}

/// 512 voxels that do not compress to nothing.
std::string noise() {
    std::string voxels;
    unsigned state = 1;
    for (int i = 0; i < 512; ++i) {
        state = state * 1103515245U + 12345U;
        voxels += static_cast<char>(state >> 24);
    }
    return voxels;
}

struct Whole {
    const char* name;
    std::string bytes;
};

std::vector<Whole> wholeFiles() {
    NiftiFile nifti;
    nifti.sizes = {8, 8, 8};
    nifti.voxels = noise();
    const std::string zlib = compressed(noise(), Wrapping::Zlib);
    return {{"v.nii", nifti.bytes()},
            {"v.nii.gz", compressed(nifti.bytes(), Wrapping::Gzip)},
            {"raw.nrrd", nrrd("raw", noise())},
            {"gzip.nrrd", nrrd("gzip", compressed(noise(), Wrapping::Gzip))},
            {"raw.mha", metaImage("", noise())},
            {"zlib.mha",
             metaImage("CompressedData = True\nCompressedDataSize = " + std::to_string(zlib.size()) + "\n", zlib)}};
}

/// ITK 5.2 reads many of these without an exception, the rest of the image zero or undefined.
TEST(VolumeTruncated, IsRefusedAtEveryLength) {
    const TemporaryFolder folder;
    testing::internal::CaptureStderr();
    for (const Whole& whole : wholeFiles()) {
        ASSERT_TRUE(isOk(io::readVolume(folder.write(whole.name, whole.bytes)))) << whole.name;
        for (std::size_t length = 0; length < whole.bytes.size(); length += length < whole.bytes.size() - 30 ? 7 : 1) {
            const auto path = folder.write(whole.name, std::string_view(whole.bytes).substr(0, length));
            const auto volume = io::readVolume(path);
            ASSERT_FALSE(volume.ok()) << whole.name << " cut to " << length << " of " << whole.bytes.size();
            expectRefused(volume, whole.name);
        }
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(VolumeTruncated, MessagesSayHowMuch) {
    const TemporaryFolder folder;
    const auto cut = [&](const Whole& whole) {
        return io::readVolume(folder.write(whole.name, whole.bytes.substr(0, whole.bytes.size() - 1)));
    };
    const std::vector<Whole> files = wholeFiles();
    for (const std::size_t raw : {0U, 2U, 4U}) {
        expectRefused(cut(files[raw]), "it is truncated: its voxels take 512 bytes, 511 are there; get the file again");
        expectRefused(cut(files[raw + 1]), "its compressed data is cut off or damaged; get the file again");
    }
}

TEST(VolumeDamaged, ChecksumsAreVerified) {
    const TemporaryFolder folder;
    for (Whole& whole : wholeFiles()) {
        if (std::string_view(whole.name).find('z') == std::string_view::npos) {
            continue;
        }
        whole.bytes[whole.bytes.size() - 6] ^= 1;
        expectRefused(io::readVolume(folder.write(whole.name, whole.bytes)), "cut off or damaged");
    }
}

TEST(VolumeRefusal, Files) {
    const TemporaryFolder folder;
    expectRefused(io::readVolume(folder / "absent.nii"), "absent.nii': there is no such file");
    expectRefused(io::readVolume(folder.write("empty.nii.gz", "")), "empty.nii.gz': the file is empty");
    expectRefused(io::readVolume(folder.write("v.txt", "hello")), "v.txt': its ending is none of .nii");
    expectRefused(io::readVolume(folder.write("slice.dcm", std::string(128, '\0') + "DICM....")),
                  "it is one DICOM file");
    expectRefused(io::readVolume(folder.write("v.nii", std::string(1000, 'x'))), "it is not a NIfTI file");
    expectRefused(io::readVolume(folder.write("v.nrrd", std::string(1000, 'x'))), "it is not a NRRD file");
    expectRefused(io::readVolume(folder.write("v.mha", std::string(1000, 'x'))), "it is not a MetaImage file");
    const TemporaryFolder nothing;
    expectRefused(io::readVolume(nothing.path()), "the folder holds no DICOM series");
}

TEST(VolumeRefusal, Dimensions) {
    const TemporaryFolder folder;
    const auto read = [&](std::vector<std::int64_t> sizes) {
        NiftiFile nifti;
        nifti.sizes = std::move(sizes);
        nifti.voxels.resize(1000);
        return io::readVolume(folder.write("v.nii", nifti.bytes()));
    };
    expectRefused(read({4, 4}), "it is 2D; a 3D image is needed");
    EXPECT_TRUE(isOk(read({4, 4, 1})));
    expectRefused(read({4, 4, 4, 2}), "it is 4D and holds 2 images");
    expectRefused(read({4, 4, 4, 1, 3}), "it is 5D and holds 3 images or components");
    expectRefused(read({4, 0, 4}), "it has no voxels (its size along axis 1 is 0)");
    expectRefused(read({4, 4, -4}), "it has no voxels (its size along axis 2 is -4)");
    expectRefused(read({32767, 32767, 32767}), "it is truncated");
    expectRefused(
        io::readVolume(folder.write("v.mha", "NDims = 3\nDimSize = 999999 999999 999999\nElementType = MET_UCHAR\n"
                                             "ElementDataFile = LOCAL\n")),
        "more voxels than memory can hold");
    expectRefused(
        io::readVolume(folder.write("v.nrrd", "NRRD0004\ntype: uint8\ndimension: 2\nsizes: 4 4\nencoding: raw\n\n" +
                                                  std::string(16, 'x'))),
        "it is 2D");
    expectRefused(
        io::readVolume(folder.write("v.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 0 4\nencoding: raw\n\n")),
        "it has no voxels");
}

TEST(VolumeRefusal, VoxelsThatAreNoScalars) {
    const TemporaryFolder folder;
    const auto read = [&](std::int16_t type, std::int16_t bits) {
        NiftiFile nifti;
        nifti.type = type;
        nifti.bits = bits;
        nifti.voxels.resize(1000);
        return io::readVolume(folder.write("v.nii", nifti.bytes()));
    };
    expectRefused(read(128, 24), "its voxels are colours (RGB)");
    expectRefused(read(2304, 32), "its voxels are colours (RGB)");
    expectRefused(read(32, 64), "its voxels are complex numbers");
    expectRefused(read(1536, 128), "of a type that is not supported");
    expectRefused(io::readVolume(folder.write("v.mha", "NDims = 3\nDimSize = 2 2 2\nElementNumberOfChannels = 3\n"
                                                       "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
                                                           std::string(24, 'x'))),
                  "its voxels are not single numbers ('MET_UCHAR', '3' channels)");
    expectRefused(
        io::readVolume(folder.write("v.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 3 2 2 2\nkinds: RGB-color "
                                              "domain domain domain\nencoding: raw\n\n" +
                                                  std::string(24, 'x'))),
        "its voxels are not single numbers (axis 0 is 'RGB-color')");
    expectRefused(
        io::readVolume(folder.write("v.nrrd", "NRRD0004\ntype: block\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n\n")),
        "its voxels are of the type 'block'");
}

TEST(VolumeRefusal, Storage) {
    const TemporaryFolder folder;
    expectRefused(io::readVolume(folder.write("v.nrrd", nrrd("bzip2", "1 2 3"))),
                  "its encoding 'bzip2' is not supported");
    expectRefused(io::readVolume(folder.write("v.mhd", "NDims = 3\nDimSize = 2 1 1\nElementType = MET_UCHAR\n"
                                                       "ElementDataFile = gone.raw\n")),
                  "gone.raw': there is no such file");
    expectRefused(io::readVolume(folder.write("v.mhd", "NDims = 3\nDimSize = 2 1 1\nElementType = MET_UCHAR\n"
                                                       "ElementDataFile = LIST\na\nb\n")),
                  "its voxels are in 2 files, its 1 slices cannot be spread over them evenly");
}

TEST(VolumeRefusal, SingularDirection) {
    const TemporaryFolder folder;
    testing::internal::CaptureStderr();
    expectRefused(
        io::readVolume(folder.write("v.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\n"
                                              "sizes: 2 2 2\nspace directions: (1,0,0) (1,0,0) (0,0,1)\n"
                                              "encoding: raw\n\n12345678")),
        "v.nrrd");
    NiftiFile nifti;
    nifti.sform = {1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0};
    expectRefused(io::readVolume(folder.write("v.nii", nifti.bytes())), "v.nii");
    nifti.sform = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};
    expectRefused(io::readVolume(folder.write("v.nii", nifti.bytes())), "v.nii");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(VolumeRefusal, DamagedMetaImageHeader) {
    const TemporaryFolder folder;
    testing::internal::CaptureStderr();
    expectRefused(io::readVolume(folder.write("v.mha", metaImage("Offset = 0 F 0\n", noise()))),
                  "'Offset' needs 3 numbers");
    expectRefused(io::readVolume(folder.write("v.mha", metaImage("TransformMatrix = 1 0 0 0 1 0 0 1\n", noise()))),
                  "'TransformMatrix' needs 9 numbers");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(VolumeRefusal, AFieldThatIsThereTwice) {
    const TemporaryFolder folder;
    const auto meta = [&](const std::string& fields) {
        return io::readVolume(folder.write("v.mha", metaImage(fields, noise())));
    };
    const auto nrrdWith = [&](const std::string& fields) {
        return io::readVolume(
            folder.write("v.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nspace: left-posterior-superior\nsizes: 8 8 8\n"
                                   "space directions: (1,0,0) (0,1,0) (0,0,1)\nencoding: raw\nspace origin: (0,0,0)\n" +
                                       fields + "\n" + noise()));
    };
    expectRefused(meta("Offset = 0 0 1\nOffset = 0 0 2\n"), "it says 'Offset' twice, first '0 0 1' and then '0 0 2'");
    expectRefused(meta("DimSize = 4 16 8\n"), "it says 'DimSize' twice");
    EXPECT_TRUE(isOk(meta("Offset = 0 0 1\nOffset = 0 0 1\nComment = a\nComment = b\n")));
    expectRefused(nrrdWith("space: RAS\n"), "it says 'space' twice, first 'left-posterior-superior' and then 'RAS'");
    expectRefused(nrrdWith("sizes: 4 16 8\n"), "it says 'sizes' twice");
    EXPECT_TRUE(isOk(nrrdWith("sizes: 8 8 8\nnote:=of: one\nnote:=of: another\n")));
}

TEST(VolumeRefusal, BadSpacing) {
    const TemporaryFolder folder;
    expectRefused(io::readVolume(folder.write(
                      "v.mha", "NDims = 3\nElementSpacing = 1 0 1\nDimSize = 2 1 1\nElementType = MET_UCHAR\n"
                               "ElementDataFile = LOCAL\n12")),
                  "v.mha");
}

} // namespace
} // namespace voxtact::test
