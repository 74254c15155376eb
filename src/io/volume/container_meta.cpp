// SPDX-License-Identifier: MIT
#include "io/byte_source.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "io/volume/volume_container.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

struct MetaHeader {
    std::map<std::string, std::string, std::less<>> fields;
    std::uint64_t end = 0; ///< where the voxels of a LOCAL file begin

    [[nodiscard]] std::string_view get(std::string_view key) const {
        const auto found = fields.find(key);
        return found == fields.end() ? std::string_view() : std::string_view(found->second);
    }
    [[nodiscard]] bool isTrue(std::string_view key) const {
        return get(key).starts_with('T') || get(key).starts_with('t') || get(key) == "1";
    }
};

/// `Key = value` lines; ElementDataFile is the last one.
Result<MetaHeader> readHeader(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    MetaHeader header;
    std::string line;
    constexpr std::uint64_t kLongest = 1 << 20;
    while (header.end < kLongest && std::getline(file, line)) {
        header.end += line.size() + (file.eof() ? 0 : 1);
        const std::size_t equals = line.find('=');
        if (equals == std::string::npos) {
            if (trimmed(line).empty()) {
                continue;
            }
            break;
        }
        const std::string key(trimmed(std::string_view(line).substr(0, equals)));
        header.fields[key] = trimmed(std::string_view(line).substr(equals + 1));
        if (key == "ElementDataFile") {
            break;
        }
    }
    for (const char* needed : {"NDims", "DimSize", "ElementType", "ElementDataFile"}) {
        if (header.get(needed).empty()) {
            return cannotRead(path, std::string("it is not a MetaImage file, or it is truncated: its header has no '") +
                                        needed + "'");
        }
    }
    return header;
}

std::optional<std::int64_t> integer(std::string_view token) {
    std::int64_t value = 0;
    const auto end = std::from_chars(token.data(), token.data() + token.size(), value);
    return end.ec == std::errc{} && end.ptr == token.data() + token.size() ? std::optional(value) : std::nullopt;
}

Result<std::vector<std::int64_t>> sizesOf(const fs::path& path, const MetaHeader& header) {
    std::vector<std::string_view> tokens;
    splitTokens(header.get("DimSize"), tokens);
    std::vector<std::int64_t> sizes;
    for (const std::string_view token : tokens) {
        sizes.push_back(integer(token).value_or(0));
    }
    if (integer(header.get("NDims")) != static_cast<std::int64_t>(sizes.size())) {
        return cannotRead(path, "its MetaImage header is damaged: 'DimSize' does not have 'NDims' numbers");
    }
    return sizes;
}

Result<std::uint64_t> voxelBytes(const fs::path& path, const MetaHeader& header) {
    struct Known {
        std::string_view name;
        std::uint64_t bytes;
    };
    constexpr std::array<Known, 12> kScalars{{{"MET_CHAR", 1},
                                              {"MET_UCHAR", 1},
                                              {"MET_SHORT", 2},
                                              {"MET_USHORT", 2},
                                              {"MET_INT", 4},
                                              {"MET_UINT", 4},
                                              {"MET_LONG", 4},
                                              {"MET_ULONG", 4},
                                              {"MET_LONG_LONG", 8},
                                              {"MET_ULONG_LONG", 8},
                                              {"MET_FLOAT", 4},
                                              {"MET_DOUBLE", 8}}};
    const std::string_view type = header.get("ElementType");
    const auto known = std::find_if(kScalars.begin(), kScalars.end(), [&](const Known& k) { return k.name == type; });
    const std::string_view channels = header.get("ElementNumberOfChannels");
    if (known == kScalars.end() || (!channels.empty() && channels != "1")) {
        return cannotRead(path, "its voxels are not single numbers (" + std::string(type) +
                                    (channels.empty() ? "" : ", " + std::string(channels) + " channels") +
                                    "); convert it to integers or floats");
    }
    return known->bytes;
}

