// SPDX-License-Identifier: MIT
// Lists of points.
#include "io_test_support.h"

#include <sstream>

namespace voxtact::test {
namespace {

TEST(PointList, NumbersAndMaybeAName) {
    const TemporaryFolder folder;
    const auto points = io::readPoints(
        folder.write("points.txt", "\xEF\xBB\xBF# mm\r\n\r\n1 -2.5 3e1\n  4\t5 6 left,\"deep\" # a name\n7 8 9"));
    ASSERT_TRUE(isOk(points));
    ASSERT_EQ(points->size(), 3U);
    EXPECT_EQ((*points)[0].position, (Vec3{1, -2.5, 30}));
    EXPECT_EQ((*points)[0].name, "");
    EXPECT_EQ((*points)[0].line, 3U);
    EXPECT_EQ((*points)[1].position, (Vec3{4, 5, 6}));
    EXPECT_EQ((*points)[1].name, "left,\"deep\"");
    EXPECT_EQ((*points)[1].line, 4U);
    EXPECT_EQ((*points)[2].line, 5U);
}

TEST(PointList, RefusalsNameTheLine) {
    const TemporaryFolder folder;
    struct Case {
        const char* line;
        const char* reason;
    };
    for (const Case& bad : {Case{"1 2", "line 2: a point is three numbers"}, Case{"1 2 3 a b", "this has 5 words"},
                            Case{"one", "this has 1 word"}, Case{"1 2 x", "line 2: 'x' is not a number"},
                            Case{"1 nan 3", "line 2: 'nan' is not"}, Case{"1e999 2 3", "line 2: '1e999' is outside"},
                            Case{"1,2,3", "this has 1 word"}}) {
        SCOPED_TRACE(bad.line);
        expectRefused(io::readPoints(folder.write("points.txt", std::string("1 2 3\n") + bad.line + "\n4 5 6\n")),
                      bad.reason);
    }
    expectRefused(io::readPoints(folder.write("points.txt", "# none\n")), "it has no point");
    expectRefused(io::readPoints(folder / "absent.txt"), "absent.txt");
}

/// What is written to a stream is what is written to a file.
TEST(WriteToStreams, IsTheFile) {
    const TemporaryFolder folder;
    VolumeData volume;
    volume.grid.size = {2, 3, 4};
    volume.voxels.resize(24);
    for (std::size_t i = 0; i < volume.voxels.size(); ++i) {
        volume.voxels[i] = static_cast<std::byte>(i);
    }
    for (const char* name : {"v.nii", "v.nii.gz", "v.nrrd", "v.mha"}) {
        std::ostringstream out;
        ASSERT_TRUE(isOk(io::writeVolume(out, name, volume.view())));
        ASSERT_TRUE(isOk(io::writeVolume(folder / name, volume.view())));
        EXPECT_EQ(out.str(), contentOf(folder / name));
    }
    std::ostringstream out;
    expectRefused(io::writeVolume(out, "v.png", volume.view()), "the ending of a volume is");
    const std::vector<std::uint8_t> rgba(24, 77);
    ASSERT_TRUE(isOk(io::writePng(out, 3, 2, rgba)));
    ASSERT_TRUE(isOk(io::writePng(folder / "p.png", 3, 2, rgba)));
    EXPECT_EQ(out.str(), contentOf(folder / "p.png"));
    expectRefused(io::writePng(out, 3, 3, rgba), "four a pixel");
}

} // namespace
} // namespace voxtact::test
