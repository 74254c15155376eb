// SPDX-License-Identifier: MIT
#include "io/mesh/vtk/vtp_data.h"

#include "io/byte_source.h"
#include "io/mesh/mesh_text.h"
#include "io/mesh/vtk/vtk_cells.h"
#include "io/text/base64.h"
#include "io/text/text_lines.h"

#include <algorithm>
#include <array>
#include <bit>
#include <new>
#include <utility>

#include <zlib.h>

namespace voxtact::io {

namespace {

constexpr const char* kDamaged = "is cut off or damaged; get the file again";

std::string nameOf(pugi::xml_node array) {
    const std::string_view name = array.attribute("Name").value();
    return name.empty() ? "an array" : "the array " + inQuotes(name);
}

StoredType typeOf(pugi::xml_node array) {
    constexpr std::array<std::pair<std::string_view, StoredType>, 10> kTypes{{{"Int8", StoredType::Int8},
                                                                              {"UInt8", StoredType::UInt8},
                                                                              {"Int16", StoredType::Int16},
                                                                              {"UInt16", StoredType::UInt16},
                                                                              {"Int32", StoredType::Int32},
                                                                              {"UInt32", StoredType::UInt32},
                                                                              {"Int64", StoredType::Int64},
                                                                              {"UInt64", StoredType::UInt64},
                                                                              {"Float32", StoredType::Float32},
                                                                              {"Float64", StoredType::Float64}}};
    const std::string_view type = array.attribute("type").value();
    for (const auto& [name, known] : kTypes) {
        if (name == type) {
            return known;
        }
    }
    throw VtpRefusal{nameOf(array) + " is of the unknown type " + inQuotes(type)};
}

bool isText(pugi::xml_node array) {
    return std::string_view(array.attribute("format").value()) == "ascii";
}

std::vector<std::uint64_t> writtenNaturals(pugi::xml_node array) {
    std::vector<std::uint64_t> values;
    std::vector<std::string_view> words;
    splitTokens(array.text().get(), words);
    for (const std::string_view word : words) {
        const std::optional<std::uint64_t> value = parseNatural(word);
        if (!value) {
            throw VtpRefusal{nameOf(array) + ": " + inQuotes(word) + " is not a natural number"};
        }
        values.push_back(*value);
    }
    return values;
}

void appendInflated(std::string_view packed, std::size_t length, std::string& bytes) {
    const std::size_t begin = bytes.size();
    bytes.resize(begin + length);
    auto got = static_cast<uLongf>(length);
    const int status = ::uncompress(reinterpret_cast<Bytef*>(bytes.data() + begin), &got,
                                    reinterpret_cast<const Bytef*>(packed.data()), static_cast<uLong>(packed.size()));
    if (status == Z_MEM_ERROR) {
        throw std::bad_alloc();
    }
    if (status != Z_OK || got != length) {
        throw VtpRefusal{kDamaged};
    }
}

} // namespace

std::uint64_t vtpNatural(pugi::xml_node node, const char* attribute) {
    const std::string_view text = node.attribute(attribute).value();
    const std::optional<std::uint64_t> value = text.empty() ? 0 : parseNatural(text);
    if (!value) {
        throw VtpRefusal{std::string(attribute) + " is " + inQuotes(text) + ", which is no natural number"};
    }
    return *value;
}

VtpData::VtpData(pugi::xml_node root, std::string_view appended, bool isBase64)
    : appended_(appended), isBase64_(isBase64) {
    const std::string_view order = root.attribute("byte_order").value();
    hasByteOrder_ = order == "LittleEndian" || order == "BigEndian";
    isSwapped_ = (order == "BigEndian") == (std::endian::native == std::endian::little);
    const std::string_view header = root.attribute("header_type").value();
    headerBytes_ = header == "UInt64" ? 8 : 4;
    if (!header.empty() && header != "UInt64" && header != "UInt32") {
        throw VtpRefusal{"its header_type " + inQuotes(header) + " is neither UInt32 nor UInt64"};
    }
    const std::string_view compressor = root.attribute("compressor").value();
    isCompressed_ = !compressor.empty();
    if (isCompressed_ && compressor != "vtkZLibDataCompressor") {
        throw VtpRefusal{"its data is compressed by " + inQuotes(compressor) + "; save it with zlib or uncompressed"};
    }
}

std::vector<double> VtpData::reals(pugi::xml_node array) const {
    const StoredType type = typeOf(array);
    std::vector<double> values;
    if (!isText(array)) {
        checkByteOrder(type);
        appendVtkReals(bytesOf(array), type, isSwapped_, values);
        return values;
    }
    std::vector<std::string_view> words;
    splitTokens(array.text().get(), words);
    values.resize(words.size());
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (const auto reason = parseNumber(words[i], values[i])) {
            throw VtpRefusal{nameOf(array) + ": " + *reason};
        }
    }
    return values;
}