/// MetaIO prints what it cannot parse, and goes on with what it has.
Result<void> checkGeometry(const fs::path& path, const MetaHeader& header, std::size_t dimensions) {
    struct Field {
        std::string_view name;
        std::size_t numbers;
    };
    const std::size_t square = dimensions * dimensions;
    const std::array<Field, 9> fields{{{"TransformMatrix", square},
                                       {"Rotation", square},
                                       {"Orientation", square},
                                       {"Offset", dimensions},
                                       {"Position", dimensions},
                                       {"Origin", dimensions},
                                       {"CenterOfRotation", dimensions},
                                       {"ElementSpacing", dimensions},
                                       {"ElementSize", dimensions}}};
    std::vector<std::string_view> tokens;
    for (const Field& field : fields) {
        splitTokens(header.get(field.name), tokens);
        const bool isThere = header.fields.contains(field.name);
        double ignored = 0;
        const bool isNumeric = std::none_of(tokens.begin(), tokens.end(), [&](std::string_view token) {
            return parseNumber(token, ignored).has_value();
        });
        if (isThere && (!isNumeric || tokens.size() != field.numbers)) {
            return cannotRead(path, "its MetaImage header is damaged: '" + std::string(field.name) + "' needs " +
                                        std::to_string(field.numbers) + " numbers");
        }
    }
    return {};
}

Result<void> checkData(const fs::path& path, const MetaHeader& header, std::uint64_t needed) {
    const std::string_view name = header.get("ElementDataFile");
    const bool local = name == "LOCAL" || name == "Local" || name == "local";
    if (name.starts_with("LIST") || name.find('%') != std::string_view::npos) {
        return cannotRead(path, "its voxels are spread over several files; convert it to one .mha file");
    }
    const fs::path data = local ? path : path.parent_path() / name;
    const Result<std::uint64_t> size = readableFile(data);
    if (!size.ok()) {
        return cannotRead(path, size.error().text, size.error().code);
    }
    const std::uint64_t begin = local ? header.end : 0;
    if (header.isTrue("CompressedData")) {
        if (header.get("CompressedDataSize").empty()) {
            return cannotRead(path, "its header has no 'CompressedDataSize', which ITK needs; write it anew");
        }
        const Result<std::uint64_t> length = inflatedLength(data, begin, Compression::Zlib);
        if (!length.ok()) {
            return length.error();
        }
        return checkLength(data, needed, *length);
    }
    const std::int64_t skip = header.get("HeaderSize").empty() ? 0 : integer(header.get("HeaderSize")).value_or(-2);
    if (skip < -1) {
        return cannotRead(path, "its 'HeaderSize' is not a number");
    }
    // -1: the voxels are the end of the file.
    const std::uint64_t offset = begin + (skip > 0 ? static_cast<std::uint64_t>(skip) : 0);
    return checkLength(data, needed, *size - std::min(*size, offset));
}

} // namespace

Result<ContainerFacts> checkMeta(const fs::path& path) {
    const Result<MetaHeader> header = readHeader(path);
    if (!header.ok()) {
        return header.error();
    }
    const Result<std::vector<std::int64_t>> sizes = sizesOf(path, *header);
    if (!sizes.ok()) {
        return sizes.error();
    }
    if (Result<void> geometry = checkGeometry(path, *header, sizes->size()); !geometry.ok()) {
        return geometry.error();
    }
    const Result<std::uint64_t> bytes = voxelBytes(path, *header);
    if (!bytes.ok()) {
        return bytes.error();
    }
    const Result<std::uint64_t> needed = imageBytes(path, *sizes, *bytes);
    if (!needed.ok()) {
        return needed.error();
    }
    if (!header->get("BinaryData").empty() && !header->isTrue("BinaryData")) {
        return cannotRead(path, "its voxels are text, where a missing end goes unseen; write it as binary data");
    }
    if (Result<void> data = checkData(path, *header, *needed); !data.ok()) {
        return data.error();
    }
    return ContainerFacts{VolumeFormat::Meta, path, {}};
}

} // namespace voxtact::io
