// SPDX-License-Identifier: MIT
// Outputs that are inputs, and outputs that do not fit. No device is needed.
#include "child.h"

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;

constexpr const char* kIdentity = "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n";

class OutputPathsTest : public CliTest {
  protected:
    OutputPathsTest() {
        writeText(path("m.obj"), "v 0 0 0\nv 10 0 0\nv 0 10 0\nf 1 2 3\n");
        writeNifti(path("v.nii"), {});
        writeNifti(path("labels.nii"), {});
        writeText(path("labels.nii.txt"), "1 one\n");
        writeText(path("poses.txt"), kIdentity);
        writeText(path("camera.txt"), kIdentity);
        writeText(path("opacity.tf"), "0 0\n255 1\n");
    }

    [[nodiscard]] Arguments detect(const Arguments& more) const {
        Arguments all{"count",   "--volume",        path("v.nii"),         "--mesh",           path("m.obj"),
                      "--poses", path("poses.txt"), "--transfer-function", path("opacity.tf"), "--method",
                      "cpu"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }

    /// Nothing is written: every file is as it was.
    void expectRefused(const Arguments& arguments, const std::string& option) const {
        std::map<std::string, std::string> before;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path(""))) {
            before[entry.path().string()] = entry.is_regular_file() ? readText(entry.path()) : "";
        }
        EXPECT_THAT(refused(2, arguments), AllOf(HasSubstr("that " + option + " reads"), HasSubstr("not overwritten")));
        std::map<std::string, std::string> after;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path(""))) {
            after[entry.path().string()] = entry.is_regular_file() ? readText(entry.path()) : "";
        }
        EXPECT_EQ(after, before);
    }
};

TEST_F(OutputPathsTest, InputsOfDetect) {
    fs::create_symlink(path("m.obj"), path("link.csv"));
    fs::create_symlink(path("link.csv"), path("link2.csv"));
    fs::create_hard_link(path("poses.txt"), path("hard.csv"));
    expectRefused(detect({"--output", path("m.obj")}), "--mesh");
    expectRefused(detect({"--output", path("v.nii")}), "--volume");
    expectRefused(detect({"--triangles", path("./poses.txt")}), "--poses");
    expectRefused(detect({"--triangles", path("hard.csv")}), "--poses");
    expectRefused(detect({"--output", path("opacity.tf")}), "--transfer-function");
    expectRefused(detect({"--contacts", path("link.csv")}), "--mesh");
    expectRefused(detect({"--contacts", path("link2.csv")}), "--mesh");
    expectRefused(detect({"--projection", "view", "--camera", path("camera.txt"), "--output", path("camera.txt")}),
                  "--camera");
    expectRefused(detect({"--label-counts", "--labels", path("labels.nii"), "--output", path("labels.nii")}),
                  "--labels");
    expectRefused(detect({"--label-counts", "--labels", path("labels.nii"), "--output", path("labels.nii.txt")}),
                  "--label-names");
    // A file of another name in the same folder is none of them.
    const RunOptions transparent{.note = "none of its values, 0, is opaque"};
    output(detect({"--label-counts", "--labels", path("labels.nii"), "--output", path("new.csv")}), transparent);
    output(detect({"--output", path("new.csv")}), transparent);
}

TEST_F(OutputPathsTest, InputsOfOtherCommands) {
    const Arguments pair{"--volume", path("v.nii"), "--mesh", path("m.obj")};
    const auto command = [&](Arguments words, const Arguments& more) {
        words.insert(words.end(), pair.begin(), pair.end());
        words.insert(words.end(), more.begin(), more.end());
        return words;
    };
    fs::create_symlink(path("v.nii"), path("picture.png"));
    expectRefused(command({"make", "poses"}, {"--output", path("m.obj")}), "--mesh");
    expectRefused(command({"compare"}, {"--output", path("v.nii")}), "--volume");
    expectRefused(command({"compare", "--localize"}, {"--output", path("m.obj")}), "--mesh");
    expectRefused(command({"bench", "--certified"}, {"--output", path("v.nii")}), "--volume");
    expectRefused({"info", path("v.nii"), "--output", path("v.nii")}, "PATH");
    expectRefused(command({"render"}, {"--output", path("picture.png")}), "--volume");
    fs::create_directories(path("data/meshes"));
    expectRefused({"bench", "--paper", "--data", path("data"), "--output", path("data/meshes/armadillo_49998.ply")},
                  "--data");
}

TEST_F(OutputPathsTest, FilesOfAFolderOfSlices) {
    fs::create_directory(path("slices"));
    writeText(path("slices/IM0001.dcm"), "a slice");
    fs::create_hard_link(path("slices/IM0001.dcm"), path("hard.csv"));
    fs::create_directory_symlink(path("slices"), path("also"));
    for (const char* file : {"slices/IM0001.dcm", "also/IM0001.dcm", "slices/new.csv", "also/../hard.csv"}) {
        expectRefused(
            {"count", "--volume", path("slices"), "--mesh", path("m.obj"), "--method", "cpu", "--output", path(file)},
            "--volume");
    }
}

