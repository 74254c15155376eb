// SPDX-License-Identifier: MIT
// Files that are cut, and files with flipped bits: one line, or a mesh; never a crash.
#include "cad_files.h"
#include "cli/cli_fixture.h"
#include "support/scenes.h"
#include "voxtact/io.h"

#include <random>

namespace voxtact::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class StepDamage : public CliTest {
  protected:
    [[nodiscard]] std::string whole(const std::string& name) const {
        writeCad(path(name), cadCases().at(6).shape);
        return readText(path(name));
    }
};

TEST_F(StepDamage, TruncatedFilesAreRefused) {
    for (const char* name : {"m.step", "m.igs"}) {
        const std::string content = whole(name);
        for (int part = 0; part < 20; ++part) {
            writeText(path(name), content.substr(0, content.size() * static_cast<std::size_t>(part) / 20));
            EXPECT_THAT(refused(1, {"info", path(name)}), HasSubstr(part == 0 ? "is empty" : "it is truncated"));
        }
        // At the end of a line.
        writeText(path(name), content.substr(0, content.rfind('\n', content.size() - 2) + 1));
        EXPECT_THAT(refused(1, {"info", path(name)}), HasSubstr("it is truncated"));
    }
}

TEST_F(StepDamage, WhatIsMissingInTheMiddleIsRefused) {
    const std::string content = whole("m.step");
    std::string cut = content;
    const std::size_t face = cut.find("= ADVANCED_FACE(");
    ASSERT_NE(face, std::string::npos);
    const std::size_t line = cut.rfind('#', face);
    cut.erase(line, cut.find(';', face) + 1 - line);
    writeText(path("m.step"), cut);
    EXPECT_THAT(refused(1, {"info", path("m.step")}), HasSubstr("m.step"));
    writeText(path("m.step"), "ISO-10303-21;\nHEADER;\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n");
    EXPECT_THAT(refused(1, {"info", path("m.step")}), HasSubstr("m.step"));
}

TEST_F(StepDamage, FlippedBitsGiveOneLineOrAMesh) {
    std::mt19937 random(7);
    std::size_t refusals = 0;
    const int count = longTests() ? 300 : 25;
    for (const char* name : {"m.step", "m.igs"}) {
        const std::string content = whole(name);
        for (int i = 0; i < count; ++i) {
            std::string damaged = content;
            for (unsigned bits = 0; bits <= random() % 3; ++bits) {
                damaged[random() % damaged.size()] ^= static_cast<char>(1U << random() % 8);
            }
            writeText(path(name), damaged);
            const auto mesh = io::readMesh(path(name), {.space = {}, .deflection = 0.3});
            if (mesh.ok()) {
                EXPECT_TRUE(checkMesh(mesh->view()).ok());
                continue;
            }
            ++refusals;
            EXPECT_THAT(mesh.error().text, StartsWith("cannot read '" + path(name) + "': "));
            EXPECT_THAT(mesh.error().text, Not(HasSubstr("\n")));
            EXPECT_NE(mesh.error().code, ErrorCode::Internal);
        }
    }
    EXPECT_GT(refusals, 0U);
}

} // namespace
} // namespace voxtact::test
