// SPDX-License-Identifier: MIT
#pragma once

#include "io/mesh/mesh_text.h"

#include <string>
#include <vector>

namespace voxtact::io {

enum class PlyStorage { Ascii, LittleEndian, BigEndian };
enum class PlyType { Int8, UInt8, Int16, UInt16, Int32, UInt32, Int64, UInt64, Float, Double };

struct PlyProperty {
    std::string name;
    PlyType type = PlyType::Float;
    std::optional<PlyType> countType; ///< of lists
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

struct PlyHeader {
    PlyStorage storage = PlyStorage::Ascii;
    std::vector<PlyElement> elements;
    std::string comments; ///< in one line
};

[[nodiscard]] constexpr std::size_t plyBytes(PlyType type) {
    constexpr std::size_t kBytes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    return kBytes[static_cast<std::size_t>(type)];
}

/// Takes the lines up to `end_header`. Refuses elements of the same name.
[[nodiscard]] Result<PlyHeader> readPlyHeader(const std::filesystem::path& path, TextLines& lines);

} // namespace voxtact::io
