// SPDX-License-Identifier: MIT
#include "core/base/text.h"

#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "io/volume/length_unit.h"
#include "io/volume/volume_container.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <map>
#include <span>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

struct MetaHeader {
    std::map<std::string, std::string, std::less<>> fields;
    std::vector<std::string> listed; ///< the files that follow "ElementDataFile = LIST"

    [[nodiscard]] bool has(std::string_view key) const { return fields.find(key) != fields.end(); }
    [[nodiscard]] bool hasAny(std::span<const std::string_view> keys) const {
        return std::any_of(keys.begin(), keys.end(), [this](std::string_view key) { return has(key); });
    }
    [[nodiscard]] std::string_view get(std::string_view key) const {
        const auto found = fields.find(key);
        return found == fields.end() ? std::string_view() : std::string_view(found->second);
    }
    [[nodiscard]] bool isTrue(std::string_view key) const {
        return get(key).starts_with('T') || get(key).starts_with('t') || get(key) == "1";
    }
};

/// `Key = value` or `Key: value` lines; ElementDataFile is the last one, and a LOCAL file's voxels are next.
Result<MetaHeader> readHeader(ByteReader& reader) {
    MetaHeader header;
    constexpr std::size_t kLongest = 1 << 20;
    std::size_t length = 0;
    while (length < kLongest) {
        const Result<std::optional<std::string>> read = reader.line(kLongest - length);
        VOXTACT_TRY(read);
        const std::optional<std::string>& line = *read;
        if (!line) {
            break;
        }
        length += line->size() + 1;
        const std::size_t equals = line->find_first_of("=:");
        if (equals == std::string::npos) {
            if (trimmed(*line).empty()) {
                continue;
            }
            break;
        }
        const std::string key(trimmed(std::string_view(*line).substr(0, equals)));
        const std::string value(trimmed(std::string_view(*line).substr(equals + 1)));
        const auto [field, isNew] = header.fields.try_emplace(key, value);
        // Comments may be many.
        if (!isNew && field->second != value && key != "Comment") {
            return cannotRead(reader.path(), "its MetaImage header is damaged: it says " + inQuotes(key) +
                                                 " twice, first " + inQuotes(field->second) + " and then " +
                                                 inQuotes(value));
        }
        if (key == "ElementDataFile") {
            // "LIST 2D" says how many axes the image of a file has.
            if (value.starts_with("LIST")) {
                Result<std::vector<std::string>> names = listedNames(reader);
                VOXTACT_TRY(names);
                header.listed = std::move(*names);
            }
            break;
        }
    }
    for (const char* needed : {"NDims", "DimSize", "ElementType", "ElementDataFile"}) {
        if (header.get(needed).empty()) {
            return cannotRead(reader.path(),
                              std::string("it is not a MetaImage file, or it is truncated: its header has no '") +
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

Result<StoredType> storedType(const fs::path& path, const MetaHeader& header) {
    struct Known {
        std::string_view name;
        StoredType type;
    };
    // MetaIO's longs have four bytes on every machine.
    constexpr std::array<Known, 12> kScalars{{{"MET_CHAR", StoredType::Int8},
                                              {"MET_UCHAR", StoredType::UInt8},
                                              {"MET_SHORT", StoredType::Int16},
                                              {"MET_USHORT", StoredType::UInt16},
                                              {"MET_INT", StoredType::Int32},
                                              {"MET_UINT", StoredType::UInt32},
                                              {"MET_LONG", StoredType::Int32},
                                              {"MET_ULONG", StoredType::UInt32},
                                              {"MET_LONG_LONG", StoredType::Int64},
                                              {"MET_ULONG_LONG", StoredType::UInt64},
                                              {"MET_FLOAT", StoredType::Float32},
                                              {"MET_DOUBLE", StoredType::Float64}}};
    const std::string_view type = header.get("ElementType");
    const auto known = std::find_if(kScalars.begin(), kScalars.end(), [&](const Known& k) { return k.name == type; });
    const std::string_view channels = header.get("ElementNumberOfChannels");
    if (known == kScalars.end() || (!channels.empty() && channels != "1")) {
        return cannotRead(path, "its voxels are not single numbers (" + inQuotes(type) +
                                    (channels.empty() ? "" : ", " + inQuotes(channels) + " channels") +
                                    "); convert it to integers or floats");
    }
    return known->type;
}

/// Names of fields that mean the same.
constexpr std::array<std::string_view, 3> kMatrices{"TransformMatrix", "Rotation", "Orientation"};
constexpr std::array<std::string_view, 3> kOrigins{"Offset", "Position", "Origin"};
constexpr std::array<std::string_view, 1> kSpacings{"ElementSpacing"};
constexpr std::array<std::string_view, 1> kSizes{"ElementSize"};
constexpr std::array<std::string_view, 1> kCentres{"CenterOfRotation"};
constexpr std::array<std::string_view, 2> kByteOrders{"BinaryDataByteOrderMSB", "ElementByteOrderMSB"};

/// The numbers of the first field that is there; a field under two names must say the same.
Result<std::vector<double>> numbersOf(const fs::path& path, const MetaHeader& header,
                                      std::span<const std::string_view> names, std::size_t count) {
    std::vector<double> numbers;
    for (const std::string_view name : names) {
        if (!header.has(name)) {
            continue;
        }
        std::vector<std::string_view> tokens;
        splitTokens(header.get(name), tokens);
        std::vector<double> here(tokens.size());
        for (std::size_t i = 0; i < tokens.size(); ++i) {
            if (tokens.size() != count || parseNumber(tokens[i], here[i])) {
                here.clear();
                break;
            }
        }
        if (here.size() != count) {
            return cannotRead(path, "its MetaImage header is damaged: '" + std::string(name) + "' needs " +
                                        std::to_string(count) + " numbers");
        }
        if (!numbers.empty() && numbers != here) {
            return cannotRead(path, "its MetaImage header is damaged: '" + std::string(name) +
                                        "' is not what it says before under another name");
        }
        numbers = std::move(here);
    }
    return numbers;
}

LengthUnit unitOf(const MetaHeader& header) {
    return lengthUnit(header.get("DistanceUnits")).value_or(LengthUnit{});
}

Result<Grid> gridOf(const fs::path& path, const MetaHeader& header, const std::vector<std::int64_t>& sizes) {
    const std::size_t dimensions = sizes.size();
    const Result<std::vector<double>> matrix = numbersOf(path, header, kMatrices, dimensions * dimensions);
    const Result<std::vector<double>> origin = numbersOf(path, header, kOrigins, dimensions);
    const Result<std::vector<double>> spacing = numbersOf(path, header, kSpacings, dimensions);
    const Result<std::vector<double>> size = numbersOf(path, header, kSizes, dimensions);
    const Result<std::vector<double>> centre = numbersOf(path, header, kCentres, dimensions);
    for (const Result<std::vector<double>>* numbers : {&matrix, &origin, &spacing, &size, &centre}) {
        if (!numbers->ok()) {
            return numbers->error();
        }
    }
    const std::vector<double>& lengths = spacing->empty() ? *size : *spacing;
    const double unit = unitOf(header).millimetres;
    Grid grid;
    AffineSteps affine;
    affine.directions = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        grid.size[axis] = static_cast<std::uint32_t>(sizes[axis]);
        affine.lengths[axis] = lengths.empty() ? 1 : lengths[axis] * unit;
        affine.origin[axis] = origin->empty() ? 0 : (*origin)[axis] * unit;
        for (std::size_t row = 0; row < 3 && !matrix->empty(); ++row) {
            affine.directions[axis][row] = (*matrix)[axis * dimensions + row]; // a row of the file is an axis
        }
    }
    VOXTACT_TRY(setSteps(grid, affine, path));
    return grid;
}

Result<bool> isSwapped(const fs::path& path, const MetaHeader& header) {
    const auto [one, other] = kByteOrders;
    if (header.has(one) && header.has(other) && header.isTrue(one) != header.isTrue(other)) {
        return cannotRead(path, "its MetaImage header is damaged: it says two byte orders");
    }
    return (header.isTrue(one) || header.isTrue(other)) == (std::endian::native == std::endian::little);
}

Result<VoxelFiles> filesOf(const fs::path& path, const MetaHeader& header) {
    VoxelFiles files;
    const std::string_view name = header.get("ElementDataFile");
    const bool isLocal = lowered(std::string(name)) == "local";
    const bool isText = header.has("BinaryData") && !header.isTrue("BinaryData");
    files.coding = header.isTrue("CompressedData") ? VoxelFiles::Coding::ZlibOrGzip
                   : isText                        ? VoxelFiles::Coding::Text
                                                   : VoxelFiles::Coding::Raw;
    if (!header.listed.empty()) {
        files.names = header.listed;
    } else if (name.find('%') != std::string_view::npos) {
        std::optional<std::vector<std::string>> names = numberedNames(name);
        if (!names) {
            return cannotRead(path, "its 'ElementDataFile' " + inQuotes(name) +
                                        " is no pattern of file names (NAME%03d.raw FIRST LAST STEP)");
        }
        files.names = std::move(*names);
    } else if (!isLocal) {
        files.names = {std::string(name)};
    }
    const std::optional<std::int64_t> skip =
        header.get("HeaderSize").empty() ? std::optional<std::int64_t>(0) : integer(header.get("HeaderSize"));
    if (!skip || *skip < -1) {
        return cannotRead(path, "its 'HeaderSize' is not a number");
    }
    if (isLocal && *skip > 0) {
        return cannotRead(path, "its voxels follow its header, and 'HeaderSize' puts them elsewhere; mend its header");
    }
    files.skippedBytes = *skip;
    const Result<bool> swapped = isSwapped(path, header);
    VOXTACT_TRY(swapped);
    files.swapped = *swapped;
    return files;
}

std::vector<std::string> notesOf(const MetaHeader& header, const Grid& grid, StoredType type) {
    std::vector<std::string> notes;
    if (!header.hasAny(kSpacings) && !header.hasAny(kSizes)) {
        notes.emplace_back(kNoSpacing);
    }
    if (!header.hasAny(kOrigins)) {
        notes.emplace_back(kNoOrigin);
    }
    if (!header.hasAny(kMatrices)) {
        const char* const letters =
            header.has("AnatomicalOrientation") ? " ('AnatomicalOrientation' is not asked, as by ITK)" : "";
        notes.push_back(std::string("the file does not say how its axes lie") + letters +
                        "; left, posterior, superior is taken");
    }
    if (storedBytes(type) > 1 && !header.hasAny(kByteOrders) &&
        (!header.has("BinaryData") || header.isTrue("BinaryData"))) {
        notes.emplace_back("the file does not say its byte order; the least significant byte is taken as the first");
    }
    noteShear(grid, notes);
    noteUnit(unitOf(header), notes);
    for (const auto& [key, usual] :
         {std::pair{"ElementToIntensityFunctionSlope", "1"}, std::pair{"ElementToIntensityFunctionOffset", "0"}}) {
        double value = 0;
        if (header.has(key) && (parseNumber(header.get(key), value) || number(value) != usual)) {
            notes.push_back("the file's " + std::string(key) + " is " + inQuotes(header.get(key)) +
                            "; its voxels are taken as they are stored, as ITK does");
        }
    }
    return notes;
}

} // namespace

Result<ContainedImage> readMeta(const VolumeSource& source, const fs::path& path) {
    Result<ByteReader> reader = source.open(path);
    VOXTACT_TRY(reader);
    const Result<MetaHeader> header = readHeader(*reader);
    VOXTACT_TRY(header);
    const Result<std::vector<std::int64_t>> sizes = sizesOf(path, *header);
    VOXTACT_TRY(sizes);
    const Result<StoredType> type = storedType(path, *header);
    VOXTACT_TRY(type);
    VOXTACT_TRY(imageBytes(path, *sizes, storedBytes(*type)));
    const Result<Grid> grid = gridOf(path, *header, *sizes);
    VOXTACT_TRY(grid);
    const Result<VoxelFiles> files = filesOf(path, *header);
    VOXTACT_TRY(files);
    ContainedImage contained{{*grid, *type, std::nullopt, {}}, notesOf(*header, *grid, *type)};
    VOXTACT_TRY(readVoxels(source, std::move(*reader), *files, contained));
    return contained;
}

} // namespace voxtact::io
