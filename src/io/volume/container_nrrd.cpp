// SPDX-License-Identifier: MIT
#include "io/byte_source.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "io/volume/volume_container.h"

#include <array>
#include <charconv>
#include <map>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

struct NrrdHeader {
    std::map<std::string, std::string, std::less<>> fields;
    std::uint64_t end = 0; ///< where attached voxels begin
    bool complete = false; ///< the empty line that ends a header with attached voxels was seen

    [[nodiscard]] std::string get(std::string_view key) const {
        const auto found = fields.find(key);
        return found == fields.end() ? std::string() : found->second;
    }
};

std::string withoutBlanks(std::string_view key) {
    std::string text;
    for (const char c : key) {
        if (c != ' ') {
            text += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
        }
    }
    return text;
}

NrrdHeader readHeader(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    NrrdHeader header;
    std::string line;
    constexpr std::uint64_t kLongest = 1 << 22;
    while (!header.complete && header.end < kLongest && std::getline(file, line)) {
        header.end += line.size() + (file.eof() ? 0 : 1);
        const std::string_view text = trimmed(line);
        header.complete = text.empty() && !file.eof();
        const std::size_t colon = text.find(": ");
        // "key:=value" is a note of somebody's.
        if (colon != std::string_view::npos && !text.starts_with('#')) {
            header.fields[withoutBlanks(text.substr(0, colon))] = trimmed(text.substr(colon + 1));
        }
    }
    return header;
}

std::uint64_t voxelBytes(const std::string& type) {
    struct Known {
        std::array<std::string_view, 6> names;
        std::uint64_t bytes;
    };
    constexpr std::array<Known, 10> kTypes{{
        {{"signed char", "int8", "int8_t", "", "", ""}, 1},
        {{"uchar", "unsigned char", "uint8", "uint8_t", "", ""}, 1},
        {{"short", "short int", "signed short", "signed short int", "int16", "int16_t"}, 2},
        {{"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t", ""}, 2},
        {{"int", "signed int", "int32", "int32_t", "", ""}, 4},
        {{"uint", "unsigned int", "uint32", "uint32_t", "", ""}, 4},
        {{"longlong", "long long", "long long int", "signed long long", "int64", "int64_t"}, 8},
        {{"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t", ""}, 8},
        {{"float", "", "", "", "", ""}, 4},
        {{"double", "", "", "", "", ""}, 8},
    }};
    for (const Known& known : kTypes) {
        for (const std::string_view name : known.names) {
            if (!name.empty() && name == type) {
                return known.bytes;
            }
        }
    }
    return 0;
}

/// The sizes of the axes in space; a "domain" axis has one voxel's width along it, others hold components.
Result<std::vector<std::int64_t>> sizesOf(const fs::path& path, const NrrdHeader& header) {
    std::vector<std::string_view> tokens;
    const std::string text = header.get("sizes");
    splitTokens(text, tokens);
    std::vector<std::int64_t> sizes;
    for (const std::string_view token : tokens) {
        std::int64_t size = 0;
        const auto end = std::from_chars(token.data(), token.data() + token.size(), size);
        if (end.ec != std::errc{} || end.ptr != token.data() + token.size()) {
            return cannotRead(path, "its NRRD header is damaged ('sizes: " + oneLine(text) + "')");
        }
        sizes.push_back(size);
    }
    if (header.get("dimension") != std::to_string(sizes.size())) {
        return cannotRead(path, "its NRRD header is damaged: 'sizes' does not have 'dimension' numbers");
    }
    return sizes;
}

Result<void> checkAxes(const fs::path& path, const NrrdHeader& header) {
    std::vector<std::string_view> kinds;
    const std::string text = header.get("kinds");
    splitTokens(text, kinds);
    for (std::size_t i = 0; i < std::min<std::size_t>(kinds.size(), 3); ++i) {
        if (kinds[i] != "domain" && kinds[i] != "space" && kinds[i] != "???" && kinds[i] != "none") {
            return cannotRead(path, "its voxels are not single numbers (axis " + std::to_string(i) + " is '" +
                                        std::string(kinds[i]) + "'); convert it to integers or floats");
        }
    }
    return {};
}

