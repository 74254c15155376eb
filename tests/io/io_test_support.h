// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::test {

/// An empty folder, removed with everything in it.
class TemporaryFolder {
  public:
    TemporaryFolder();
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder();

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    std::filesystem::path write(const std::string& name, std::string_view content) const;
    [[nodiscard]] std::size_t entries() const;

  private:
    std::filesystem::path path_;
};

[[nodiscard]] std::string contentOf(const std::filesystem::path& path);

/// VOXTACT_TEST_DATA, or the folder `shared/data` beside the project; empty where there is none.
[[nodiscard]] std::filesystem::path sharedData();

template <class Number> void append(std::string& bytes, Number number) {
    char raw[sizeof number];
    std::memcpy(raw, &number, sizeof raw);
    bytes.append(raw, sizeof raw);
}

enum class Wrapping { Gzip, Zlib };
[[nodiscard]] std::string compressed(std::string_view content, Wrapping wrapping);

/// A NIfTI file by hand.
struct NiftiFile {
    bool second = false;  ///< NIfTI-2
    bool swapped = false; ///< header in the other byte order; `voxels` are taken as they are
    bool pair = false;    ///< the magic of a header that has its voxels in another file
    std::vector<std::int64_t> sizes{4, 3, 2};
    std::int16_t type = 2;
    std::int16_t bits = 8;
    std::array<double, 3> spacing{1, 1, 1};
    double qfac = 1;
    int units = 0;
    std::array<double, 12> sform{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}; ///< rows of world_from_index, RAS
    int sformCode = 1;
    int qformCode = 0;
    std::array<double, 3> quaternion{}; ///< b, c, d
    std::array<double, 3> qoffset{};
    double slope = 0;
    double intercept = 0;
    std::string extension = std::string(4, '\0'); ///< what lies between the header and the voxels
    std::string voxels = std::string(24, '\7');

    /// In NIfTI-1 the reals are floats. Without `extension` and voxels for a pair.
    [[nodiscard]] std::string bytes() const;
};

/// The one line of a refusal names the file and says `reason`.
template <class Value>
void expectRefused(const Result<Value>& result, std::string_view reason, const std::filesystem::path& file = {}) {
    ASSERT_FALSE(result.ok()) << "accepted, expected: " << reason;
    EXPECT_THAT(result.error().text, testing::HasSubstr(std::string(reason)));
    EXPECT_THAT(result.error().text, testing::HasSubstr(file.string()));
    EXPECT_EQ(result.error().text.find('\n'), std::string::npos) << result.error().text;
    EXPECT_FALSE(result.error().text.ends_with('.')) << result.error().text;
}

template <class Value> [[nodiscard]] testing::AssertionResult isOk(const Result<Value>& result) {
    return result.ok() ? testing::AssertionSuccess() : testing::AssertionFailure() << result.error().text;
}

} // namespace voxtact::test
