// SPDX-License-Identifier: MIT
#include "io/byte_source.h"
#include "io/dicom/dicom_codecs.h"

#include <algorithm>

/// DICOM's own run lengths (PS3.5, annex G): a segment for each byte of a pixel, the highest byte first.
namespace voxtact::io {

namespace {

Error damaged(const char* what) {
    return Error{ErrorCode::Format, 0, std::string("its run-length data is damaged or cut off (") + what + ")"};
}

/// Ors the segment's bytes, shifted, into the cells; false when it ends before the image does.
bool segment(std::string_view bytes, unsigned shift, std::span<std::uint32_t> cells) {
    std::size_t at = 0;
    std::size_t cell = 0;
    const auto byte = [&](std::size_t i) { return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[i])); };
    while (cell < cells.size()) {
        if (at == bytes.size()) {
            return false;
        }
        const std::uint32_t control = byte(at++);
        if (control == 128) {
            continue;
        }
        const bool run = control > 128;
        const std::size_t length = run ? 257 - control : control + 1;
        if (bytes.size() - at < (run ? 1 : length)) {
            return false;
        }
        for (std::size_t i = 0; i < std::min(length, cells.size() - cell); ++i) {
            cells[cell + i] |= byte(run ? at : at + i) << shift;
        }
        cell += length;
        at += run ? 1 : length;
    }
    return true;
}

} // namespace

Result<void> decodeRle(std::string_view bytes, const DicomImage& image, std::span<std::uint32_t> cells) {
    constexpr std::size_t kHeader = 64;
    const unsigned segments = image.bitsAllocated / 8;
    if (bytes.size() < kHeader || numberAt<std::uint32_t>(bytes, 0) != segments) {
        return damaged("another number of segments than a pixel has bytes");
    }
    std::fill(cells.begin(), cells.end(), 0);
    for (unsigned i = 0; i < segments; ++i) {
        const std::size_t begin = numberAt<std::uint32_t>(bytes, 4 + std::size_t{4} * i);
        const std::size_t end =
            i + 1 == segments ? bytes.size() : numberAt<std::uint32_t>(bytes, 8 + std::size_t{4} * i);
        if (begin < kHeader || begin > end || end > bytes.size()) {
            return damaged("a segment beyond its end");
        }
        if (!segment(bytes.substr(begin, end - begin), 8 * (segments - 1 - i), cells)) {
            return damaged("it ends before the image does");
        }
    }
    return {};
}

} // namespace voxtact::io
