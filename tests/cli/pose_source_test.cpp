// SPDX-License-Identifier: MIT
// Files of poses that are read more than once: what is there the second time is what was counted the first.
#include "cli/pairs/pose_source.h"
#include "cli_fixture.h"
#include "support/take.h"

namespace voxtact::test {
namespace {

class PoseSourceTest : public CliTest {
  protected:
    static std::string lines(std::size_t count) {
        std::string text;
        for (std::size_t i = 0; i < count; ++i) {
            text += "1 0 0 0  0 1 0 0  0 0 1 0  0 0 0 1\n";
        }
        return text;
    }
    /// All that it gives.
    static Result<std::size_t> readAll(app::PoseSource& source) {
        constexpr std::size_t kAtOnce = 4096;
        std::size_t count = 0;
        std::vector<Mat4> poses;
        if (const Result<void> begun = source.begin(); !begun.ok()) {
            return begun.error();
        }
        do {
            if (const Result<void> read = source.next(kAtOnce, poses); !read.ok()) {
                return read.error();
            }
            count += poses.size();
        } while (poses.size() == kAtOnce);
        return count;
    }
};

TEST_F(PoseSourceTest, AFileThatChangesIsNoticed) {
    constexpr std::size_t kPoses = 70000; // more than are kept
    writeText(path("poses.txt"), lines(kPoses));
    app::PoseSource source = take(app::PoseSource::open({.poses = path("poses.txt")}, true));
    EXPECT_EQ(source.count(), kPoses);
    EXPECT_EQ(take(readAll(source)), kPoses);
    for (const std::size_t other : {kPoses - 1, kPoses - 20000, std::size_t{0}, kPoses + 1}) {
        writeText(path("poses.txt"), lines(other));
        const Result<std::size_t> read = readAll(source);
        ASSERT_FALSE(read.ok()) << other << ", " << *read;
    }
}

} // namespace
} // namespace voxtact::test
