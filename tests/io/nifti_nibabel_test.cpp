// SPDX-License-Identifier: MIT
#include "io_test_support.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <random>
#include <sstream>

namespace voxtact::test {
namespace {

/// nibabel's answer for one file.
struct NibabelImage {
    bool ok = false;
    std::array<double, 12> affine{}; ///< rows, RAS, in the file's units
    std::size_t voxels = 0;
    std::vector<double> values; ///< of every so many
    std::string reason;         ///< where it refuses
};

std::vector<NibabelImage> askNibabel(const std::filesystem::path& folder, const std::vector<std::string>& names) {
    std::string command = "cd '" + folder.string() + "' && '" VOXTACT_TEST_PYTHON "' '" VOXTACT_TEST_NIBABEL "'";
    for (const std::string& name : names) {
        command += " " + name;
    }
    std::vector<NibabelImage> images;
    FILE* pipe = ::popen(command.c_str(), "r");
    std::string text;
    std::array<char, 4096> piece{};
    for (std::size_t got = 1; pipe != nullptr && got > 0;) {
        got = std::fread(piece.data(), 1, piece.size(), pipe);
        text.append(piece.data(), got);
    }
    EXPECT_EQ(pipe == nullptr ? -1 : ::pclose(pipe), 0)
        << VOXTACT_TEST_PYTHON " cannot import nibabel: install python3-nibabel";
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string name;
        std::string verdict;
        words >> name >> verdict;
        NibabelImage image;
        image.ok = verdict == "ok";
        image.reason = image.ok ? "" : line;
        std::vector<double> numbers;
        for (std::string word; words >> word;) {
            numbers.push_back(std::strtod(word.c_str(), nullptr));
        }
        if (image.ok) {
            std::copy_n(numbers.begin(), 12, image.affine.begin());
            image.voxels = static_cast<std::size_t>(numbers[12]);
            image.values.assign(numbers.begin() + 13, numbers.end());
        }
        images.push_back(std::move(image));
    }
    return images;
}

/// Random headers, of the kinds that files have and of some that they should not have.
class RandomNifti {
  public:
    explicit RandomNifti(std::uint64_t seed) : random_(seed) {}

    NiftiFile next() {
        NiftiFile file;
        file.second = chance(0.4);
        file.swapped = chance(0.3);
        file.pair = chance(0.2);
        file.sizes = {whole(1, 6), whole(1, 6), whole(1, 6)};
        file.sizes.resize(static_cast<std::size_t>(whole(3, 6)), 1);
        file.units = pick<int>({0, 1, 2, 3, 10, 9, 11});
        for (double& size : file.spacing) {
            size = chance(0.9) ? real(0.01, 5) : pick<double>({0, -1.5, -3});
        }
        file.qfac = chance(0.8) ? pick<double>({-1, 1}) : pick<double>({0, 2, -0.5});
        file.sformCode = chance(0.9) ? static_cast<int>(whole(0, 2)) : pick<int>({3, 4, 5, 6, -1, 77});
        file.qformCode = chance(0.9) ? static_cast<int>(whole(0, 2)) : pick<int>({3, 4, 5, 6, -1, 77});
        for (double& number : file.qoffset) {
            number = real(-200, 200);
        }
        turn(file);
        scale(file);
        if (!file.pair && chance(0.3)) {
            file.extension = extensionOf(file);
        }
        fill(file);
        return file;
    }

    bool chance(double probability) { return real(0, 1) < probability; }

  private:
    double real(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random_); }
    std::int64_t whole(std::int64_t lo, std::int64_t hi) {
        return std::uniform_int_distribution<std::int64_t>(lo, hi)(random_);
    }
    template <class Value> Value pick(std::initializer_list<Value> values) {
        return *(values.begin() + whole(0, static_cast<std::int64_t>(values.size()) - 1));
    }

    /// One comment; its length and code are in the file's byte order.
    std::string extensionOf(const NiftiFile& file) {
        constexpr std::int32_t kComment = 6;
        const auto length = static_cast<std::int32_t>(16 * whole(1, 4));
        std::string extension("\1\0\0\0", 4);
        for (const std::int32_t number : {length, kComment}) {
            std::string raw;
            append(raw, number);
            extension += file.swapped ? std::string(raw.rbegin(), raw.rend()) : raw;
        }
        return extension + std::string(static_cast<std::size_t>(length) - 8, 'e');
    }

