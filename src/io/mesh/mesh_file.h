// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/io.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::io {

/// A mesh file in memory.
struct MeshSource {
    std::filesystem::path path; ///< its ending is the format; messages name it
    std::string_view content;
    /// The bytes of a file that this one refers to, by its path beside this one (glTF). None: such files are refused.
    std::function<Result<std::string>(const std::filesystem::path& beside)> other = {};
};

/// What a mesh file says, in its own coordinates and order. What a reader returns is sound: every corner is a vertex,
/// every face has 3 corners or more. Vertices may lie anywhere a double can, and be unused.
struct MeshFile {
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> corners;   ///< vertices of one face after the other
    std::vector<std::uint32_t> faceSizes; ///< corners of each face
    std::uint64_t pointsAndLines = 0;     ///< left out
    std::vector<std::string> notes;
};

/// One reader for each format: it refuses what it does not understand, with its place.
[[nodiscard]] Result<MeshFile> readStl(const MeshSource& source);
[[nodiscard]] Result<MeshFile> readObj(const MeshSource& source);
[[nodiscard]] Result<MeshFile> readPly(const MeshSource& source);
[[nodiscard]] Result<MeshFile> readOff(const MeshSource& source);
[[nodiscard]] Result<MeshFile> readGltf(const MeshSource& source);
/// By the ending.
[[nodiscard]] Result<MeshFile> readMeshFile(const MeshSource& source);

} // namespace voxtact::io