TEST_F(OutputPathsTest, FilesThatAHeaderNames) {
    writeText(path("v.mhd"), "ObjectType = Image\nElementDataFile = my voxels.raw\n");
    writeText(path("my voxels.raw"), "voxels");
    expectRefused({"count", "--volume", path("v.mhd"), "--mesh", path("m.obj"), "--output", path("my voxels.raw")},
                  "--volume");
    writeText(path("v.nhdr"), "NRRD0004\ndata file: v.raw.gz\n");
    writeText(path("v.raw.gz"), "voxels");
    expectRefused({"count", "--volume", path("v.nhdr"), "--mesh", path("m.obj"), "--output", path("v.raw.gz")},
                  "--volume");
    writeText(path("v.hdr"), "header");
    writeText(path("v.img"), "voxels");
    writeText(path("U.HDR"), "header");
    writeText(path("U.IMG"), "voxels");
    expectRefused({"count", "--volume", path("U.HDR"), "--mesh", path("m.obj"), "--output", path("U.IMG")}, "--volume");
    expectRefused({"count", "--volume", path("v.hdr"), "--mesh", path("m.obj"), "--output", path("v.img")}, "--volume");
    expectRefused({"count", "--volume", path("v.img"), "--mesh", path("m.obj"), "--output", path("v.hdr")}, "--volume");
    writeText(path("m.gltf"), R"({"buffers": [{"uri": "my%20mesh.bin", "byteLength": 4}]})");
    writeText(path("my mesh.bin"), "mesh");
    expectRefused({"count", "--volume", path("v.nii"), "--mesh", path("m.gltf"), "--output", path("my mesh.bin")},
                  "--mesh");
}

/// Whether it is an input that would be overwritten, nobody can tell.
TEST_F(OutputPathsTest, WhatCannotBeLookedAt) {
    const std::string loop = path("loop.csv");
    fs::create_symlink(loop, loop);
    EXPECT_THAT(refused(1, detect({"--output", loop})), AllOf(HasSubstr("loop.csv"), HasSubstr("symbolic links")));
    writeText(path("m.gltf"), R"({"buffers": [{"uri": "loop.csv", "byteLength": 4}]})");
    writeText(path("old.csv"), "as it was");
    EXPECT_THAT(refused(1, {"count", "--volume", path("v.nii"), "--mesh", path("m.gltf"), "--output", path("old.csv")}),
                AllOf(HasSubstr("cannot examine"), HasSubstr("loop.csv"), HasSubstr("symbolic links")));
    EXPECT_EQ(readText(path("old.csv")), "as it was");
}

TEST_F(OutputPathsTest, TwoNamesOfOneFile) {
    writeText(path("old.csv"), "as it was");
    fs::create_hard_link(path("old.csv"), path("hard.csv"));
    EXPECT_THAT(refused(2, detect({"--output", path("old.csv"), "--triangles", path("hard.csv")})),
                HasSubstr("--output and --triangles: both are"));
    EXPECT_EQ(readText(path("old.csv")), "as it was");
}

/// Every writer says that the disk is full, and leaves nothing.
TEST_F(OutputPathsTest, FilesThatDoNotFit) {
    const std::size_t before = filesInFolder();
    const auto expectFull = [&](const Arguments& arguments, const std::string& file) {
        Child child(arguments, 4096);
        child.closeInput();
        const Ran ran = child.end();
        EXPECT_EQ(ran.status, 1);
        EXPECT_EQ(ran.out, "");
        // The libraries that write volumes may have said something of their own before.
        EXPECT_THAT(linesOf(ran.err).back(), AllOf(HasSubstr("cannot write '" + file), HasSubstr("File too large")));
        EXPECT_EQ(filesInFolder(), before) << "no half file, and no temporary one: " << file;
    };
    for (const char* name : {"a.nii", "a.nii.gz", "a.nrrd", "a.mha"}) {
        expectFull({"make", "volume", "builtin:head:64", path(name)}, path(name));
    }
    for (const char* name : {"a.stl", "a.obj", "a.ply"}) {
        expectFull({"make", "mesh", "builtin:scalpel:500", path(name)}, path(name));
    }
    const Arguments pair{"--volume", path("v.nii"), "--mesh", path("m.obj")};
    Arguments poses{"make", "poses", "--output", path("p.txt")};
    poses.insert(poses.end(), pair.begin(), pair.end());
    expectFull(poses, path("p.txt"));
    poses[3] = path("poses.txt");
    output(poses);
    expectFull(detect({"--output", path("rows.csv")}), path("rows.csv"));
    expectFull(detect({"--output", path("rows.csv"), "--triangles", path("t.csv"), "--contacts", path("c.csv")}),
               path("rows.csv"));
}

} // namespace
} // namespace voxtact::test