    /// A quaternion, and an sform that is another rotation with spacing, sometimes sheared.
    void turn(NiftiFile& file) {
        const auto unit = [&] {
            std::array<double, 4> q{};
            double square = 0;
            for (double& number : q) {
                number = chance(0.2) ? 0 : real(-1, 1);
                square += number * number;
            }
            for (double& number : q) {
                number = square > 0 ? number / std::sqrt(square) : 0;
            }
            return q;
        };
        const auto q = unit();
        file.quaternion = {q[1], q[2], q[3]};
        if (chance(0.05)) {
            file.quaternion[static_cast<std::size_t>(whole(0, 2))] += real(-1, 1);
        }
        const auto [a, b, c, d] = unit();
        const std::array<double, 9> rows{1 - 2 * (c * c + d * d), 2 * (b * c - a * d),     2 * (b * d + a * c),
                                         2 * (b * c + a * d),     1 - 2 * (b * b + d * d), 2 * (c * d - a * b),
                                         2 * (b * d - a * c),     2 * (c * d + a * b),     1 - 2 * (b * b + c * c)};
        const double shear = chance(0.2) ? real(0, 0.2) : 0;
        for (std::size_t row = 0; row < 3; ++row) {
            file.sform[4 * row + 0] = rows[3 * row + 0] * 1.25;
            file.sform[4 * row + 1] = rows[3 * row + 1] * 0.75 + shear * rows[3 * row];
            file.sform[4 * row + 2] = rows[3 * row + 2] * (chance(0.99) ? -2.5 : 0);
            file.sform[4 * row + 3] = real(-300, 300);
        }
    }

    void scale(NiftiFile& file) {
        if (chance(0.5)) {
            file.slope = pick<double>({1, 0, 0.5, -2, 0.001});
            file.intercept = pick<double>({0, 0, -1024, 0.25});
        } else if (chance(0.1)) {
            file.slope = std::numeric_limits<double>::quiet_NaN();
            file.intercept = file.slope;
        } else if (chance(0.1)) {
            file.slope = 2;
            file.intercept = std::numeric_limits<double>::infinity();
        }
    }

    template <class Number> void numbers(NiftiFile& file, std::int16_t type) {
        file.type = type;
        file.bits = sizeof(Number) * 8;
        file.voxels.clear();
        std::int64_t count = 1;
        for (const std::int64_t size : file.sizes) {
            count *= size;
        }
        for (std::int64_t i = 0; i < count; ++i) {
            const double least = std::is_signed_v<Number> ? -100 : 0;
            const auto value =
                static_cast<Number>(std::is_integral_v<Number> ? std::floor(real(least, 100)) : real(-1000, 1000));
            std::string raw;
            append(raw, value);
            file.voxels += file.swapped ? std::string(raw.rbegin(), raw.rend()) : raw;
        }
    }

    void fill(NiftiFile& file) {
        switch (whole(0, 9)) {
        case 0:
            return numbers<std::uint8_t>(file, 2);
        case 1:
            return numbers<std::int16_t>(file, 4);
        case 2:
            return numbers<std::int32_t>(file, 8);
        case 3:
            return numbers<float>(file, 16);
        case 4:
            return numbers<double>(file, 64);
        case 5:
            return numbers<std::int8_t>(file, 256);
        case 6:
            return numbers<std::uint16_t>(file, 512);
        case 7:
            return numbers<std::uint32_t>(file, 768);
        case 8:
            return numbers<std::int64_t>(file, 1024);
        default:
            return numbers<std::uint64_t>(file, 1280);
        }
    }

    std::mt19937_64 random_;
};

double valueAt(const VolumeData& volume, std::size_t i) {
    const auto at = [&]<class Number>(Number number) {
        std::memcpy(&number, volume.voxels.data() + i * sizeof number, sizeof number);
        return static_cast<double>(number);
    };
    switch (volume.type) {
    case ScalarType::UInt8:
        return at(std::uint8_t{});
    case ScalarType::Int16:
        return at(std::int16_t{});
    case ScalarType::UInt16:
        return at(std::uint16_t{});
    case ScalarType::Float32:
        break;
    }
    return at(float{});
}

/// The largest cosine between two columns of an affine; above 1 where a column is nothing.
double shearOf(const std::array<double, 12>& affine) {
    double most = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3;
        double aa = 0;
        double ab = 0;
        double bb = 0;
        for (std::size_t row = 0; row < 3; ++row) {
            aa += affine[4 * row + a] * affine[4 * row + a];
            ab += affine[4 * row + a] * affine[4 * row + b];
            bb += affine[4 * row + b] * affine[4 * row + b];
        }
        most = std::max(most, aa * bb > 0 ? std::abs(ab) / std::sqrt(aa * bb) : 2.0);
    }
    return most;
}

