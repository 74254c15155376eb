// SPDX-License-Identifier: MIT
#include "io_test_support.h"

#include <map>

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;

TEST(MrHead, IsTheOneThatDebianPackages) {
    const fs::path path = "/usr/share/mricron/templates/ch2.nii.gz";
    ASSERT_TRUE(fs::exists(path)) << "install mricron-data";
    const auto volume = io::readVolume(path);
    ASSERT_TRUE(isOk(volume));
    EXPECT_EQ(volume->type, ScalarType::UInt8);
    EXPECT_EQ(volume->grid.size, (std::array<std::uint32_t, 3>{181, 217, 181}));
    EXPECT_EQ(volume->grid.spacing, (Vec3{1, 1, 1}));
    EXPECT_EQ(volume->grid.origin, (Vec3{90, 125, -71}));
    EXPECT_EQ(volume->grid.direction, (std::array<double, 9>{-1, 0, 0, 0, -1, 0, 0, 0, 1}));
    EXPECT_EQ(volume->name, "ch2.nii.gz");
    EXPECT_EQ(checkVolume(volume->view())->hi, 254);
}

class SharedData : public testing::Test {
  protected:
    void SetUp() override {
        if (data_.empty()) {
            GTEST_SKIP() << "no shared data (VOXTACT_TEST_DATA)";
        }
    }
    fs::path data_ = sharedData();
};

/// Triangles as MANIFEST.md counts them.
TEST_F(SharedData, MeshesHaveTheirTriangles) {
    const std::map<std::string, std::uint32_t> triangles{{"armadillo_49998.ply", 49998},
                                                         {"fmt_BoxTextured.glb", 12},
                                                         {"fmt_BoxTextured.gltf", 12},
                                                         {"fmt_Cube.off", 12},
                                                         {"fmt_Spider_ascii.stl", 1368},
                                                         {"fmt_Spider_binary.stl", 1368},
                                                         {"fmt_concave_polygon.obj", 64},
                                                         {"fmt_cube.ply", 12},
                                                         {"fmt_cube_binary.ply", 12},
                                                         {"fmt_spider.obj", 1368},
                                                         {"instrument_dental_drill.obj", 514},
                                                         {"instrument_dissection_electrode.stl", 1664},
                                                         {"instrument_maryland_grasper.glb", 2980},
                                                         {"instrument_maryland_grasper.obj", 2980},
                                                         {"instrument_maryland_grasper.stl", 2980},
                                                         {"instrument_ndi_stylus_8700248.stl", 27108},
                                                         {"instrument_needle_20cm.stl", 152},
                                                         {"instrument_psm_gripper1.STL", 1296},
                                                         {"instrument_scissors_jaw_left.stl", 90},
                                                         {"instrument_single_action_forceps_shaft.stl", 3636},
                                                         {"instrument_stapler_collision.ply", 176},
                                                         {"instrument_stapler_handle_polygons.obj", 364},
                                                         {"instrument_suture_needle_40mm.obj", 574},
                                                         {"instrument_us_probe_EC9-5_10.stl", 58834},
                                                         {"pig.stl", 16848},
                                                         {"spot.obj", 5856}};
    for (const auto& [name, count] : triangles) {
        const auto mesh = io::readMesh(data_ / "meshes" / name);
        ASSERT_TRUE(isOk(mesh)) << name;
        EXPECT_EQ(mesh->indices.size(), std::size_t{3} * count) << name;
    }
    EXPECT_EQ(io::readMesh(data_ / "meshes" / "armadillo_49998.ply")->positions.size(), 3U * 25001U);
    EXPECT_EQ(checkMesh(io::readMesh(data_ / "meshes" / "fmt_spider.obj")->view())->degenerate, 56U);
}

