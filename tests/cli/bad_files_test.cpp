// SPDX-License-Identifier: MIT
// Files that cannot be used: one line that names the file and the reason, exit status 1. They are read before there is
// a device, except volumes.
#include "cli_fixture.h"

#include <sys/stat.h>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;

constexpr const char* kIdentity = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n";

/// Refusals that need no device.
class BadFilesTest : public CliTest {
  protected:
    static std::string badDetect(const Arguments& more) {
        Arguments all{"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500"};
        all.insert(all.end(), more.begin(), more.end());
        return refused(1, all);
    }
};

class BadVolumesTest : public CliDeviceTest {
  protected:
    [[nodiscard]] std::string bad(const std::string& name) const {
        std::string text =
            refused(1, {"count", "--volume", path(name), "--mesh", "builtin:scalpel:500", "--output", path("out.csv")});
        EXPECT_THAT(text, HasSubstr(path(name)));
        EXPECT_FALSE(std::filesystem::exists(path("out.csv")));
        return text;
    }
};

TEST_F(BadFilesTest, MissingFilesAreNamed) {
    EXPECT_THAT(refused(1, {"count", "--volume", path("no.nii"), "--mesh", "builtin:scalpel"}),
                AllOf(HasSubstr("voxtact count: "), HasSubstr(path("no.nii"))));
    EXPECT_THAT(refused(1, {"count", "--volume", "builtin:head:18", "--mesh", path("no.stl")}),
                HasSubstr(path("no.stl")));
    for (const char* option : {"--poses", "--camera", "--transfer-function"}) {
        EXPECT_THAT(badDetect({"--projection", "view", option, path("no.txt")}), HasSubstr(path("no.txt")));
    }
}

/// Opening a pipe would wait for a writer.
TEST_F(BadFilesTest, PipesAndDevicesAreRefused) {
    constexpr const char* kPipe = "it is a pipe, not a file; write what it gives to a file first";
    for (const char* name : {"pipe.nii", "pipe.stl", "pipe"}) {
        ASSERT_EQ(::mkfifo(path(name).c_str(), 0600), 0);
    }
    EXPECT_THAT(refused(1, {"count", "--volume", path("pipe.nii"), "--mesh", "builtin:scalpel:500"}),
                AllOf(HasSubstr(path("pipe.nii")), HasSubstr(kPipe)));
    EXPECT_THAT(refused(1, {"count", "--volume", "builtin:head:18", "--mesh", path("pipe.stl")}),
                AllOf(HasSubstr(path("pipe.stl")), HasSubstr(kPipe)));
    for (const char* option : {"--poses", "--camera", "--transfer-function", "--labels"}) {
        // Labels are read for an output.
        EXPECT_THAT(badDetect({"--projection", "view", "--contacts", path("c.csv"), option, path("pipe")}),
                    AllOf(HasSubstr(path("pipe")), HasSubstr(kPipe)))
            << option;
    }
    EXPECT_THAT(badDetect({"--poses", "/dev/zero"}), HasSubstr("it is a device, not a file"));
}

TEST_F(BadFilesTest, AMissingVolumeIsFoundBeforeTheFirstIsDone) {
    EXPECT_THAT(badDetect({"--volume", path("no.nii")}), HasSubstr(path("no.nii")));
}

TEST_F(BadFilesTest, PosesNameTheLine) {
    std::string text = "# poses\n\n";
    for (int i = 0; i < 4; ++i) {
        text += kIdentity;
    }
    writeText(path("poses.txt"), text + "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0\n");
    EXPECT_THAT(badDetect({"--poses", path("poses.txt")}),
                AllOf(HasSubstr(path("poses.txt")), HasSubstr("line 7"), HasSubstr("15 numbers")));

    writeText(path("poses.txt"), std::string(kIdentity) + "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 2\n");
    EXPECT_THAT(badDetect({"--poses", path("poses.txt")}), HasSubstr("line 2"));
    writeText(path("poses.txt"), std::string(kIdentity) + "1 0 0 0 0 1 0 0 0 0 nan 0 0 0 0 1\n");
    EXPECT_THAT(badDetect({"--poses", path("poses.txt")}), HasSubstr("line 2"));
    writeText(path("poses.txt"), "# nothing\n");
    EXPECT_THAT(badDetect({"--poses", path("poses.txt")}), HasSubstr(path("poses.txt")));
}

