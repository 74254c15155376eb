// SPDX-License-Identifier: MIT
#include "io_test_support.h"

#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>
#include <itkObject.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <sstream>

namespace voxtact::test {
namespace {

/// NRRD and MetaImage headers that ITK reads as well: what it makes of them is what we must make of them.
class RandomHeaders {
  public:
    explicit RandomHeaders(std::uint64_t seed) : random_(seed) {}

    std::string nrrd() {
        sizes_ = {whole(1, 5), whole(1, 5), whole(1, 5)};
        const bool wide = chance(0.5);
        const bool big = chance(0.5);
        std::ostringstream text;
        text.precision(17);
        text << "NRRD000" << whole(4, 5) << "\n# by a test\ntype: " << (wide ? "short" : "uint8") << "\ndimension: 3\n";
        const bool space = chance(0.7);
        if (space) {
            text << "space: "
                 << pick({"left-posterior-superior", "right-anterior-superior", "LPS", "RAS", "scanner-xyz",
                          "3D-right-handed"})
                 << "\nspace directions:";
            for (int axis = 0; axis < 3; ++axis) {
                text << (chance(0.5) ? " (" : "  (") << real() << "," << (chance(0.3) ? " " : "") << real() << ","
                     << real() << ")";
            }
            text << "\nspace origin: (" << real() << "," << real() << "," << real() << ")\n";
        } else {
            spacingsAndMins(text);
        }
        text << "sizes: " << sizes_[0] << " " << sizes_[1] << " " << sizes_[2] << "\nkinds: domain domain domain\n"
             << "endian: " << (big ? "big" : "little") << "\n";
        return withVoxels(text, wide);
    }

    std::string meta() {
        sizes_ = {whole(1, 5), whole(1, 5), whole(1, 5)};
        const bool wide = chance(0.5);
        std::ostringstream text;
        text.precision(17);
        text << "ObjectType = Image\nNDims = 3\nBinaryData = True\n"
             << pick({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}) << " = " << pick({"True", "False"}) << "\n";
        if (chance(0.8)) {
            text << pick({"TransformMatrix", "Rotation", "Orientation"}) << " =";
            for (const double number : rotation()) {
                text << " " << number;
            }
            text << "\n";
        }
        if (chance(0.8)) {
            text << pick({"Offset", "Position", "Origin"}) << " = " << real() << " " << real() << " " << real() << "\n";
        }
        if (chance(0.8)) {
            text << pick({"ElementSpacing", "ElementSize"}) << " = " << size() << " " << size() << " " << size()
                 << "\n";
        }
        const bool zipped = chance(0.5);
        const std::string voxels = noise(wide);
        const std::string stored = zipped ? compressed(voxels, Wrapping::Zlib) : voxels;
        if (zipped) {
            text << "CompressedData = True\nCompressedDataSize = " << stored.size() << "\n";
        }
        text << "DimSize = " << sizes_[0] << " " << sizes_[1] << " " << sizes_[2]
             << "\nElementType = " << (wide ? "MET_SHORT" : "MET_UCHAR") << "\nElementDataFile = LOCAL\n";
        return text.str() + stored;
    }

    /// An image at a random place, one in two left-handed.
    VolumeData volume() {
        sizes_ = {whole(2, 5), whole(2, 5), whole(2, 5)};
        VolumeData made;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            made.grid.size[axis] = static_cast<std::uint32_t>(sizes_[axis]);
            made.grid.spacing[axis] = size();
            made.grid.origin[axis] = real();
        }
        made.grid.direction = rotation();
        if (chance(0.5)) {
            std::swap_ranges(made.grid.direction.begin(), made.grid.direction.begin() + 3,
                             made.grid.direction.begin() + 3);
        }
        made.type = chance(0.5) ? ScalarType::UInt16 : ScalarType::UInt8;
        for (const char byte : noise(made.type == ScalarType::UInt16)) {
            made.voxels.push_back(static_cast<std::byte>(byte));
        }
        return made;
    }

  private:
    double uniform(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random_); }
    double real() { return uniform(-100, 100); }
    double size() { return uniform(0.1, 9); }
    bool chance(double probability) { return uniform(0, 1) < probability; }
    int whole(int lo, int hi) { return std::uniform_int_distribution<int>(lo, hi)(random_); }
    const char* pick(std::initializer_list<const char*> texts) {
        return *(texts.begin() + whole(0, static_cast<int>(texts.size()) - 1));
    }

    void spacingsAndMins(std::ostringstream& text) {
        const bool spacings = chance(0.7);
        if (spacings) {
            text << "spacings: " << size() << " " << size() << " " << size() << "\n";
        }
        if (spacings && chance(0.5)) {
            text << "axis mins: " << real() << " " << real() << " " << real() << "\n";
            if (chance(0.7)) {
                const char* where = pick({"cell", "node"});
                text << "centers: " << where << " " << where << " " << where << "\n";
            }
        }
    }

    std::array<double, 9> rotation() {
        double a = uniform(-1, 1);
        double b = uniform(-1, 1);
        double c = uniform(-1, 1);
        double d = uniform(-1, 1);
        const double norm = std::sqrt(a * a + b * b + c * c + d * d);
        a /= norm, b /= norm, c /= norm, d /= norm;
        return {1 - 2 * (c * c + d * d), 2 * (b * c - a * d),     2 * (b * d + a * c),
                2 * (b * c + a * d),     1 - 2 * (b * b + d * d), 2 * (c * d - a * b),
                2 * (b * d - a * c),     2 * (c * d + a * b),     1 - 2 * (b * b + c * c)};
    }