std::vector<std::uint64_t> VtpData::naturals(pugi::xml_node array) const {
    const StoredType type = typeOf(array);
    if (isText(array)) {
        return writtenNaturals(array);
    }
    std::vector<std::uint64_t> values;
    checkByteOrder(type);
    if (!appendVtkNaturals(bytesOf(array), type, isSwapped_, values)) {
        throw VtpRefusal{nameOf(array) + " holds numbers that are negative or not whole"};
    }
    return values;
}

std::string VtpData::text(pugi::xml_node array) const {
    std::string characters;
    if (isText(array)) {
        for (const std::uint64_t code : writtenNaturals(array)) {
            characters += static_cast<char>(code < 128 ? code : '?');
        }
    } else {
        characters = bytesOf(array);
    }
    return characters.substr(0, characters.find('\0'));
}

void VtpData::checkByteOrder(StoredType type) const {
    if (!hasByteOrder_ && (storedBytes(type) > 1 || isCompressed_)) {
        throw VtpRefusal{"its VTKFile does not say its byte_order (LittleEndian or BigEndian)"};
    }
}

std::string VtpData::Block::take(std::uint64_t count) {
    if (count > rest.size()) {
        throw VtpRefusal{kDamaged};
    }
    if (isBase64) {
        std::optional<std::string> bytes = takeBase64(rest, static_cast<std::size_t>(count));
        if (!bytes) {
            throw VtpRefusal{kDamaged};
        }
        return std::move(*bytes);
    }
    std::string bytes(rest.substr(0, static_cast<std::size_t>(count)));
    rest.remove_prefix(static_cast<std::size_t>(count));
    return bytes;
}

std::string VtpData::bytesOf(pugi::xml_node array) const {
    const std::string_view format = array.attribute("format").value();
    Block block;
    if (format == "binary") {
        block = {array.text().get(), true};
    } else if (format == "appended") {
        const std::uint64_t offset = vtpNatural(array, "offset");
        if (offset >= appended_.size()) {
            throw VtpRefusal{nameOf(array) + " lies behind the appended data, which " + kDamaged};
        }
        block = {appended_.substr(static_cast<std::size_t>(offset)), isBase64_};
    } else {
        throw VtpRefusal{nameOf(array) + " has the unknown format " + inQuotes(format)};
    }
    try {
        return isCompressed_ ? inflated(block) : plain(block);
    } catch (const VtpRefusal& refusal) {
        throw VtpRefusal{nameOf(array) + " " + refusal.reason};
    }
}

std::uint64_t VtpData::headerNumber(std::string_view header, std::size_t index) const {
    return headerBytes_ == 8 ? numberAt<std::uint64_t>(header, 8 * index, isSwapped_)
                             : numberAt<std::uint32_t>(header, 4 * index, isSwapped_);
}

std::string VtpData::plain(Block block) const {
    // In base64, the header and the data are one run of digits.
    const std::uint64_t length = headerNumber(Block(block).take(headerBytes_), 0);
    if (length > block.rest.size()) {
        throw VtpRefusal{kDamaged};
    }
    return block.take(headerBytes_ + length).substr(headerBytes_);
}

std::string VtpData::inflated(Block block) const {
    const std::uint64_t blocks = headerNumber(Block(block).take(3 * headerBytes_), 0);
    if (blocks > block.rest.size() / headerBytes_) {
        throw VtpRefusal{kDamaged};
    }
    const std::string header = block.take((3 + blocks) * headerBytes_);
    const std::uint64_t full = headerNumber(header, 1);
    const std::uint64_t last = headerNumber(header, 2);
    const auto lengthOf = [&](std::size_t i) { return i + 1 == blocks && last != 0 ? last : full; };
    constexpr std::uint64_t kMaxRatio = 1032; // of deflate
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < blocks; ++i) {
        const std::uint64_t stored = headerNumber(header, 3 + i);
        // A length that lies must not take memory.
        if (stored > block.rest.size() - total || lengthOf(i) > kMaxRatio * stored) {
            throw VtpRefusal{kDamaged};
        }
        total += stored;
    }
    const std::string packed = block.take(total);
    std::string bytes;
    std::size_t at = 0;
    for (std::size_t i = 0; i < blocks; ++i) {
        const auto stored = static_cast<std::size_t>(headerNumber(header, 3 + i));
        appendInflated(std::string_view(packed).substr(at, stored), static_cast<std::size_t>(lengthOf(i)), bytes);
        at += stored;
    }
    return bytes;
}

} // namespace voxtact::io