Result<void> checkData(const fs::path& path, const NrrdHeader& header, std::uint64_t needed) {
    const std::string encoding = withoutBlanks(header.get("encoding"));
    const std::string detached = header.get("datafile");
    if (!detached.empty() && (detached.starts_with("LIST") || detached.find('%') != std::string::npos)) {
        return cannotRead(path, "its voxels are spread over several files; convert it to one .nrrd file");
    }
    if (detached.empty() && !header.complete) {
        return cannotRead(path, "it is truncated: its header does not end; get the file again");
    }
    const fs::path data = detached.empty() ? path : path.parent_path() / detached;
    const Result<std::uint64_t> size = readableFile(data);
    if (!size.ok()) {
        return cannotRead(path, size.error().text, size.error().code);
    }
    const std::uint64_t begin = detached.empty() ? header.end : 0;
    const bool skips = !header.get("lineskip").empty() || !header.get("byteskip").empty();
    if (encoding == "raw") {
        // With a skip ITK's own count decides; it does notice that raw data is short.
        return checkLength(data, needed, *size - std::min(*size, begin));
    }
    if (encoding == "gzip" || encoding == "gz") {
        if (skips) {
            return cannotRead(path, "compressed data behind skipped lines or bytes is not supported; write it anew");
        }
        const Result<std::uint64_t> length = inflatedLength(data, begin, Compression::Gzip);
        if (!length.ok()) {
            return length.error();
        }
        return checkLength(data, needed, *length);
    }
    return cannotRead(path, "its encoding '" + oneLine(encoding) + "' is not supported; write it as raw or gzip");
}

} // namespace

Result<ContainerFacts> checkNrrd(const fs::path& path) {
    const Result<std::string> head = contentHead(path, 7);
    if (!head.ok()) {
        return head.error();
    }
    if (!head->starts_with("NRRD000")) {
        return cannotRead(path, "it is not a NRRD file (it does not begin with NRRD000)");
    }
    const NrrdHeader header = readHeader(path);
    for (const char* needed : {"type", "dimension", "sizes", "encoding"}) {
        if (header.get(needed).empty()) {
            return cannotRead(path, std::string("it is truncated or damaged: its NRRD header has no '") + needed + "'");
        }
    }
    const Result<std::vector<std::int64_t>> sizes = sizesOf(path, header);
    if (!sizes.ok()) {
        return sizes.error();
    }
    const std::uint64_t bytes = voxelBytes(header.get("type"));
    if (bytes == 0) {
        return cannotRead(path, "its voxels are of the type '" + oneLine(header.get("type")) +
                                    "', which is not supported; convert it to integers or floats");
    }
    if (Result<void> axes = checkAxes(path, header); !axes.ok()) {
        return axes.error();
    }
    const Result<std::uint64_t> needed = imageBytes(path, *sizes, bytes);
    if (!needed.ok()) {
        return needed.error();
    }
    if (Result<void> data = checkData(path, header, *needed); !data.ok()) {
        return data.error();
    }
    ContainerFacts facts{VolumeFormat::Nrrd, path, {}};
    const std::string space = withoutBlanks(header.get("space"));
    if (space == "left-anterior-superior" || space == "las") {
        // ITK 5.2 negates x instead of y.
        return cannotRead(path, "its space is left-anterior-superior, which ITK puts in the wrong place; write it as "
                                "left-posterior-superior");
    }
    if (space != "left-posterior-superior" && space != "lps" && space != "right-anterior-superior" && space != "ras") {
        facts.notes.emplace_back(
            "the file does not say how the patient lies (its 'space' is not an anatomical one); its "
            "axes are taken as left, posterior, superior");
    }
    return facts;
}

} // namespace voxtact::io
