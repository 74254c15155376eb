// SPDX-License-Identifier: MIT
#include "voxtact/io.h"

#include <gtest/gtest.h>

#include <filesystem>

#include <unistd.h>

namespace voxtact::test {

namespace {

VolumeData someVolume() {
    VolumeData out;
    out.type = ScalarType::UInt8;
    out.grid.size = {200, 180, 160};
    std::uint32_t state = 1;
    for (std::size_t i = 0; i < std::size_t{200} * 180 * 160; ++i) {
        state = state * 1664525U + 1013904223U;
        out.voxels.push_back(static_cast<std::byte>(state >> 24U));
    }
    return out;
}

/// Voxels that do not compress, as a file of several reads.
class ReadProgressOf : public testing::TestWithParam<const char*> {
  protected:
    ReadProgressOf()
        : path_(std::filesystem::path(testing::TempDir()) /
                ("voxtact_progress_" + std::to_string(getpid()) + GetParam())) {
        EXPECT_TRUE(io::writeVolume(path_, someVolume().view()).ok());
    }
    ~ReadProgressOf() override { std::filesystem::remove(path_); }

    std::filesystem::path path_;
};

} // namespace

TEST_P(ReadProgressOf, TellsOfAllBytesInOrder) {
    std::uint64_t last = 0;
    std::uint64_t of = 0;
    io::VolumeReadOptions options;
    options.progress = [&](std::uint64_t done, std::uint64_t all) {
        EXPECT_LE(last, done);
        EXPECT_LE(done, all);
        last = done;
        of = all;
        return true;
    };
    const Result<VolumeData> volume = io::readVolume(path_, options);
    ASSERT_TRUE(volume.ok()) << volume.error().text;
    EXPECT_EQ(volume->voxels, io::readVolume(path_)->voxels);
    EXPECT_EQ(of, std::filesystem::file_size(path_));
    EXPECT_EQ(last, of);
}

TEST_P(ReadProgressOf, EndsTheReading) {
    io::VolumeReadOptions options;
    options.progress = [](std::uint64_t, std::uint64_t) { return false; };
    const Result<VolumeData> volume = io::readVolume(path_, options);
    ASSERT_FALSE(volume.ok());
    EXPECT_EQ(volume.error().code, ErrorCode::Cancelled) << volume.error().text;
}

INSTANTIATE_TEST_SUITE_P(Io, ReadProgressOf, testing::Values(".nii", ".nii.gz", ".nrrd", ".mha"));

} // namespace voxtact::test
