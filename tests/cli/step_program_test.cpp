// SPDX-License-Identifier: MIT
// STEP and IGES without OpenCASCADE: the program beside ours is missing, fails, crashes, or writes what it should not.
#include "cli_fixture.h"
#include "io/mesh/cad_stream.h"

#include <array>
#include <limits>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string bytesOf(const void* data, std::size_t size) {
    return {static_cast<const char*>(data), size};
}

/// What voxtact-step writes of one triangle.
std::string stream(const io::CadHeader& changed = {}, std::uint32_t lastVertex = 2) {
    io::CadHeader header = changed;
    const std::string text = "lengths in INCH are converted to mm\n";
    header.textBytes = text.size();
    header.vertices = 3;
    header.triangles = 1;
    const std::array<double, 9> vertices{0, 0, 0, 20, 0, 0, 0, 30, 0};
    const std::array<std::uint32_t, 3> corners{0, 1, lastVertex};
    return bytesOf(&header, sizeof header) + text + bytesOf(vertices.data(), sizeof vertices) +
           bytesOf(corners.data(), sizeof corners);
}

class StepProgramTest : public CliTest {
  protected:
    StepProgramTest() {
        std::filesystem::create_directory(path("bin"));
        alone_.program = path("bin/voxtact");
        std::filesystem::copy_file(builtProgram(), alone_.program);
        writeText(path("m.step"), "ISO-10303-21;\nEND-ISO-10303-21;\n");
        writeText(path("m.igs"), std::string(72, ' ') + "S      1\n" + std::string(72, ' ') + "T      1\n");
    }
    /// A script in the place of voxtact-step.
    void beside(const std::string& script) const {
        writeText(path("bin/voxtact-step"), "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(path("bin/voxtact-step"), std::filesystem::perms::owner_all);
    }
    [[nodiscard]] std::string info(const std::string& name) const { return refused(1, {"info", path(name)}, alone_); }
    /// It writes this.
    [[nodiscard]] std::string infoOf(const std::string& written) const {
        writeText(path("stream"), written);
        beside("cat '" + path("stream") + "'");
        return info("m.step");
    }

    RunOptions alone_;
};

TEST_F(StepProgramTest, IsMissing) {
    for (const char* name : {"m.step", "m.igs"}) {
        EXPECT_THAT(info(name),
                    AllOf(HasSubstr(path(name)),
                          HasSubstr("need voxtact-step in the folder of the program or library; build it with "
                                    "-DVOXTACT_BUILD_STEP=ON (Debian: libocct-data-exchange-dev)")));
    }
    writeText(path("m.stp"), "ISO-10303-21;\n");
    writeText(path("m.iges"), "no IGES\n");
    for (const char* name : {"m.stp", "m.iges"}) {
        EXPECT_THAT(info(name), HasSubstr("it is truncated: its end is missing"));
    }
}

TEST_F(StepProgramTest, WritesAMesh) {
    io::CadHeader header;
    header.deflection = 0.01234;
    header.looseEdges = 2;
    writeText(path("stream"), stream(header));
    beside("[ \"$2\" = 0.005 ] && [ \"$1\" = '" + path("m.step") + "' ] && cat '" + path("stream") + "'");
    const Ran ran = run({"info", path("m.step"), "--deflection", "0.005"}, alone_);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_THAT(ran.err,
                AllOf(HasSubstr("lengths in INCH are converted to mm"), HasSubstr("2 points or lines left out"),
                      HasSubstr("triangles are up to 0.0124 mm off the curved surface")));
    EXPECT_EQ(rowsOf(ran.out).front().at("max_y"), "30");
    // A deflection in mm of a mesh that is scaled.
    beside("[ \"$2\" = 0.001 ] && cat '" + path("stream") + "'");
    const Ran scaled = run({"info", path("m.step"), "--deflection", "0.002", "--mesh-scale", "2"}, alone_);
    EXPECT_THAT(scaled.err, HasSubstr("triangles are up to 0.0247 mm off the curved surface")) << scaled.out;
}

TEST_F(StepProgramTest, Fails) {
    beside("kill -SEGV $$");
    EXPECT_THAT(info("m.step"), HasSubstr("OpenCASCADE crashed on it (signal 11); repair the file"));
    beside("exit 1");
    EXPECT_THAT(info("m.igs"), HasSubstr("voxtact-step wrote no mesh; is it of another version?"));
    writeText(path("bin/voxtact-step"), "no program");
    EXPECT_THAT(info("m.step"), HasSubstr("voxtact-step cannot be started: "));
}

TEST_F(StepProgramTest, WritesWhatItShouldNot) {
    const std::string whole = stream();
    for (const std::size_t size : {std::size_t{0}, std::size_t{10}, whole.size() - 1}) {
        EXPECT_THAT(infoOf(whole.substr(0, size)), HasSubstr("wrote no mesh"));
    }
    EXPECT_THAT(infoOf(whole + "x"), HasSubstr("wrote no mesh"));
    io::CadHeader other;
    other.magic.back() = '9';
    EXPECT_THAT(infoOf(stream(other)), HasSubstr("wrote no mesh"));
    EXPECT_THAT(infoOf(stream({}, 3)), HasSubstr("wrote numbers of vertices that are not there"));
    for (const double bad : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        io::CadHeader header;
        header.deflection = bad;
        EXPECT_THAT(infoOf(stream(header)), HasSubstr("the deflection of the mesh is not a number from 0 mm on"));
    }
    io::CadHeader refusal;
    const std::string reason = "line 1\nline 2\x1b";
    refusal.textBytes = reason.size();
    EXPECT_THAT(infoOf(bytesOf(&refusal, sizeof refusal) + reason), HasSubstr("m.step': line 1 line 2\\x1b"));
}

} // namespace
} // namespace voxtact::test
