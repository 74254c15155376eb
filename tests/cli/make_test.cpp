// SPDX-License-Identifier: MIT
// voxtact make, and that what it writes is what the builtins are.
#include "child.h"

#include <cmath>
#include <csignal>
#include <sstream>
#include <unistd.h>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr const char* kFirst = "-0.8522518888796717 0.23358694423290272 -0.4680853099435682 9.108038504113518 "
                               "0.1402831209323217 0.9640505443754803 0.2256705427627353 -5.573363836863345 "
                               "0.5039715903525903 0.12666367819258506 -0.8543822029655148 -0.2414962077140359 "
                               "0 0 0 1";
constexpr const char* kSecond = "0.6491305140489306 0.12842130121046663 -0.7497583244792829 -7.589173205289717 "
                                "-0.49744638311850203 -0.6740103779668378 -0.5461292029504747 3.4725630901236855 "
                                "-0.5754795145379996 0.727473696973582 -0.3736379913214092 12.165863838185984 "
                                "0 0 0 1";

class MakeTest : public CliTest {
  protected:
    static std::string makePoses(const Arguments& more) {
        Arguments all{"make", "poses", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500"};
        all.insert(all.end(), more.begin(), more.end());
        return output(all);
    }
};

class MakeDetectTest : public CliDeviceTest {
  protected:
    static std::string count(const std::string& volume, const std::string& mesh) {
        const auto lines = linesOf(output({"count", "--volume", volume, "--mesh", mesh}));
        return fieldsOf(lines.at(1)).at(4);
    }
};

std::vector<double> numbersInText(const std::string& line) {
    std::istringstream stream(line);
    std::vector<double> numbers;
    for (double number = 0; stream >> number;) {
        numbers.push_back(number);
    }
    return numbers;
}

TEST_F(MakeDetectTest, MeshFilesAreTheBuiltin) {
    const std::string expected = count("builtin:head:30", "builtin:scalpel:500");
    EXPECT_NE(expected, "0");
    for (const char* name : {"scalpel.stl", "scalpel.obj", "scalpel.ply"}) {
        output({"make", "mesh", "builtin:scalpel:500", path(name)});
        EXPECT_EQ(count("builtin:head:30", path(name)), expected) << name;
    }
}

TEST_F(MakeDetectTest, VolumeFilesAreTheBuiltin) {
    // int16, anisotropic, oblique.
    const std::string expected = count("builtin:ct:32", "builtin:scalpel:500");
    EXPECT_NE(expected, "0");
    for (const char* name : {"ct.nii", "ct.nii.gz", "ct.nrrd", "ct.mha"}) {
        output({"make", "volume", "builtin:ct:32", path(name)});
        EXPECT_EQ(count(path(name), "builtin:scalpel:500"), expected) << name;
    }
    EXPECT_EQ(filesInFolder(), 4U);
}

TEST_F(MakeTest, EndingsThatAreNone) {
    EXPECT_THAT(refused(2, {"make", "mesh", "builtin:scalpel:500", path("scalpel.docx")}), HasSubstr("scalpel.docx"));
    EXPECT_THAT(refused(2, {"make", "volume", "builtin:head:18", path("head.png")}), HasSubstr("head.png"));
    EXPECT_EQ(filesInFolder(), 0U);
}

TEST_F(MakeTest, WhatCannotBeMadeIsNamedAsItWasGiven) {
    EXPECT_EQ(
        refused(2, {"make", "mesh", "builtin:scalpel:1", path("one.stl")}),
        "voxtact make mesh: SOURCE 'builtin:scalpel:1': a scalpel with 1 triangle is not possible: the shape needs "
        "at least 86\n");
    EXPECT_THAT(refused(2, {"make", "mesh", "builtin:ellipsoid:2", path("two.stl")}), HasSubstr("with 2 triangles is"));
    EXPECT_THAT(refused(2, {"make", "volume", "builtin:head:0", path("none.nii")}),
                AllOf(HasSubstr("make volume: SOURCE 'builtin:head:0': "), Not(HasSubstr("--volume"))));
    EXPECT_EQ(filesInFolder(), 0U);
}

TEST_F(MakeTest, PosesSayWhereTheyComeFrom) {
    const auto lines = linesOf(makePoses({"--number", "3", "--seed", "18446744073709551615"}));
    ASSERT_EQ(lines.size(), 5U);
    EXPECT_THAT(lines[0], AllOf(HasSubstr("seed 18446744073709551615"), HasSubstr("builtin:head:18"),
                                HasSubstr("builtin:scalpel:500")));
}

TEST_F(MakeTest, PosesAreTheSameEverywhere) {
    // Written down once: another machine, compiler or library must give the same bits.
    writeNifti(path("box.nii"), {});
    writeText(path("triangle.obj"), "v 0 0 0\nv 10 0 0\nv 0 10 0\nf 1 2 3\n");
    const auto lines = linesOf(output({"make", "poses", "--volume", path("box.nii"), "--mesh", path("triangle.obj"),
                                       "--number", "2", "--seed", "1"}));
    ASSERT_EQ(lines.size(), 4U);
    EXPECT_EQ(lines[2], kFirst);
    EXPECT_EQ(lines[3], kSecond);
}

TEST_F(MakeTest, PosesDependOnTheSeedAndNotOnTheCount) {
    const auto few = linesOf(makePoses({"--number", "3", "--seed", "5"}));
    const auto many = linesOf(makePoses({"--number", "9", "--seed", "5"}));
    const auto other = linesOf(makePoses({"--number", "3", "--seed", "6"}));
    for (std::size_t i = 2; i < 5; ++i) {
        EXPECT_EQ(few.at(i), many.at(i));
        EXPECT_NE(few.at(i), other.at(i));
    }
}

TEST_F(MakeTest, PosesAreRigidAndNearTheVolume) {
    const auto lines = linesOf(makePoses({"--number", "200"}));
    ASSERT_EQ(lines.size(), 202U);
    for (std::size_t i = 2; i < lines.size(); ++i) {
        const auto m = numbersInText(lines[i]); // row by row
        ASSERT_EQ(m.size(), 16U);
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t b = 0; b < 3; ++b) {
                const double dot = m[a] * m[b] + m[4 + a] * m[4 + b] + m[8 + a] * m[8 + b];
                EXPECT_NEAR(dot, a == b ? 1 : 0, 1e-12);
            }
            // 100 mm to the volume's face, a tenth of its side beside it, 150 mm of scalpel.
            EXPECT_LT(std::abs(m[4 * a + 3]), 100 + 20 + 160);
        }
        const double determinant = m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
                                   m[2] * (m[4] * m[9] - m[5] * m[8]);
        EXPECT_NEAR(determinant, 1, 1e-12);
        EXPECT_EQ(std::vector<double>(m.begin() + 12, m.end()), (std::vector<double>{0, 0, 0, 1}));
    }
}

