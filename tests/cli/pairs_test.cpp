// SPDX-License-Identifier: MIT
// voxtact count leaves out pairs whose boxes are apart: no answer may change by it.
#include "cli_fixture.h"

#include <cmath>
#include <random>
#include <sstream>

namespace voxtact::test {
namespace {

/// Poses of all kinds: through the volume, at its faces, far from it, turned, and beside a far origin.
std::string randomPoses(int count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> place(-1, 1);
    std::ostringstream text;
    text.precision(17);
    for (int i = 0; i < count; ++i) {
        // A rotation from a random unit quaternion.
        double q[4] = {normal(random), normal(random), normal(random), normal(random)};
        const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
        for (double& part : q) {
            part /= length;
        }
        const auto [w, x, y, z] = q;
        const double reach = i % 4 == 0 ? 60 : i % 4 == 1 ? 130 : i % 4 == 2 ? 260 : 1e5;
        const double rows[3][4] = {
            {1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), place(random) * reach},
            {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), place(random) * reach},
            {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), place(random) * reach}};
        for (const auto& row : rows) {
            for (const double number : row) {
                text << number << ' ';
            }
        }
        text << "0 0 0 1\n";
    }
    return text.str();
}

class DetectPairsTest : public CliDeviceTest {
  protected:
    /// Lines without the last two columns, and without the comment.
    static std::vector<std::string> withoutTimes(const std::string& csv) {
        std::vector<std::string> lines;
        for (const std::string& line : linesOf(csv)) {
            if (!line.starts_with('#')) {
                lines.push_back(line.substr(0, line.rfind(',', line.rfind(',') - 1)));
            }
        }
        return lines;
    }
};

TEST_F(DetectPairsTest, NoAnswerChanges) {
    const std::uint32_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    writeText(path("poses.txt"), randomPoses(200, seed));
    for (const Arguments& how :
         {Arguments{"--method", "cpu"}, Arguments{"--method", "cpu", "--projection", "view"},
          Arguments{"--method", "cpu", "--projection", "two-view"},
          Arguments{"--method", "cpu", "--projection", "dominant-axis"}, Arguments{"--method", "query"},
          Arguments{"--method", "query-any"}, Arguments{"--method", "atomic", "--projection", "dominant-axis"}}) {
        Arguments skipping{"count",
                           "--volume",
                           "builtin:head:30",
                           "--volume",
                           "builtin:ct:32",
                           "--mesh",
                           "builtin:ellipsoid:500",
                           "--mesh",
                           "builtin:scalpel:500",
                           "--poses",
                           path("poses.txt"),
                           "--bounds"};
        skipping.insert(skipping.end(), how.begin(), how.end());
        Arguments all = skipping;
        all.push_back("--timing"); // times are of every pair: nothing is left out
        const auto lines = linesOf(output(skipping));
        EXPECT_EQ(lines.size(), 801U);
        EXPECT_EQ(lines, withoutTimes(output(all))) << testing::PrintToString(how);
    }
}

TEST_F(DetectPairsTest, WithClampNothingIsLeftOut) {
    // An image that is opaque everywhere: clamped, what lies outside of it counts.
    writeNifti(path("full.nii"), {.value = 100});
    writeText(path("far.txt"), "1 0 0 30 0 1 0 0 0 0 1 0 0 0 0 1\n");
    // The view looks at all of it: 400 mm per side.
    writeText(path("camera.txt"), "0.005 0 0 0\n0 0.005 0 0\n0 0 -0.002 0.5\n0 0 0 1\n");
    const Arguments arguments{"count",   "--volume",      path("full.nii"), "--mesh",           "builtin:scalpel:500",
                              "--poses", path("far.txt"), "--camera",       path("camera.txt"), "--method",
                              "cpu",     "--projection",  "view",           "--opacity",        "0:1"};
    const auto count = [&](const char* boundary) {
        Arguments all = arguments;
        all.insert(all.end(), {"--boundary", boundary});
        const Ran ran = run(all); // the mesh is far away, which a note says
        EXPECT_EQ(ran.status, 0) << ran.err;
        return fieldsOf(linesOf(ran.out).at(1)).at(4);
    };
    EXPECT_EQ(count("range"), "0");
    EXPECT_NE(count("clamp"), "0");
}

} // namespace
} // namespace voxtact::test
