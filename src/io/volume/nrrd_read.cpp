// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "io/volume/nrrd_header.h"

#include <algorithm>
#include <array>
#include <bit>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

std::optional<StoredType> storedType(const std::string& type) {
    struct Known {
        std::array<std::string_view, 7> names;
        StoredType type;
    };
    constexpr std::array<Known, 10> kTypes{{
        {{"signed char", "int8", "int8_t"}, StoredType::Int8},
        {{"uchar", "unsigned char", "uint8", "uint8_t"}, StoredType::UInt8},
        {{"short", "short int", "signed short", "signed short int", "int16", "int16_t"}, StoredType::Int16},
        {{"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}, StoredType::UInt16},
        {{"int", "signed int", "int32", "int32_t"}, StoredType::Int32},
        {{"uint", "unsigned int", "uint32", "uint32_t"}, StoredType::UInt32},
        {{"longlong", "long long", "long long int", "signed long long", "signed long long int", "int64", "int64_t"},
         StoredType::Int64},
        {{"ulonglong", "unsigned long long", "unsigned long long int", "uint64", "uint64_t"}, StoredType::UInt64},
        {{"float"}, StoredType::Float32},
        {{"double"}, StoredType::Float64},
    }};
    for (const Known& known : kTypes) {
        for (const std::string_view name : known.names) {
            if (!name.empty() && name == type) {
                return known.type;
            }
        }
    }
    return std::nullopt;
}

constexpr std::string_view kRaw = "raw";

std::string encodingOf(const NrrdHeader& header) {
    return withoutBlanks(header.get("encoding"));
}

Result<void> checkEncoding(const fs::path& path, const NrrdHeader& header) {
    const std::string encoding = encodingOf(header);
    if (encoding != kRaw && encoding != "gzip" && encoding != "gz") {
        return cannotRead(path, "its encoding " + inQuotes(encoding) + " is not supported; write it as raw or gzip");
    }
    return {};
}

Result<bool> isSwapped(const fs::path& path, const NrrdHeader& header, StoredType type) {
    const std::string endian = withoutBlanks(header.get("endian"));
    if (storedBytes(type) == 1) {
        return false;
    }
    if (endian != "little" && endian != "big") {
        return cannotRead(path, "its NRRD header is damaged: it does not say its byte order ('endian')");
    }
    return (endian == "big") == (std::endian::native == std::endian::little);
}

/// Lines and bytes in front of the voxels; -1 bytes: the voxels are the end of the file.
Result<void> skipBefore(ByteReader& reader, std::int64_t lines, std::int64_t bytes, std::uint64_t needed) {
    for (std::int64_t i = 0; i < lines && reader.stored() > 0; ++i) {
        do {
            constexpr std::size_t kPiece = 1 << 16;
            const Result<std::optional<std::string>> line = reader.line(kPiece);
            VOXTACT_TRY(line);
            if (!line->has_value()) {
                break;
            }
        } while (!reader.lineEnded());
    }
    const std::uint64_t before =
        bytes < 0 ? reader.stored() - std::min(needed, reader.stored()) : static_cast<std::uint64_t>(bytes);
    const Result<std::uint64_t> skipped = reader.skip(before);
    return skipped.ok() ? Result<void>{} : Result<void>{skipped.error()};
}

/// A reader that stands at the first voxel: `attached` where the header's file holds them.
Result<ByteReader> openVoxels(const VolumeSource& source, ByteReader attached, const NrrdHeader& header,
                              std::uint64_t needed) {
    const fs::path path = attached.path();
    const std::string detached = header.get("datafile");
    if (!detached.empty() && (detached.starts_with("LIST") || detached.find('%') != std::string::npos)) {
        return cannotRead(path, "its voxels are spread over several files; convert it to one .nrrd file");
    }
    if (detached.empty() && !header.complete) {
        return cannotRead(path, "it is truncated: its header does not end; get the file again");
    }
    const std::optional<std::int64_t> lines = header.integer("lineskip");
    const std::optional<std::int64_t> bytes = header.integer("byteskip");
    if (!lines || *lines < 0 || !bytes || *bytes < -1) {
        return cannotRead(path, "its NRRD header is damaged: 'line skip' or 'byte skip' is not a number");
    }
    Result<ByteReader> reader = detached.empty() ? std::move(attached) : source.openBeside(path, detached);
    VOXTACT_TRY(reader);
    if (encodingOf(header) == kRaw) {
        const Result<void> skipped = skipBefore(*reader, *lines, *bytes, needed);
        return skipped.ok() ? std::move(reader) : Result<ByteReader>(skipped.error());
    }
    if (*lines != 0 || *bytes != 0) {
        return cannotRead(path, "compressed data behind skipped lines or bytes is not supported; write it anew");
    }
    const Result<void> unpacked = reader->unpack(ByteReader::Packing::Gzip);
    return unpacked.ok() ? std::move(reader) : Result<ByteReader>(unpacked.error());
}

} // namespace

Result<ContainedImage> readNrrd(const VolumeSource& source, const fs::path& path) {
    Result<ByteReader> reader = source.open(path);
    VOXTACT_TRY(reader);
    const Result<NrrdHeader> header = readNrrdHeader(*reader);
    VOXTACT_TRY(header);
    const Result<std::vector<std::int64_t>> sizes = nrrdSizes(path, *header);
    VOXTACT_TRY(sizes);
    const std::optional<StoredType> type = storedType(header->get("type"));
    if (!type) {
        return cannotRead(path, "its voxels are of the type " + inQuotes(header->get("type")) +
                                    ", which is not supported; convert it to integers or floats");
    }
    VOXTACT_TRY(checkEncoding(path, *header));
    const Result<std::uint64_t> needed = imageBytes(path, *sizes, storedBytes(*type));
    VOXTACT_TRY(needed);
    ContainedImage contained;
    const Result<Grid> grid = nrrdGrid(path, *header, *sizes, contained.notes);
    VOXTACT_TRY(grid);
    const Result<bool> swapped = isSwapped(path, *header, *type);
    VOXTACT_TRY(swapped);
    Result<ByteReader> voxels = openVoxels(source, std::move(*reader), *header, *needed);
    VOXTACT_TRY(voxels);
    contained.image = {*grid, *type, std::nullopt, {}};
    VOXTACT_TRY(takeVoxels(*voxels, contained.image, *swapped));
    VOXTACT_TRY(voxels->finish());
    return contained;
}

} // namespace voxtact::io