void expectNibabel(const VolumeData& volume, const NibabelImage& nibabel, double unit) {
    const Mat4 world_from_index = worldFromIndex(volume.grid);
    for (std::size_t column = 0; column < 4; ++column) {
        const auto& affine = nibabel.affine;
        // What a header holds is of single precision: so is a column of it as a whole, whatever its elements are.
        const double length = std::hypot(affine[column], affine[4 + column], affine[8 + column]);
        for (std::size_t row = 0; row < 3; ++row) {
            const double said = affine[4 * row + column] * unit * (row < 2 ? -1 : 1);
            ASSERT_NEAR(world_from_index[4 * column + row], said, 1e-7 * unit * std::max(1.0, length));
        }
    }
    ASSERT_EQ(voxelCount(volume.grid), nibabel.voxels);
    const std::size_t step = (nibabel.voxels + 1999) / 2000;
    for (std::size_t i = 0; i < nibabel.values.size(); ++i) {
        ASSERT_EQ(valueAt(volume, i * step), static_cast<double>(static_cast<float>(nibabel.values[i])))
            << "voxel " << i * step;
    }
}

/// Whatever nibabel makes of a header, we make the same, in millimetres and LPS, or refuse it for a reason that is
/// named; and what nibabel refuses, we refuse.
TEST(NiftiNibabel, AgreesOnRandomHeaders) {
    const std::uint64_t seed = std::random_device()();
    std::cout << "seed " << seed << "\n";
    RandomNifti random(seed);
    const TemporaryFolder folder;
    std::vector<NiftiFile> files;
    std::vector<std::string> names;
    constexpr std::size_t kFiles = 400;
    for (std::size_t i = 0; i < kFiles; ++i) {
        files.push_back(random.next());
        const std::string stem = "f" + std::to_string(i);
        const bool zipped = random.chance(0.3);
        if (files.back().pair) {
            folder.write(stem + ".hdr", files.back().bytes());
            folder.write(stem + ".img", files.back().voxels);
            names.push_back(stem + ".hdr");
        } else {
            names.push_back(stem + (zipped ? ".nii.gz" : ".nii"));
            folder.write(names.back(),
                         zipped ? compressed(files.back().bytes(), Wrapping::Gzip) : files.back().bytes());
        }
    }
    const std::vector<NibabelImage> nibabel = askNibabel(folder.path(), names);
    ASSERT_EQ(nibabel.size(), kFiles);
    std::size_t read = 0;
    for (std::size_t i = 0; i < kFiles; ++i) {
        SCOPED_TRACE(names[i] + " of seed " + std::to_string(seed));
        const auto volume = io::readVolume(folder / names[i]);
        const double shear = nibabel[i].ok ? shearOf(nibabel[i].affine) : 0;
        if (!nibabel[i].ok) {
            EXPECT_FALSE(volume.ok()) << "nibabel: " << nibabel[i].reason;
        } else if (shear > std::sin(0.1 * 3.14159265358979 / 180) && !volume.ok()) {
            EXPECT_THAT(volume.error().text, testing::AnyOf(testing::HasSubstr("shears the image by"),
                                                            testing::HasSubstr("mm apart, which cannot be"),
                                                            testing::HasSubstr("singular")));
        } else {
            EXPECT_LT(shear, 0.0018) << "sheared, and not refused";
            ASSERT_TRUE(isOk(volume));
            const int unit = files[i].units & 3;
            expectNibabel(*volume, nibabel[i], unit == 1 ? 1e3 : unit == 3 ? 1e-3 : 1);
            ++read;
        }
    }
    EXPECT_GT(read, kFiles / 2);
}

/// The real files beside the project, where there are some.
TEST(NiftiNibabel, AgreesOnRealFiles) {
    const std::filesystem::path data = sharedData();
    if (data.empty()) {
        GTEST_SKIP() << "no real files here";
    }
    for (const char* name :
         {"volumes/mr_stroke_t1_oblique.nii.gz", "volumes/ct_pitch_oblique.nii.gz",
          "volumes/mr_seg3d_160x232x160.nii.gz", "odd/big.nii.gz", "odd/little.nii.gz", "odd/standard.nii.gz",
          "odd/with_extension.nii.gz", "odd/avg152T1_LR_nifti2.nii.gz", "odd/air.hdr.gz"}) {
        SCOPED_TRACE(name);
        const std::vector<NibabelImage> nibabel = askNibabel(data, {name});
        ASSERT_EQ(nibabel.size(), 1U);
        ASSERT_TRUE(nibabel[0].ok);
        const auto volume = io::readVolume(data / name);
        ASSERT_TRUE(isOk(volume));
        expectNibabel(*volume, nibabel[0], 1);
    }
}

} // namespace
} // namespace voxtact::test