TEST_F(MakeTest, PosesOfOnePairOnly) {
    EXPECT_THAT(refused(2, {"make", "poses", "--volume", "builtin:head:18", "--volume", "builtin:ct:16", "--mesh",
                            "builtin:scalpel:500"}),
                HasSubstr("--volume, --mesh: give each once"));
    for (const char* seed : {"-1", "1.5", "0x10", "18446744073709551616"}) {
        EXPECT_THAT(refused(2, {"make", "poses", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500",
                                "--seed", seed}),
                    AllOf(HasSubstr("--seed"), HasSubstr(seed)));
    }
    EXPECT_THAT(
        refused(2, {"make", "poses", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500", "--number", "0"}),
        HasSubstr("--number"));
}

TEST_F(MakeTest, InterruptedItLeavesNoFile) {
    const Arguments poses{"make",   "poses", "--volume", "builtin:head:18", "--mesh",   "builtin:scalpel:500",
                          "--seed", "7",     "--number", "2000000",         "--output", path("made.txt")};
    const Arguments volume{"make", "volume", "builtin:noise:200", path("made.nii.gz")};
    for (const auto& [command, signal] :
         {std::pair(poses, SIGINT), std::pair(poses, SIGTERM), std::pair(volume, SIGHUP)}) {
        Child child(command);
        for (int i = 0; i < 6000 && filesInFolder() < 1; ++i) {
            ::usleep(10000);
        }
        EXPECT_EQ(filesInFolder(), 1U); // the temporary one
        child.signal(signal);
        const Ran ran = child.end();
        EXPECT_EQ(ran.status, 128 + signal);
        EXPECT_THAT(ran.err, AllOf(testing::StartsWith("voxtact make " + command[1] + ": interrupted by SIG"),
                                   testing::EndsWith(": nothing is written\n")));
        EXPECT_EQ(filesInFolder(), 0U);
    }
}

} // namespace
} // namespace voxtact::test
