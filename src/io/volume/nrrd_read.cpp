// SPDX-License-Identifier: MIT
#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "io/volume/nrrd_header.h"

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

Result<VoxelFiles::Coding> codingOf(const fs::path& path, const NrrdHeader& header) {
    const std::string encoding = withoutBlanks(header.get("encoding"));
    if (encoding == "raw") {
        return VoxelFiles::Coding::Raw;
    }
    if (encoding == "gzip" || encoding == "gz") {
        return VoxelFiles::Coding::Gzip;
    }
    if (encoding == "ascii" || encoding == "text" || encoding == "txt") {
        return VoxelFiles::Coding::Text;
    }
    return cannotRead(path, "its encoding " + inQuotes(encoding) + " is not supported; write it as raw or gzip");
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

Result<VoxelFiles> filesOf(const fs::path& path, const NrrdHeader& header, StoredType type) {
    VoxelFiles files;
    const Result<VoxelFiles::Coding> coding = codingOf(path, header);
    VOXTACT_TRY(coding);
    files.coding = *coding;
    const std::string detached = header.get("datafile");
    if (!header.listed.empty()) {
        files.names = header.listed;
    } else if (detached.find('%') != std::string::npos) {
        std::optional<std::vector<std::string>> names = numberedNames(detached);
        if (!names) {
            return cannotRead(path, "its 'data file' " + inQuotes(detached) +
                                        " is no pattern of file names (NAME%03d.raw FIRST LAST STEP)");
        }
        files.names = std::move(*names);
    } else if (!detached.empty()) {
        files.names = {detached};
    } else if (!header.complete) {
        return cannotRead(path, "it is truncated: its header does not end; get the file again");
    }
    const std::optional<std::int64_t> lines = header.integer("lineskip");
    const std::optional<std::int64_t> bytes = header.integer("byteskip");
    if (!lines || *lines < 0 || !bytes || *bytes < -1) {
        return cannotRead(path, "its NRRD header is damaged: 'line skip' or 'byte skip' is not a number");
    }
    files.skippedLines = *lines;
    files.skippedBytes = *bytes;
    if (files.coding != VoxelFiles::Coding::Text) {
        const Result<bool> swapped = isSwapped(path, header, type);
        VOXTACT_TRY(swapped);
        files.swapped = *swapped;
    }
    return files;
}

} // namespace

Result<ContainedImage> readNrrd(const VolumeSource& source, const fs::path& path) {
    Result<ByteReader> reader = source.open(path);
    VOXTACT_TRY(reader);
    const Result<NrrdHeader> header = readNrrdHeader(*reader);
    VOXTACT_TRY(header);
    return readNrrdImage(source, std::move(*reader), *header);
}

Result<ContainedImage> readNrrdImage(const VolumeSource& source, ByteReader reader, const NrrdHeader& header,
                                     std::size_t axis, std::uint32_t times) {
    const fs::path path = reader.path();
    const Result<NrrdAxes> axes = nrrdAxes(path, header);
    VOXTACT_TRY(axes);
    const std::optional<StoredType> type = storedType(header.get("type"));
    if (!type) {
        return cannotRead(path, "its voxels are of the type " + inQuotes(header.get("type")) +
                                    ", which is not supported; convert it to integers or floats");
    }
    VOXTACT_TRY(imageBytes(path, axes->sizes, storedBytes(*type)));
    std::vector<std::int64_t> widened = axes->sizes;
    widened[axis] *= times; // both have 32 bits now
    VOXTACT_TRY(imageBytes(path, widened, storedBytes(*type)));
    ContainedImage contained;
    const Result<Grid> grid = nrrdGrid(path, header, *axes, contained.notes);
    VOXTACT_TRY(grid);
    const Result<VoxelFiles> files = filesOf(path, header, *type);
    VOXTACT_TRY(files);
    for (const char* field : {"oldmin", "oldmax"}) {
        if (!header.get(field).empty()) {
            contained.notes.push_back("the file says 'old " + std::string(field + 3) +
                                      "', a range that its voxels had before; they are taken as they are stored");
            break;
        }
    }
    contained.image = {*grid, *type, std::nullopt, {}};
    contained.image.grid.size[axis] *= times;
    VOXTACT_TRY(readVoxels(source, std::move(reader), *files, contained));
    contained.image.grid.size[axis] = grid->size[axis];
    return contained;
}

} // namespace voxtact::io
