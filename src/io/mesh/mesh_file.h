// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/io.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::io {

/// A mesh file in memory.
struct MeshSource {
    std::filesystem::path path; ///< its ending is the format; messages name it
    std::string_view content;
    /// Reads a file that this one refers to, by its path relative to this one (glTF). Empty: such files are refused.
    std::function<Result<std::string>(const std::filesystem::path& relative)> other = {};
    double deflection = kDefaultDeflection; ///< of STEP and IGES; units of the file's mm
};

/// Contents of a mesh file, in its own coordinates and order. Readers return valid ones: every corner is a vertex,
/// every face has 3 corners or more. Vertices may be any doubles, and unused.
struct MeshFile {
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> corners;   ///< vertices of one face after the other
    std::vector<std::uint32_t> faceSizes; ///< corners of each face
    std::uint64_t pointsAndLines = 0;     ///< left out
    double deflection = 0;                ///< as MeshData::deflection
    bool saysLps = false;                 ///< a header has SPACE=LPS
    bool saysRas = false;
    std::vector<std::string> notes;
};

inline constexpr std::string_view kPadding(" \t\v\f\r\n\0", 7);

/// Takes the space from a comment or header.
void takeSpace(std::string_view comment, MeshFile& file);

/// Adds the triangles of a strip: every second one is turned, so that all turn as the first does.
void addStrip(std::span<const std::uint32_t> strip, MeshFile& file);

/// True if nothing but white space and zeros follows the mesh; notes zeros.
[[nodiscard]] bool takePadding(std::string_view rest, MeshFile& file);
/// The content without white space and zeros at its end; notes zeros.
[[nodiscard]] std::string_view withoutPadding(std::string_view content, MeshFile& file);

/// One reader per format: it refuses unknown content, with its position.
[[nodiscard]] Result<MeshFile> readStl(const MeshSource& source);
[[nodiscard]] Result<MeshFile> readObj(const MeshSource& source);
[[nodiscard]] Result<MeshFile> readPly(const MeshSource& source);
[[nodiscard]] Result<MeshFile> readOff(const MeshSource& source);
[[nodiscard]] Result<MeshFile> readGltf(const MeshSource& source);
[[nodiscard]] Result<MeshFile> readVtk(const MeshSource& source);
[[nodiscard]] Result<MeshFile> readVtp(const MeshSource& source);
/// STEP and IGES, by voxtact-step.
[[nodiscard]] Result<MeshFile> readCad(const MeshSource& source);
[[nodiscard]] bool isCad(const std::filesystem::path& path);
/// Selects the reader by the ending.
[[nodiscard]] Result<MeshFile> readMeshFile(const MeshSource& source);

} // namespace voxtact::io
