// SPDX-License-Identifier: MIT
// What is no file is refused in the place of every input, before it is opened: opening a pipe would wait for a writer.
#include "io_test_support.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace voxtact::test {
namespace {

namespace fs = std::filesystem;

/// Each reader's refusal of the path.
std::vector<Error> refusals(const fs::path& path) {
    std::vector<Error> errors;
    const auto take = [&](const auto& result) {
        EXPECT_FALSE(result.ok()) << path;
        errors.push_back(result.ok() ? Error{} : result.error());
    };
    take(io::readMesh(path));
    take(io::readPoses(path));
    take(io::readCamera(path));
    take(io::readTransferFunction(path));
    take(io::readColours(path));
    take(io::readLabelNames(path));
    if (!fs::is_directory(path)) {
        take(io::readVolume(path));
    }
    return errors;
}

void expectAll(const fs::path& path, const std::string& reason) {
    for (const Error& error : refusals(path)) {
        EXPECT_EQ(error.text, "cannot read '" + path.string() + "': " + reason);
        EXPECT_EQ(error.code, ErrorCode::File);
    }
}

TEST(NoFiles, FoldersPipesSocketsAndDevices) {
    const TemporaryFolder folder;
    expectAll(folder.path(), "it is a folder, not a file");
    expectAll("/dev/zero", "it is a device, not a file");
    for (const char* name : {"pipe", "pipe.stl", "pipe.nii", "pipe.nii.gz", "pipe.mha", "pipe.nrrd"}) {
        ASSERT_EQ(::mkfifo((folder / name).c_str(), 0600), 0);
        expectAll(folder / name, "it is a pipe, not a file; write what it gives to a file first");
    }
    const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    (folder / "socket").string().copy(address.sun_path, sizeof address.sun_path - 1);
    ASSERT_EQ(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    ::close(socket);
    expectAll(folder / "socket", "it is a socket, not a file");
    // A link is what it leads to.
    fs::create_symlink(folder / "pipe", folder / "link.stl");
    expectAll(folder / "link.stl", "it is a pipe, not a file; write what it gives to a file first");
}

/// What a header names is examined in the same way.
TEST(NoFiles, PartsOfAnInput) {
    const TemporaryFolder folder;
    ASSERT_EQ(::mkfifo((folder / "part.raw").c_str(), 0600), 0);
    folder.write("m.gltf",
                 R"({"asset": {"version": "2.0"}, "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "part.raw"}]})");
    expectRefused(io::readMesh(folder / "m.gltf"), "it is a pipe, not a file", folder / "m.gltf");
    const auto meta = folder.write("v.mhd", "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\n"
                                            "ElementSpacing = 1 1 1\nElementDataFile = part.raw\n");
    expectRefused(io::readVolume(meta), "it is a pipe, not a file");
    const auto nrrd = folder.write("v.nhdr", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 2 2\nencoding: raw\n"
                                             "data file: part.raw\n\n");
    expectRefused(io::readVolume(nrrd), "it is a pipe, not a file");
}

} // namespace
} // namespace voxtact::test