TEST_F(SharedData, TheSameMeshInThreeFormats) {
    std::vector<Box> boxes;
    for (const char* ending : {"glb", "obj", "stl"}) {
        const auto mesh = io::readMesh(data_ / "meshes" / (std::string("instrument_maryland_grasper.") + ending));
        ASSERT_TRUE(isOk(mesh));
        EXPECT_EQ(mesh->positions.size(), 3U * 1496U) << ending;
        boxes.push_back(checkMesh(mesh->view())->bounds);
    }
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(boxes[0].hi[i], boxes[2].hi[i]);
        // The OBJ file has six digits.
        EXPECT_NEAR(boxes[1].hi[i], boxes[2].hi[i], 1e-3);
        EXPECT_NEAR(boxes[1].lo[i], boxes[2].lo[i], 1e-3);
    }
}

TEST_F(SharedData, BrokenMeshes) {
    const std::map<std::string, std::string> reasons{
        {"AllIndicesOutOfRange.gltf", "AllIndicesOutOfRange.bin': there is no such file"},
        {"BoxWithInfinites.glb", "NaN, infinite"},
        {"IndexOutOfRange.gltf", "IndexOutOfRange.bin': there is no such file"},
        {"InvalidMesh.ply", "it holds no triangle"},
        {"OutOfMemory.off", "its OFF header does not state"},
        {"box_UTF16BE.obj", "its text is UTF-16"},
        {"empty.obj", "the file is empty"},
        {"empty.off", "the file is empty"},
        {"empty.ply", "the file is empty"},
        {"invalid-staple.ply", "it is not a PLY file"},
        {"invalid.off", "line 6: a face is"},
        {"malformed.obj", "line 28: a face uses vertex 0"},
        {"number_formats.obj", "line 11: '3.1+e2' is not a number"},
        {"point_cloud.obj", "it holds no triangle"},
        {"points.ply", "it holds no triangle"}};
    const std::map<std::string, std::size_t> right{{"malformed2.obj", 10},
                                                   {"triangle.stl", 1},
                                                   {"triangle_with_empty_solid.stl", 1},
                                                   {"triangle_with_two_solids.stl", 2}};
    std::size_t seen = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(data_ / "broken")) {
        const std::string name = entry.path().filename().string();
        const auto mesh = io::readMesh(entry.path());
        if (const auto reason = reasons.find(name); reason != reasons.end()) {
            expectRefused(mesh, reason->second, entry.path().filename());
            ++seen;
        } else if (const auto count = right.find(name); count != right.end()) {
            ASSERT_TRUE(isOk(mesh)) << name;
            EXPECT_EQ(mesh->indices.size(), 3 * count->second) << name;
            ++seen;
        }
    }
    EXPECT_EQ(seen, reasons.size() + right.size());
}

TEST_F(SharedData, DicomFolders) {
    testing::internal::CaptureStderr();
    const auto good = io::readVolume(data_ / "dicom" / "mr_head_studyforrest");
    ASSERT_TRUE(isOk(good));
    EXPECT_EQ(good->type, ScalarType::Int16);
    EXPECT_EQ(good->grid.size, (std::array<std::uint32_t, 3>{274, 384, 12}));
    EXPECT_NEAR(good->grid.spacing[0], 0.7, 1e-4);
    EXPECT_NEAR(good->grid.spacing[2], 2.0 / 3, 1e-6);
    EXPECT_EQ(checkVolume(good->view())->hi, 173);
    expectRefused(io::readVolume(data_ / "dicom" / "ct_head_ge_tilt_varspacing"),
                  "the gaps between its slices are uneven");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

/// The slab begins with slice 209 of the same scan (counted from 1, as the DICOM files are), the series with 180.
TEST_F(SharedData, DicomAndNiftiAgreeOnThePlace) {
    const auto series = io::readVolume(data_ / "dicom" / "mr_head_studyforrest");
    const auto slab = io::readVolume(data_ / "volumes" / "mrhead_slab_native_oblique_274x384x64.nii.gz");
    ASSERT_TRUE(isOk(series));
    ASSERT_TRUE(isOk(slab));
    const Vec3 a = transformPoint(worldFromIndex(series->grid), {100, 200, 209 - 180});
    const Vec3 b = transformPoint(worldFromIndex(slab->grid), {100, 200, 0});
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(a[i], b[i], 1e-3);
    }
}