TEST_F(BadFilesTest, TransferFunctionsNameTheLine) {
    writeText(path("a.tf"), "0 0\n100 1.5\n");
    EXPECT_THAT(badDetect({"--transfer-function", path("a.tf")}),
                AllOf(HasSubstr(path("a.tf")), HasSubstr("line 2"), HasSubstr("1.5")));
    writeText(path("a.tf"), "# descending\n100 0\n50 1\n");
    EXPECT_THAT(badDetect({"--transfer-function", path("a.tf")}), AllOf(HasSubstr("line 3"), HasSubstr("ascend")));
    writeText(path("a.tf"), "");
    EXPECT_THAT(badDetect({"--transfer-function", path("a.tf")}), HasSubstr(path("a.tf")));
    writeText(path("a.json"), "{\"points\": [[0, 0], [1, 7]]}");
    EXPECT_THAT(badDetect({"--transfer-function", path("a.json")}), AllOf(HasSubstr(path("a.json")), HasSubstr("7")));
}

TEST_F(BadFilesTest, SingularCamera) {
    writeText(path("camera.txt"), "1 0 0 0 0 1 0 0 0 0 0 0 0 0 0 1\n");
    EXPECT_THAT(badDetect({"--projection", "view", "--camera", path("camera.txt")}),
                AllOf(HasSubstr(path("camera.txt")), HasSubstr("singular")));
}

TEST_F(BadFilesTest, MeshesThatAreNone) {
    writeText(path("empty.obj"), "");
    writeText(path("notes.stl"), "this is not a mesh");
    for (const char* name : {"empty.obj", "notes.stl"}) {
        EXPECT_THAT(refused(1, {"count", "--volume", "builtin:head:18", "--mesh", path(name)}), HasSubstr(path(name)));
    }
}

TEST_F(BadVolumesTest, NoImage) {
    writeText(path("garbage.nii"), "this is not an image");
    EXPECT_THAT(bad("garbage.nii"), HasSubstr("voxtact count: "));
    writeText(path("garbage.txt"), "this is not an image");
    EXPECT_THAT(bad("garbage.txt"), HasSubstr("ending"));
    std::filesystem::create_directory(path("folder"));
    EXPECT_THAT(bad("folder"), HasSubstr("DICOM"));
}

TEST_F(BadVolumesTest, TruncatedImage) {
    writeNifti(path("short.nii"), {.bytes = 100});
    EXPECT_THAT(bad("short.nii"), HasSubstr("short"));
}

TEST_F(BadVolumesTest, FlatImage) {
    writeNifti(path("flat.nii"), {.sizes = {2, 8, 8, 1, 1, 1, 1, 1}, .bytes = 64});
    EXPECT_THAT(bad("flat.nii"), HasSubstr("2"));
}

TEST_F(BadVolumesTest, SeriesOfImages) {
    writeNifti(path("series.nii"), {.sizes = {4, 8, 8, 8, 3, 1, 1, 1}, .bytes = 3 * 512});
    EXPECT_THAT(bad("series.nii"), AnyOf(HasSubstr("4D"), HasSubstr("4-dimensional"), HasSubstr("3 images")));
}

TEST_F(BadVolumesTest, ColourImage) {
    writeNifti(path("rgb.nii"), {.type = 128, .bits = 24, .bytes = std::size_t{3} * 512});
    EXPECT_THAT(bad("rgb.nii"), AnyOf(HasSubstr("RGB"), HasSubstr("rgb"), HasSubstr("components")));
}

} // namespace
} // namespace voxtact::test
