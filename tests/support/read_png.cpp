// SPDX-License-Identifier: MIT
#include "read_png.h"

#include <cstddef>

#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb_image.h>

namespace voxtact::test {

PngPicture readPng(const std::filesystem::path& path) {
    PngPicture picture;
    int channels = 0;
    stbi_uc* pixels = stbi_load(path.c_str(), &picture.width, &picture.height, &channels, 4);
    if (pixels == nullptr) {
        return {};
    }
    picture.rgba.assign(pixels, pixels + std::size_t{4} * static_cast<std::size_t>(picture.width) *
                                             static_cast<std::size_t>(picture.height));
    stbi_image_free(pixels);
    return picture;
}

} // namespace voxtact::test
