// SPDX-License-Identifier: MIT
#include "io/byte_source.h"
#include "io/errors.h"
#include "io/volume/itk_image.h"

#include <algorithm>

namespace voxtact::io {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view kPixelData = "\xE0\x7F\x10\x00"sv;
constexpr std::string_view kSequenceEnd = "\xFE\xFF\xDD\xE0\x00\x00\x00\x00"sv;
constexpr std::uint32_t kUndefinedLength = 0xFFFFFFFF;

struct Element {
    std::size_t valueAt = 0;
    std::uint32_t length = 0;
};

/// Behind the tag comes the length, or with explicit types: the type, two bytes, and the length.
std::optional<Element> elementAt(std::string_view content, std::size_t tagAt) {
    const std::string_view type = content.substr(std::min(tagAt + 4, content.size()), 2);
    const std::size_t lengthAt = tagAt + (type == "OW" || type == "OB" ? 8 : 4);
    if (content.size() < lengthAt + 4) {
        return std::nullopt;
    }
    return Element{lengthAt + 4, numberAt<std::uint32_t>(content, lengthAt)};
}

/// Where the pixels end, if they do.
std::optional<std::size_t> endOf(std::string_view content, const Element& element) {
    if (element.length == kUndefinedLength) {
        const std::size_t end = content.find(kSequenceEnd, element.valueAt);
        return end == std::string_view::npos ? std::nullopt : std::optional(end + kSequenceEnd.size());
    }
    return content.size() - element.valueAt < element.length ? std::nullopt
                                                             : std::optional(element.valueAt + element.length);
}

} // namespace

Result<void> checkDicomSlice(const std::filesystem::path& path) {
    const Result<std::string> content = readWholeFile(path);
    if (!content.ok()) {
        return content.error();
    }
    const std::string_view bytes = *content;
    std::size_t at = bytes.find(kPixelData);
    if (at == std::string_view::npos) {
        return cannotRead(path, "it holds no pixels, or it is truncated, or its byte order is not supported");
    }
    // A preview image comes first where there is one.
    while (at != std::string_view::npos) {
        const std::optional<Element> element = elementAt(bytes, at);
        const std::optional<std::size_t> end = element ? endOf(bytes, *element) : std::nullopt;
        if (!end) {
            return cannotRead(path, "it is truncated: the file ends before its pixels do; get the file again");
        }
        at = bytes.find(kPixelData, *end);
    }
    return {};
}

} // namespace voxtact::io
