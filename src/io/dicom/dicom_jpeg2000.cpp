// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_codecs.h"

#include "core/base/try.h"

#include <algorithm>
#include <cstring>
#include <memory>

#include <openjpeg.h>

namespace voxtact::io {

namespace {

using namespace std::string_view_literals;

Error damaged(const char* what) {
    return Error{ErrorCode::Format, 0, std::string("its JPEG 2000 data is damaged or cut off (") + what + ")"};
}

std::uint32_t bigEndian(std::string_view bytes, std::size_t at, std::size_t count) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < count; ++i) {
        value = value << 8U | static_cast<unsigned char>(bytes[at + i]);
    }
    return value;
}

/// Returns the code stream; some writers wrap it in the boxes of a JP2 file.
std::string_view codeStream(std::string_view bytes) {
    constexpr std::size_t kBox = 8;
    if (!bytes.starts_with("\0\0\0\x0CjP  "sv)) {
        return bytes;
    }
    while (bytes.size() >= kBox) {
        const std::size_t length = bigEndian(bytes, 0, 4);
        if (bytes.substr(4, 4) == "jp2c") {
            return bytes.substr(kBox, length == 0 ? bytes.npos : std::max(length, kBox) - kBox);
        }
        if (length < kBox || length > bytes.size()) {
            break;
        }
        bytes.remove_prefix(length);
    }
    return {};
}

/// The marker SIZ says how much the library is going to allocate.
Result<void> checkSize(std::string_view bytes, const DicomImage& image) {
    constexpr std::size_t kLength = 45;
    if (bytes.size() < kLength || !bytes.starts_with("\xFF\x4F\xFF\x51"sv)) {
        return damaged("it does not begin like one");
    }
    const auto number = [&](std::size_t at) { return std::uint64_t{bigEndian(bytes, at, 4)}; };
    const std::uint64_t right = number(8);
    const std::uint64_t bottom = number(12);
    const std::uint64_t left = number(16);
    const std::uint64_t top = number(20);
    if (right < left || bottom < top || right - left != image.columns || bottom - top != image.rows ||
        bigEndian(bytes, 40, 2) != 1 || bigEndian(bytes, 43, 2) != 0x0101) {
        return damaged("another size than the file says");
    }
    const unsigned bits = (bigEndian(bytes, 42, 1) & 0x7FU) + 1;
    const bool isSigned = bigEndian(bytes, 42, 1) > 0x7F;
    if (bits > image.bitsAllocated || bits > 16 || (image.isSigned && !isSigned && bits < image.bitsStored) ||
        (isSigned && !image.isSigned)) {
        return damaged("a precision or sign that does not fit");
    }
    // Some kilobytes are taken for each tile.
    constexpr std::uint64_t kMostTiles = 4096;
    const std::uint64_t width = number(24);
    const std::uint64_t height = number(28);
    if (width == 0 || height == 0 || number(32) > left || number(36) > top ||
        ((right - number(32) - 1) / width + 1) * ((bottom - number(36) - 1) / height + 1) > kMostTiles) {
        return damaged("its tiles");
    }
    return {};
}

/// Source of the library's stream.
struct Source {
    std::string_view bytes;
    std::size_t at = 0;
};

OPJ_SIZE_T readSource(void* to, OPJ_SIZE_T count, void* user) {
    auto* source = static_cast<Source*>(user);
    const std::size_t part = std::min<std::size_t>(count, source->bytes.size() - source->at);
    if (part == 0) {
        return static_cast<OPJ_SIZE_T>(-1);
    }
    std::memcpy(to, source->bytes.data() + source->at, part);
    source->at += part;
    return part;
}

OPJ_OFF_T skipSource(OPJ_OFF_T count, void* user) {
    auto* source = static_cast<Source*>(user);
    if (count < 0 || static_cast<std::uint64_t>(count) > source->bytes.size() - source->at) {
        return -1;
    }
    source->at += static_cast<std::size_t>(count);
    return count;
}

OPJ_BOOL seekSource(OPJ_OFF_T to, void* user) {
    auto* source = static_cast<Source*>(user);
    if (to < 0 || static_cast<std::uint64_t>(to) > source->bytes.size()) {
        return OPJ_FALSE;
    }
    source->at = static_cast<std::size_t>(to);
    return OPJ_TRUE;
}

template <auto Destroy> struct Destroyed {
    template <class Object> void operator()(Object* object) const noexcept { Destroy(object); }
};

} // namespace

Result<void> decodeJpeg2000(std::string_view bytes, const DicomImage& image, std::span<std::uint32_t> cells) {
    Source source{codeStream(bytes)};
    VOXTACT_TRY(checkSize(source.bytes, image));
    const std::unique_ptr<opj_codec_t, Destroyed<opj_destroy_codec>> codec(opj_create_decompress(OPJ_CODEC_J2K));
    const std::unique_ptr<opj_stream_t, Destroyed<opj_stream_destroy>> stream(
        opj_stream_create(std::max<std::size_t>(source.bytes.size(), 64), OPJ_TRUE));
    if (!codec || !stream) {
        return Error{ErrorCode::OutOfMemory, 0, "out of host memory"};
    }
    opj_stream_set_user_data(stream.get(), &source, nullptr);
    opj_stream_set_user_data_length(stream.get(), source.bytes.size());
    opj_stream_set_read_function(stream.get(), readSource);
    opj_stream_set_skip_function(stream.get(), skipSource);
    opj_stream_set_seek_function(stream.get(), seekSource);
    opj_dparameters_t parameters;
    opj_set_default_decoder_parameters(&parameters);
    opj_image_t* made = nullptr;
    // Without handlers of ours the library is silent. Strict: data that is cut off is not filled up.
    if (opj_setup_decoder(codec.get(), &parameters) == 0 || opj_decoder_set_strict_mode(codec.get(), OPJ_TRUE) == 0 ||
        opj_read_header(stream.get(), codec.get(), &made) == 0) {
        return damaged("its header");
    }
    const std::unique_ptr<opj_image_t, Destroyed<opj_image_destroy>> picture(made);
    if (opj_decode(codec.get(), stream.get(), picture.get()) == 0 || picture->numcomps != 1 ||
        picture->comps[0].data == nullptr || picture->comps[0].w != image.columns ||
        picture->comps[0].h != image.rows) {
        return damaged("its pixels");
    }
    // Negative values keep their sign in the upper bits, which are as good as those of the pixel.
    std::transform(picture->comps[0].data, picture->comps[0].data + cells.size(), cells.begin(),
                   [](OPJ_INT32 value) { return static_cast<std::uint32_t>(value); });
    return {};
}

} // namespace voxtact::io