TEST_F(SharedData, DicomFoldersThatAreNotOneSeries) {
    const TemporaryFolder folder;
    const fs::path good = data_ / "dicom" / "mr_head_studyforrest";
    const fs::path tilted = data_ / "dicom" / "ct_head_ge_tilt_varspacing";
    const auto copy = [&](const fs::path& from) { fs::copy_file(from, folder.path() / from.filename()); };
    copy(good / "N2D_0180.dcm");
    testing::internal::CaptureStderr();
    expectRefused(io::readVolume(folder.path()), "fewer than 2 slices");
    copy(good / "N2D_0181.dcm");
    ASSERT_TRUE(isOk(io::readVolume(folder.path())));
    copy(good / "N2D_0183.dcm");
    expectRefused(io::readVolume(folder.path()), "a slice is missing between 'N2D_0181.dcm'");
    fs::copy_file(good / "N2D_0180.dcm", folder / "again.dcm");
    expectRefused(io::readVolume(folder.path()), "are at the same place");
    copy(tilted / "13.dcm");
    expectRefused(io::readVolume(folder.path()), "the folder holds 2 DICOM series: ");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(SharedData, DicomTiltedGantry) {
    const TemporaryFolder folder;
    for (const char* name : {"15.dcm", "16.dcm", "17.dcm"}) {
        fs::copy_file(data_ / "dicom" / "ct_head_ge_tilt_varspacing" / name, folder / name);
    }
    expectRefused(io::readVolume(folder.path()), "sheared by 18.5 degrees (tilted gantry)");
}

TEST_F(SharedData, DicomTruncatedSlice) {
    const TemporaryFolder folder;
    const fs::path good = data_ / "dicom" / "mr_head_studyforrest";
    fs::copy_file(good / "N2D_0180.dcm", folder / "a.dcm");
    const std::string whole = contentOf(good / "N2D_0181.dcm");
    testing::internal::CaptureStderr();
    for (const std::size_t cut :
         {std::size_t{1}, std::size_t{1000}, whole.size() / 2, whole.size() - 2000, whole.size() - 100}) {
        folder.write("b.dcm", whole.substr(0, whole.size() - cut));
        expectRefused(io::readVolume(folder.path()), folder.path().filename().string());
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(SharedData, Volumes) {
    for (const fs::directory_entry& entry : fs::directory_iterator(data_ / "volumes")) {
        if (!entry.path().string().ends_with(".raw.gz")) {
            EXPECT_TRUE(isOk(io::readVolume(entry.path())));
        }
    }
}

TEST_F(SharedData, OddVolumes) {
    const std::map<std::string, std::string> reasons{
        {"5D_small.nii", "it is 5D"},
        {"5D_zeros.nii.gz", "it is 5D"},
        {"example4d.nii.gz", "it is 4D and holds 2 images; name the one that is meant (frame 0 to 1;"},
        {"not-nifti.nii", "it is not a NIfTI file"},
        {"test.mgz", "its ending is none of"},
        {"truncated_bonsai.nii.gz", "cut off or damaged"}};
    for (const auto& [name, reason] : reasons) {
        expectRefused(io::readVolume(data_ / "odd" / name), reason, name);
    }
    for (const char* name :
         {"air.hdr.gz", "air.img.gz", "standard.nii.gz", "with_extension.nii.gz", "avg152T1_LR_nifti2.nii.gz"}) {
        EXPECT_TRUE(isOk(io::readVolume(data_ / "odd" / name))) << name;
    }
    const auto big = io::readVolume(data_ / "odd" / "big.nii.gz");
    const auto little = io::readVolume(data_ / "odd" / "little.nii.gz");
    ASSERT_TRUE(isOk(big));
    ASSERT_TRUE(isOk(little));
    EXPECT_EQ(big->voxels, little->voxels);
}

} // namespace
} // namespace voxtact::test
