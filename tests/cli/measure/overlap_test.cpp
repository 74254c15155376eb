// SPDX-License-Identifier: MIT
// voxtact overlap, and touch and distance with --solid.
#include "cli/cli_fixture.h"

#include <cmath>

namespace voxtact::test {
namespace {

using testing::HasSubstr;

/// Boxes in an image of 20^3 voxels of 1 mm with the value 200, and 40 in its upper half along z.
class OverlapTest : public CliTest {
  protected:
    void SetUp() override {
        std::string voxels;
        for (int z = 0; z < 20; ++z) {
            voxels += std::string(400, z < 10 ? '\xc8' : '\x28');
        }
        writeText(path("image.nrrd"), "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 20 20 20\nencoding: raw\nspace: "
                                      "left-posterior-superior\nspace origin: (0,0,0)\nspace directions: (1,0,0) "
                                      "(0,1,0) (0,0,1)\n\n" +
                                          voxels);
        writeText(path("box.obj"), box("2", "6", "1"));
        writeText(path("open.obj"), box("2", "6", "1", false));
        writeText(path("around.obj"), box("-9", "40", "-9"));
    }
    /// From lo to hi along x and y, along z 4 mm more than from `bottom` on: 18 where hi is 40.
    static std::string box(const std::string& lo, const std::string& hi, const std::string& bottom,
                           bool closed = true) {
        const std::string top = hi == "40" ? "40" : "5";
        std::string text;
        for (const std::string& z : {bottom, top}) {
            for (const auto& [x, y] : {std::pair(lo, lo), std::pair(hi, lo), std::pair(hi, hi), std::pair(lo, hi)}) {
                text += "v " + x + " " + y + " " + z + "\n";
            }
        }
        text += "f 1 4 3 2\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
        return closed ? text + "f 5 6 7 8\n" : text;
    }
    [[nodiscard]] Arguments overlap(const char* mesh, const Arguments& more = {}) const {
        Arguments all{"overlap", "--volume", path("image.nrrd"), "--mesh", path(mesh), "--format", "csv", "--quiet"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
};

TEST_F(OverlapTest, MeasuresWhatIsInside) {
    const auto rows = rowsOf(output(overlap("box.obj", {"--iso", "100", "--tolerance", "0.001"})));
    ASSERT_EQ(rows.size(), 1U);
    EXPECT_NEAR(std::stod(rows[0].at("lower")), 64, 0.002); // 4 x 4 x 4 mm
    EXPECT_NEAR(std::stod(rows[0].at("upper")), 64, 0.002);
    EXPECT_NEAR(std::stod(rows[0].at("solid_lower")), 64, 0.002);
    EXPECT_LE(std::stod(rows[0].at("lower")), 64);
    EXPECT_GE(std::stod(rows[0].at("upper")), 64);
    EXPECT_EQ(rows[0].at("inside"), "some");
    EXPECT_EQ(rowsOf(output(overlap("around.obj", {"--iso", "100"})))[0].at("inside"), "all");
    EXPECT_EQ(rowsOf(output(overlap("box.obj", {"--iso", "201"})))[0].at("upper"), "0");
}

TEST_F(OverlapTest, WritesARowABand) {
    const auto rows = rowsOf(output(overlap("box.obj", {"--bands", "40,200", "--tolerance", "0.001"})));
    ASSERT_EQ(rows.size(), 3U);
    EXPECT_EQ(rows[0].at("from"), "");
    EXPECT_EQ(rows[0].at("below"), "40");
    EXPECT_EQ(rows[2].at("from"), "200");
    EXPECT_EQ(rows[2].at("below"), "");
    EXPECT_LE(std::stod(rows[0].at("upper")), 1e-5);        // no value is below the limit, but for rounding
    EXPECT_NEAR(std::stod(rows[2].at("lower")), 64, 0.002); // a value on a limit is in the band from there on
}

TEST_F(OverlapTest, AMeshWithHolesIsRefusedOrFilled) {
    EXPECT_THAT(refused(2, overlap("open.obj")), HasSubstr("1 hole"));
    EXPECT_THAT(refused(2, overlap("open.obj")), HasSubstr("--fill-holes"));
    const Ran filled = run({"overlap", "--volume", path("image.nrrd"), "--mesh", path("open.obj"), "--format", "csv",
                            "--fill-holes", "--iso", "100", "--tolerance", "0.001"});
    EXPECT_EQ(filled.status, 0);
    EXPECT_THAT(filled.err, HasSubstr("1 hole filled, which added 16 mm^2 of surface"));
    EXPECT_NEAR(std::stod(rowsOf(filled.out)[0].at("lower")), 64, 0.002);
}

TEST_F(OverlapTest, BandsAreAscendingNumbers) {
    for (const char* bands : {"3,2", "1,1", "1,,2", "x", ""}) {
        EXPECT_THAT(refused(2, overlap("box.obj", {"--bands", bands})), HasSubstr("--bands")) << bands;
    }
}

TEST_F(OverlapTest, SolidsTouchWhatTheyEnclose) {
    const auto ask = [&](const char* question, const Arguments& more) {
        Arguments all{question, "--volume", path("image.nrrd"), "--mesh", path("around.obj"),
                      "--iso",  "100",      "--format",         "csv",    "--quiet"};
        all.insert(all.end(), more.begin(), more.end());
        return rowsOf(output(all)).at(0);
    };
    EXPECT_EQ(ask("touch", {}).at("touch"), "0");
    const auto inside = ask("touch", {"--solid"});
    EXPECT_EQ(inside.at("touch"), "1");
    EXPECT_EQ(inside.at("triangle"), "");
    EXPECT_LT(std::stod(inside.at("z")), 10);
    EXPECT_GT(std::stod(ask("distance", {}).at("lower")), 8);
    EXPECT_EQ(ask("distance", {"--solid", "--witness", path("near.csv")}).at("upper"), "0");
    const auto near = rowsOf(readText(path("near.csv"))).at(0);
    EXPECT_EQ(near.at("triangle"), "");
    EXPECT_EQ(near.at("mesh_z"), near.at("volume_z"));
}

} // namespace
} // namespace voxtact::test
