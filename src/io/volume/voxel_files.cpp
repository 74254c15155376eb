// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "io/volume/volume_container.h"

#include <algorithm>
#include <charconv>
#include <cstring>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = std::size_t{1} << 16;

void swapBytes(StoredImage& image) {
    const std::size_t width = storedBytes(image.type);
    for (std::size_t at = 0; width > 1 && at < image.voxels.size(); at += width) {
        std::reverse(image.voxels.data() + at, image.voxels.data() + at + width);
    }
}

Result<void> skipBefore(ByteReader& reader, const VoxelFiles& files, std::uint64_t needed) {
    for (std::int64_t i = 0; i < files.skippedLines && reader.stored() > 0; ++i) {
        do {
            constexpr std::size_t kPiece = 1 << 16;
            const Result<std::optional<std::string>> line = reader.line(kPiece);
            VOXTACT_TRY(line);
            if (!line->has_value()) {
                break;
            }
        } while (!reader.lineEnded());
    }
    VOXTACT_TRY(reader.skip(files.skippedBytes < 0 ? reader.stored() - std::min(needed, reader.stored())
                                                   : static_cast<std::uint64_t>(files.skippedBytes)));
    return {};
}

template <class Number> bool parse(std::string_view token, Number& value) {
    if constexpr (std::is_floating_point_v<Number>) {
        double wide = 0;
        const bool isNumber = !parseNumber(token, wide);
        value = static_cast<Number>(wide);
        return isNumber;
    } else {
        token.remove_prefix(token.starts_with('+') ? 1 : 0);
        const auto end = std::from_chars(token.data(), token.data() + token.size(), value);
        return end.ec == std::errc{} && end.ptr == token.data() + token.size();
    }
}

/// Appends `count` numbers that are written out, and takes them off `text`.
template <class Number>
Result<void> parseVoxels(const fs::path& path, std::string_view& text, std::uint64_t count,
                         std::vector<std::byte>& voxels) {
    for (std::uint64_t i = 0; i < count; ++i) {
        text = trimmed(text);
        const std::string_view token = text.substr(0, text.find_first_of(" \t\v\f\r\n"));
        Number value{};
        if (token.empty()) {
            return cannotRead(path, "it is truncated: it has " + std::to_string(i) + " of " + std::to_string(count) +
                                        " voxels; get the file again");
        }
        if (!parse(token, value)) {
            return cannotRead(path, "voxel " + std::to_string(i) + " is " + inQuotes(token) +
                                        ", which is no number of the type that its header says");
        }
        text.remove_prefix(token.size());
        std::byte raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        voxels.insert(voxels.end(), raw, raw + sizeof value);
    }
    return {};
}

/// Notes on the ends of the files.
struct Ends {
    std::uint64_t more = 0; ///< bytes behind the voxels
    bool open = false;      ///< a text ends in a number, which may be cut off
};

Result<void> takeText(ByteReader& reader, std::uint64_t count, StoredImage& image, Ends& ends) {
    const Result<std::string> all = reader.head(static_cast<std::size_t>(reader.stored()));
    VOXTACT_TRY(all);
    std::string_view text = *all;
    ends.open = ends.open || !trimmed(text.substr(text.size() - std::min<std::size_t>(text.size(), 1))).empty();
    VOXTACT_TRY(withStored(image.type, [&]<class Number>(Number) {
        return parseVoxels<Number>(reader.path(), text, count, image.voxels);
    }));
    ends.more += trimmed(text).size();
    return {};
}

/// Appends `share` bytes.
Result<void> takeShare(ByteReader& reader, const VoxelFiles& files, std::uint64_t share, StoredImage& image,
                       Ends& ends) {
    using Coding = VoxelFiles::Coding;
    std::vector<std::byte>& voxels = image.voxels;
    const bool isPacked = files.coding == Coding::Gzip || files.coding == Coding::ZlibOrGzip;
    if (isPacked && (files.skippedLines != 0 || files.skippedBytes != 0)) {
        return cannotRead(reader.path(), "compressed data behind skipped lines or bytes is not supported; write it "
                                         "anew");
    }
    if (files.coding == Coding::Text && files.skippedBytes < 0) {
        return cannotRead(reader.path(),
                          "voxels as text at the end of a file (a skip of -1) have no known length; state "
                          "the bytes to skip");
    }
    VOXTACT_TRY(skipBefore(reader, files, share));
    if (files.coding == Coding::Text) {
        return takeText(reader, share / storedBytes(image.type), image, ends);
    }
    if (isPacked) {
        VOXTACT_TRY(
            reader.unpack(files.coding == Coding::Gzip ? ByteReader::Packing::Gzip : ByteReader::Packing::ZlibOrGzip));
    }
    Result<std::vector<std::byte>> bytes = reader.take(share);
    VOXTACT_TRY(bytes);
    if (voxels.empty()) {
        voxels = std::move(*bytes);
    } else {
        voxels.insert(voxels.end(), bytes->begin(), bytes->end());
    }
    const Result<std::uint64_t> more = reader.finish();
    VOXTACT_TRY(more);
    ends.more += *more;
    return {};
}

} // namespace

