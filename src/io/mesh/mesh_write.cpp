// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "io/errors.h"
#include "voxtact/io.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <ostream>

namespace voxtact::io {

namespace {

static_assert(std::endian::native == std::endian::little, "STL and binary PLY are written as the bytes lie in memory");

template <class Number> void append(std::string& bytes, Number number) {
    char raw[sizeof number];
    std::memcpy(raw, &number, sizeof raw);
    bytes.append(raw, sizeof raw);
}

bool isFloat(double value) {
    return static_cast<double>(static_cast<float>(value)) == value;
}

/// The shortest text that reads back as the same double.
void appendText(std::string& text, double value) {
    char digits[32];
    text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

std::array<float, 3> positionOf(const MeshView& mesh, std::uint32_t vertex) {
    const std::size_t at = std::size_t{3} * vertex;
    return {static_cast<float>(mesh.positions[at]), static_cast<float>(mesh.positions[at + 1]),
            static_cast<float>(mesh.positions[at + 2])};
}

/// Zero for a degenerate triangle, as the format asks.
std::array<float, 3> normalOf(const std::array<std::array<float, 3>, 3>& corners) {
    std::array<double, 3> u{};
    std::array<double, 3> v{};
    for (std::size_t i = 0; i < 3; ++i) {
        u[i] = static_cast<double>(corners[1][i]) - static_cast<double>(corners[0][i]);
        v[i] = static_cast<double>(corners[2][i]) - static_cast<double>(corners[0][i]);
    }
    const std::array<double, 3> n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double length = std::hypot(n[0], n[1], n[2]);
    if (!(length > 0) || !std::isfinite(length)) {
        return {};
    }
    return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length), static_cast<float>(n[2] / length)};
}

void writeStl(std::ostream& stream, const MeshView& mesh) {
    std::string bytes = "binary STL by voxtact";
    bytes.resize(80, ' ');
    append(bytes, static_cast<std::uint32_t>(mesh.indices.size() / 3));
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const std::array<std::array<float, 3>, 3> corners{positionOf(mesh, mesh.indices[i]),
                                                          positionOf(mesh, mesh.indices[i + 1]),
                                                          positionOf(mesh, mesh.indices[i + 2])};
        append(bytes, normalOf(corners));
        append(bytes, corners);
        append(bytes, std::uint16_t{0});
    }
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void writePly(std::ostream& stream, const MeshView& mesh) {
    const bool areFloats = std::ranges::all_of(mesh.positions, isFloat);
    const std::string type = areFloats ? "float" : "double";
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                        std::to_string(mesh.positions.size() / 3) + "\nproperty " + type + " x\nproperty " + type +
                        " y\nproperty " + type + " z\nelement face " + std::to_string(mesh.indices.size() / 3) +
                        "\nproperty list uchar uint vertex_indices\nend_header\n";
    for (const double coordinate : mesh.positions) {
        if (areFloats) {
            append(bytes, static_cast<float>(coordinate));
        } else {
            append(bytes, coordinate);
        }
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        if (i % 3 == 0) {
            append(bytes, std::uint8_t{3});
        }
        append(bytes, mesh.indices[i]);
    }
    stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

void writeObj(std::ostream& stream, const MeshView& mesh) {
    std::string text = "# voxtact\n";
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        text += i % 3 == 0 ? "v " : " ";
        appendText(text, mesh.positions[i]);
        text += i % 3 == 2 ? "\n" : "";
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        text += i % 3 == 0 ? "f " : " ";
        text += std::to_string(std::uint64_t{mesh.indices[i]} + 1);
        text += i % 3 == 2 ? "\n" : "";
    }
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
}

} // namespace

Result<void> writeMesh(const std::filesystem::path& path, const MeshView& mesh) {
    return guard([&]() -> Result<void> {
        const std::string ending = lowerEnding(path);
        if (ending != ".stl" && ending != ".obj" && ending != ".ply") {
            return cannotWrite(path, "the ending of a mesh is .stl, .obj or .ply", ErrorCode::InvalidArgument);
        }
        if (const Result<MeshFacts> facts = checkMesh(mesh); !facts.ok()) {
            return cannotWrite(path, facts.error().text, facts.error().code);
        }
        return writeFile(path, [&](std::ostream& stream) -> Result<void> {
            if (ending == ".stl") {
                writeStl(stream, mesh);
            } else if (ending == ".ply") {
                writePly(stream, mesh);
            } else {
                writeObj(stream, mesh);
            }
            return {};
        });
    });
}

} // namespace voxtact::io
