// SPDX-License-Identifier: MIT
#pragma once

#include "fuzz.h"
#include "voxtact/io.h"

#include <cmath>

namespace voxtact::fuzz {

/// What readVolume() promises of whatever it is given.
inline void requireVolume(const Result<VolumeData>& volume) {
    if (!volume.ok()) {
        requireOneLine(volume.error().text);
        return;
    }
    const Result<ValueRange> range = checkVolume(volume->view());
    require(range.ok(), "a volume that is read passes the check");
    require(std::isfinite(range->lo) && std::isfinite(range->hi), "voxels are finite");
    const Result<Mat4> texture_from_world = textureFromWorld(volume->grid);
    require(texture_from_world.ok(), "a grid can be inverted");
    for (const double element : *texture_from_world) {
        require(std::isfinite(element), "a grid's inverse is finite");
    }
    for (const std::string& note : volume->notes) {
        requireOneLine(note);
    }
}

/// One file in memory; where it holds several images, the first and the last that a number of 8 bits can name.
inline void readFromMemory(const char* name, const std::uint8_t* data, std::size_t size) {
    const std::span<const std::byte> content(reinterpret_cast<const std::byte*>(data), size);
    for (const std::optional<std::uint32_t> frame :
         {std::optional<std::uint32_t>(), std::optional<std::uint32_t>(0), std::optional<std::uint32_t>(255)}) {
        requireVolume(io::readVolume(name, content, {frame}));
    }
}

} // namespace voxtact::fuzz
