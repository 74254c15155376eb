// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "voxtact/io.h"

#include <ostream>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STBI_WRITE_NO_STDIO
#include <stb_image_write.h>

namespace voxtact::io {

namespace {

constexpr int kChannels = 4;

/// stb counts bytes in ints, some of them more than once.
constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30;

Error refuse(std::string text) {
    return {ErrorCode::InvalidArgument, 0, std::move(text)};
}

void toStream(void* stream, void* data, int size) {
    static_cast<std::ostream*>(stream)->write(static_cast<const char*>(data), size);
}

Result<void> checkPicture(std::uint32_t width, std::uint32_t height, std::span<const std::uint8_t> rgba) {
    const std::uint64_t bytes = std::uint64_t{kChannels} * width * height;
    if (bytes == 0 || bytes != rgba.size()) {
        return refuse("a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels has " +
                      std::to_string(rgba.size()) + " bytes, four a pixel are needed");
    }
    if (bytes > kMostBytes) {
        return refuse("a picture of " + std::to_string(width) + "x" + std::to_string(height) + " pixels has " +
                      std::to_string(bytes) + " bytes, a PNG file of ours has at most " + std::to_string(kMostBytes));
    }
    return {};
}

} // namespace

Result<void> writePng(std::ostream& out, std::uint32_t width, std::uint32_t height,
                      std::span<const std::uint8_t> rgba) {
    return guard([&]() -> Result<void> {
        VOXTACT_TRY(checkPicture(width, height, rgba));
        const int done = stbi_write_png_to_func(toStream, &out, static_cast<int>(width), static_cast<int>(height),
                                                kChannels, rgba.data(), static_cast<int>(width) * kChannels);
        return done != 0 ? Result<void>() : Error{ErrorCode::OutOfMemory, 0, "out of host memory"};
    });
}

Result<void> writePng(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
                      std::span<const std::uint8_t> rgba) {
    return guard([&]() -> Result<void> {
        if (lowerEnding(path) != ".png") {
            return cannotWrite(path, "the ending of a picture is .png", ErrorCode::InvalidArgument);
        }
        VOXTACT_TRY(checkPicture(width, height, rgba));
        return writeFile(path, [&](std::ostream& stream) { return writePng(stream, width, height, rgba); });
    });
}

} // namespace voxtact::io
