// SPDX-License-Identifier: MIT
// Every read of a file fails once, and it and all after it: the reader says so, or has the whole file nevertheless.
#include "dicom/dicom_writer.h"
#include "failing_reads.h"
#include "io_test_support.h"

#include <functional>
#include <iostream>
#include <string>

namespace voxtact::test {
namespace {

bool isSame(const VolumeData& a, const VolumeData& b) {
    return a.voxels == b.voxels && a.type == b.type && a.grid.size == b.grid.size && a.grid.origin == b.grid.origin &&
           a.grid.spacing == b.grid.spacing && a.grid.direction == b.grid.direction;
}
bool isSame(const MeshData& a, const MeshData& b) {
    return a.positions == b.positions && a.indices == b.indices;
}
template <class Value> bool isSame(const Value& a, const Value& b) {
    return a == b;
}

class FailingReadsTest : public testing::Test {
  protected:
    /// Of what is in the folder.
    template <class Value> void expectWhole(const std::string& what, const std::function<Result<Value>()>& read) const {
        const Result<Value> whole = read();
        ASSERT_TRUE(isOk(whole)) << what;
        for (const bool forGood : {false, true}) {
            std::int64_t number = 0;
            for (;; ++number) {
                const FailingReads reads(folder_.path(), number, forGood);
                const Result<Value> got = read();
                if (reads.failures() == 0) {
                    break;
                }
                if (got.ok()) {
                    ASSERT_TRUE(isSame(*got, *whole)) << what << ": read " << number;
                } else {
                    ASSERT_EQ(got.error().code, ErrorCode::File) << what << ": " << got.error().text;
                    ASSERT_THAT(got.error().text, testing::HasSubstr(folder_.path().string())) << what;
                }
            }
            std::cout << what << ": " << number << " reads failed\n";
            EXPECT_GT(number, 0) << what;
        }
    }

    /// Lines that are more than one read.
    [[nodiscard]] std::filesystem::path lines(const std::function<std::string(int)>& line) const {
        std::string text;
        for (int i = 0; i < 3000; ++i) {
            text += line(i) + "\n";
        }
        return folder_.write("lines.txt", text);
    }

    TemporaryFolder folder_;
};

TEST_F(FailingReadsTest, OfVolumes) {
    VolumeData volume;
    volume.type = ScalarType::Int16;
    volume.grid.size = {70, 60, 50};
    volume.grid.spacing = {0.5, 0.75, 2};
    std::uint32_t state = 1;
    volume.voxels.resize(std::size_t{70} * 60 * 50 * 2);
    for (std::byte& byte : volume.voxels) {
        state = state * 1664525U + 1013904223U;
        byte = static_cast<std::byte>(state >> 24U);
    }
    for (const char* const name : {"v.nii", "v.nii.gz", "v.nrrd", "v.mha"}) {
        const std::filesystem::path path = folder_ / name;
        ASSERT_TRUE(isOk(io::writeVolume(path, volume.view()))) << name;
        expectWhole<VolumeData>(name, [&] { return io::readVolume(path); });
    }
}

/// What is optional in a header comes last.
TEST_F(FailingReadsTest, OfAHeaderWhoseVoxelsAreElsewhere) {
    const std::filesystem::path header =
        folder_.write("v.nhdr", "NRRD0004\n# " + std::string(20000, 'a') +
                                    "\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: v.raw\n# " +
                                    std::string(500000, 'b') +
                                    "\nspace: left-posterior-superior\nspace directions: (3,0,0) (0,3,0) (0,0,3)\n");
    static_cast<void>(folder_.write("v.raw", std::string(8, '\5')));
    expectWhole<VolumeData>("v.nhdr", [&] { return io::readVolume(header); });
}

TEST_F(FailingReadsTest, OfDicomFolders) {
    for (const char* const syntax : {kExplicit, kImplicit, kDeflated}) {
        writeCt(folder_, 5, syntax);
        static_cast<void>(folder_.write("notes.txt", "no DICOM file"));
        expectWhole<VolumeData>(syntax, [&] { return io::readVolume(folder_.path()); });
    }
}

TEST_F(FailingReadsTest, OfMeshes) {
    MeshData mesh;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const auto at = static_cast<float>(i);
        mesh.positions.insert(mesh.positions.end(), {at, 0.5F * at, 1, at + 1, 2, 0.25F * at, at, 3, 4});
        mesh.indices.insert(mesh.indices.end(), {3 * i, 3 * i + 1, 3 * i + 2});
    }
    for (const char* const name : {"m.stl", "m.obj", "m.ply"}) {
        const std::filesystem::path path = folder_ / name;
        ASSERT_TRUE(isOk(io::writeMesh(path, mesh.view()))) << name;
        expectWhole<MeshData>(name, [&] { return io::readMesh(path); });
    }
}

TEST_F(FailingReadsTest, OfPoses) {
    const auto path = lines([](int i) { return "1 0 0 " + std::to_string(i) + " 0 1 0 0 0 0 1 0 0 0 0 1"; });
    expectWhole<std::vector<Mat4>>("poses", [&] { return io::readPoses(path); });
}

TEST_F(FailingReadsTest, OfPoints) {
    const auto path = lines([](int i) { return std::to_string(i) + " 2 3 name"; });
    expectWhole<std::size_t>("points", [&]() -> Result<std::size_t> {
        const Result<std::vector<io::NamedPoint>> points = io::readPoints(path);
        return points.ok() ? Result(points->size()) : points.error();
    });
}

TEST_F(FailingReadsTest, OfLabelNames) {
    const auto path = lines([](int i) { return std::to_string(i) + " name"; });
    expectWhole<std::size_t>("label names", [&]() -> Result<std::size_t> {
        const Result<std::vector<io::LabelName>> names = io::readLabelNames(path);
        return names.ok() ? Result(names->size()) : names.error();
    });
}

TEST_F(FailingReadsTest, OfTransferFunctions) {
    const auto count = [](const std::filesystem::path& path) -> Result<std::size_t> {
        const Result<std::vector<ControlPoint>> points = io::readTransferFunction(path);
        return points.ok() ? Result(points->size()) : points.error();
    };
    const auto text = lines([](int i) { return std::to_string(i) + " 0.5"; });
    expectWhole<std::size_t>("control points", [&] { return count(text); });
    const auto json = folder_.write("tf.json", std::string(30000, ' ') + R"({"points": [[0, 0], [100, 1]]})");
    expectWhole<std::size_t>("control points in JSON", [&] { return count(json); });
}

TEST_F(FailingReadsTest, OfCameras) {
    const auto path =
        folder_.write("camera.txt", "# " + std::string(30000, 'a') + "\n1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n");
    expectWhole<Mat4>("camera", [&] { return io::readCamera(path); });
}

} // namespace
} // namespace voxtact::test
