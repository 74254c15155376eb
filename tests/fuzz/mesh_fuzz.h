// SPDX-License-Identifier: MIT
#pragma once

#include "fuzz.h"
#include "voxtact/data.h"
#include "voxtact/io.h"

#include <vector>

namespace voxtact::fuzz {

/// Reads the input as a mesh file of the name's ending: an error of one line, or a mesh that every detector takes.
inline int readAsMesh(const char* name, const std::uint8_t* data, std::size_t size) {
    const auto mesh = io::readMesh(std::as_bytes(std::span(data, size)), name);
    if (!mesh) {
        requireOneLine(mesh.error().text);
        require(mesh.error().code != ErrorCode::Internal, "bad input is no bug of ours");
        return 0;
    }
    require(!mesh->indices.empty(), "a mesh that is read has a triangle");
    require(checkMesh(mesh->view()).ok(), "a mesh that is read is sound");
    std::vector<bool> used(mesh->positions.size() / 3);
    for (const std::uint32_t index : mesh->indices) {
        used[index] = true;
    }
    for (const bool isUsed : used) {
        require(isUsed, "every vertex is a triangle's");
    }
    for (const std::string& note : mesh->notes) {
        requireOneLine(note);
    }
    return 0;
}

} // namespace voxtact::fuzz