void noteMore(std::uint64_t bytes, std::vector<std::string>& notes) {
    if (bytes != 0) {
        notes.push_back(std::to_string(bytes) + (bytes == 1 ? " byte follows" : " bytes follow") +
                        " the voxels that the header states; if the header is wrong, all voxels are shifted");
    }
}

std::optional<std::vector<std::string>> numberedNames(std::string_view pattern) {
    std::vector<std::string_view> tokens;
    splitTokens(pattern, tokens);
    std::array<std::int64_t, 3> range{0, 0, 1}; // first, last, step
    if (tokens.size() < 3 || tokens.size() > 5) {
        return std::nullopt;
    }
    for (std::size_t i = 1; i < std::min<std::size_t>(tokens.size(), 4); ++i) {
        if (!parse(tokens[i], range[i - 1])) {
            return std::nullopt;
        }
    }
    const std::string_view name = tokens[0];
    const std::size_t percent = name.find('%');
    const std::size_t letter = name.find_first_not_of("0123456789", std::min(percent, name.size() - 1) + 1);
    if (percent == std::string_view::npos || letter == std::string_view::npos || letter - percent > 3 ||
        (name[letter] != 'd' && name[letter] != 'i' && name[letter] != 'u') ||
        name.find('%', letter) != std::string_view::npos) {
        return std::nullopt;
    }
    std::string_view width = name.substr(percent + 1, letter - percent - 1);
    const char filler = width.starts_with('0') ? '0' : ' ';
    std::size_t digits = 0;
    static_cast<void>(parse(width, digits));
    const auto [first, last, step] = range;
    constexpr std::int64_t kFar = std::int64_t{1} << 40;
    if (step == 0 || std::abs(step) > kFar || first < 0 || last < 0 || first > kFar || last > kFar ||
        (last - first) / step < 0 || (last - first) / step >= static_cast<std::int64_t>(kMaxFiles)) {
        return std::nullopt;
    }
    std::vector<std::string> names;
    for (std::int64_t i = first; step > 0 ? i <= last : i >= last; i += step) {
        const std::string number = std::to_string(i);
        names.push_back(std::string(name.substr(0, percent)) +
                        std::string(digits - std::min(digits, number.size()), filler) + number +
                        std::string(name.substr(letter + 1)));
    }
    return names.empty() ? std::nullopt : std::optional(std::move(names));
}

Result<std::vector<std::string>> listedNames(ByteReader& reader) {
    constexpr std::size_t kLongest = 4096;
    std::vector<std::string> names;
    while (names.size() < kMaxFiles) {
        const Result<std::optional<std::string>> line = reader.line(kLongest);
        VOXTACT_TRY(line);
        if (!line->has_value() || trimmed(**line).empty()) {
            break;
        }
        names.emplace_back(trimmed(**line));
    }
    if (names.empty()) {
        return cannotRead(reader.path(), "its header lists no file of voxels behind 'LIST'");
    }
    return names;
}

Result<void> takeVoxels(ByteReader& reader, StoredImage& image, bool swapped) {
    Result<std::vector<std::byte>> bytes = reader.take(voxelCount(image.grid) * storedBytes(image.type));
    VOXTACT_TRY(bytes);
    image.voxels = std::move(*bytes);
    if (swapped) {
        swapBytes(image);
    }
    return {};
}

Result<void> readVoxels(const VolumeSource& source, ByteReader attached, const VoxelFiles& files,
                        ContainedImage& contained) {
    const fs::path header = attached.path();
    StoredImage& image = contained.image;
    const std::uint64_t count = std::max<std::size_t>(1, files.names.size());
    if (image.grid.size[2] % count != 0) {
        return cannotRead(header, "its voxels are in " + std::to_string(count) + " files, its " +
                                      std::to_string(image.grid.size[2]) +
                                      " slices cannot be spread over them evenly; mend its header");
    }
    const std::uint64_t share = voxelCount(image.grid) * storedBytes(image.type) / count;
    Ends ends;
    if (files.names.empty()) {
        VOXTACT_TRY(takeShare(attached, files, share, image, ends));
    }
    for (const auto& name : files.names) {
        Result<ByteReader> reader = source.openBeside(header, name);
        VOXTACT_TRY(reader);
        VOXTACT_TRY(takeShare(*reader, files, share, image, ends));
    }
    noteMore(ends.more, contained.notes);
    if (ends.open) {
        contained.notes.emplace_back("the text of the voxels ends in a number and not in a line end; that number may "
                                     "be cut off");
    }
    if (files.swapped && files.coding != VoxelFiles::Coding::Text) {
        swapBytes(image);
    }
    return {};
}

} // namespace voxtact::io