    std::string noise(bool wide) {
        std::string voxels(static_cast<std::size_t>(sizes_[0] * sizes_[1] * sizes_[2]) * (wide ? 2 : 1), '\0');
        for (char& byte : voxels) {
            byte = static_cast<char>(whole(0, 255));
        }
        return voxels;
    }

    std::string withVoxels(std::ostringstream& text, bool wide) {
        const std::string voxels = noise(wide);
        const bool zipped = chance(0.5);
        text << "encoding: " << (zipped ? "gzip" : "raw") << "\n\n";
        return text.str() + (zipped ? compressed(voxels, Wrapping::Gzip) : voxels);
    }

    std::mt19937_64 random_;
    std::array<int, 3> sizes_{};
};

void expectSamePlace(const Grid& a, const Grid& b, double tolerance) {
    ASSERT_EQ(a.size, b.size);
    const Mat4 ours = worldFromIndex(a);
    const Mat4 theirs = worldFromIndex(b);
    for (std::size_t i = 0; i < 16; ++i) {
        ASSERT_NEAR(ours[i], theirs[i], tolerance) << "element " << i;
    }
}

/// What ITK reads is the volume.
void expectItk(itk::ImageIOBase& io, const std::filesystem::path& path, const VolumeData& volume, double tolerance) {
    io.SetFileName(path.string());
    io.ReadImageInformation();
    itk::ImageIORegion region(3);
    Grid itk;
    for (unsigned axis = 0; axis < 3; ++axis) {
        itk.size[axis] = static_cast<std::uint32_t>(io.GetDimensions(axis));
        itk.spacing[axis] = io.GetSpacing(axis);
        itk.origin[axis] = io.GetOrigin(axis);
        region.SetSize(axis, io.GetDimensions(axis));
        const std::vector<double> direction = io.GetDirection(axis);
        std::copy(direction.begin(), direction.end(), itk.direction.begin() + 3 * axis);
    }
    io.SetIORegion(region);
    expectSamePlace(volume.grid, itk, tolerance);
    std::vector<std::byte> voxels(static_cast<std::size_t>(io.GetImageSizeInBytes()));
    io.Read(voxels.data());
    ASSERT_EQ(volume.voxels, voxels);
}

/// What ITK reads is what we read.
void expectAsItk(itk::ImageIOBase& io, const std::filesystem::path& path) {
    SCOPED_TRACE(contentOf(path).substr(0, 600));
    const auto volume = io::readVolume(path);
    ASSERT_TRUE(isOk(volume));
    expectItk(io, path, *volume, 1e-11);
}

TEST(ItkJudge, NrrdAndMetaImageAreReadAsItkReadsThem) {
    const std::uint64_t seed = std::random_device()();
    std::cout << "seed " << seed << "\n";
    itk::Object::SetGlobalWarningDisplay(false);
    RandomHeaders random(seed);
    const TemporaryFolder folder;
    for (int i = 0; i < 300 && !testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE("case " + std::to_string(i) + " of seed " + std::to_string(seed));
        expectAsItk(*itk::NrrdImageIO::New(), folder.write("v.nrrd", random.nrrd()));
        expectAsItk(*itk::MetaImageIO::New(), folder.write("v.mha", random.meta()));
    }
}

TEST(ItkJudge, ReadsWhatWeWrite) {
    const std::uint64_t seed = std::random_device()();
    std::cout << "seed " << seed << "\n";
    itk::Object::SetGlobalWarningDisplay(false);
    RandomHeaders random(seed);
    const TemporaryFolder folder;
    for (int i = 0; i < 100 && !testing::Test::HasFailure(); ++i) {
        SCOPED_TRACE("case " + std::to_string(i) + " of seed " + std::to_string(seed));
        const VolumeData volume = random.volume();
        const auto write = [&](const char* name) {
            EXPECT_TRUE(isOk(io::writeVolume(folder / name, volume.view())));
            return folder / name;
        };
        constexpr double kSinglePrecision = 1e-4; // of 100 mm
        expectItk(*itk::NrrdImageIO::New(), write("v.nrrd"), volume, 1e-11);
        expectItk(*itk::MetaImageIO::New(), write("v.mha"), volume, 1e-11);
        expectItk(*itk::NiftiImageIO::New(), write("v.nii"), volume, kSinglePrecision);
        expectItk(*itk::NiftiImageIO::New(), write("v.nii.gz"), volume, kSinglePrecision);
        // A reader that knows the qform alone finds the same place, up to what a quaternion of floats is uncertain by.
        std::string bytes = contentOf(folder / "v.nii");
        constexpr std::size_t kSformCode = 254;
        ASSERT_NE(bytes[kSformCode], 0);
        bytes[kSformCode] = 0;
        const auto byQform = io::readVolume(folder.write("q.nii", bytes));
        ASSERT_TRUE(isOk(byQform));
        constexpr double kQuaternion = 1e-2;
        expectSamePlace(byQform->grid, volume.grid, kQuaternion);
    }
}

} // namespace
} // namespace voxtact::test
