// SPDX-License-Identifier: MIT
// As memory_test.cpp, of files: none is read in part.
#include "memory_sweep.h"

#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace voxtact::test {
namespace {

/// Lines that begin with their number, each longer than those before it, so that reading them needs more memory.
class FilesMemory : public testing::Test {
  protected:
    static constexpr std::size_t kLines = 5;

    ~FilesMemory() override {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }

    [[nodiscard]] const char* write(const std::string& rest) const {
        std::ofstream file(path_, std::ios::binary);
        for (std::size_t i = 0; i < kLines; ++i) {
            const auto blanks = std::size_t{20} << (2 * i);
            file << i + 1 << std::string(blanks, ' ') << rest << "\n";
        }
        file.close();
        return path_.c_str();
    }

  private:
    std::filesystem::path path_ =
        std::filesystem::temp_directory_path() / ("voxtact_files_memory_" + std::to_string(::getpid()) + ".txt");
};

/// Reading `Handle`, of which `countOf` tells how many there are.
template <class Handle>
void expectWhole(const char* what, void (*destroy)(Handle*), auto read, auto countOf, std::size_t count) {
    expectTightCreation<Handle>(what, destroy, read, [&](const Handle& handle) { EXPECT_EQ(countOf(&handle), count); });
}

TEST_F(FilesMemory, OfPoses) {
    const char* const path = write("0 0 0  0 1 0 0  0 0 1 0  0 0 0 1");
    expectWhole<vxt_poses>(
        "poses", vxt_poses_destroy, [&](auto out) { return vxt_read_poses(path, nullptr, out); },
        [](const vxt_poses* poses) {
            std::size_t count = 0;
            return vxt_poses_get(poses, &count) != nullptr ? count : 0;
        },
        kLines);
}

TEST_F(FilesMemory, OfPosesSomeAtATime) {
    const char* const path = write("0 0 0  0 1 0 0  0 0 1 0  0 0 0 1");
    std::size_t count = 0;
    expectTight(
        "pose reader",
        [&] {
            vxt_pose_reader* reader = nullptr;
            double poses[kLines * 16];
            vxt_result result = vxt_pose_reader_open(path, nullptr, &reader);
            if (result == VXT_OK) {
                result = vxt_pose_reader_read(reader, poses, kLines, &count);
            }
            vxt_pose_reader_destroy(reader);
            return result;
        },
        [&] { EXPECT_EQ(count, kLines); });
}

TEST_F(FilesMemory, OfPoints) {
    const char* const path = write("2 3 a_name_of_a_point_that_no_short_string_holds");
    expectWhole<vxt_points>(
        "points", vxt_points_destroy, [&](auto out) { return vxt_read_points(path, out); },
        [](const vxt_points* points) {
            std::size_t count = 0;
            while (vxt_points_get(points, count, nullptr, nullptr) != nullptr) {
                ++count;
            }
            return count;
        },
        kLines);
}

TEST_F(FilesMemory, OfLabelNames) {
    const char* const path = write("liver");
    expectWhole<vxt_label_names>(
        "label names", vxt_label_names_destroy, [&](auto out) { return vxt_read_label_names(path, out); },
        [](const vxt_label_names* names) {
            std::size_t count = 0;
            while (vxt_label_names_get(names, count, nullptr) != nullptr) {
                ++count;
            }
            return count;
        },
        kLines);
}

TEST_F(FilesMemory, OfControlPoints) {
    const char* const path = write("0.5");
    expectWhole<vxt_control_points>(
        "control points", vxt_control_points_destroy, [&](auto out) { return vxt_read_transfer_function(path, out); },
        [](const vxt_control_points* points) {
            std::size_t count = 0;
            return vxt_control_points_get(points, &count) != nullptr ? count : 0;
        },
        kLines);
}

} // namespace
} // namespace voxtact::test
