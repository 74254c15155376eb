// SPDX-License-Identifier: MIT
#include "io/mesh/gltf_document.h"

#include "io/byte_source.h"
#include "io/errors.h"
#include "io/text/base64.h"
#include "io/text/text_lines.h"

#include <algorithm>
#include <array>

namespace voxtact::io {

namespace {

constexpr std::size_t kGlbHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

struct GlbChunks {
    std::string_view json;
    std::optional<std::string_view> binary;
};

/// The first chunk is the JSON, the second may be the binary one; others are for extensions.
GlbChunks splitGlb(std::string_view content) {
    const auto damaged = [](const std::string& what) {
        return GltfRefusal{"it is truncated or damaged: " + what + "; get the file again"};
    };
    if (content.size() < kGlbHeaderBytes + kChunkHeaderBytes || !content.starts_with("glTF")) {
        throw GltfRefusal{"it is not a GLB file"};
    }
    const auto version = numberAt<std::uint32_t>(content, 4);
    if (version != 2) {
        throw GltfRefusal{"it is glTF " + std::to_string(version) + "; glTF 2 is needed"};
    }
    if (numberAt<std::uint32_t>(content, 8) != content.size()) {
        throw damaged("its header states " + std::to_string(numberAt<std::uint32_t>(content, 8)) + " bytes, " +
                      std::to_string(content.size()) + " are there");
    }
    GlbChunks chunks;
    std::size_t number = 0;
    for (std::size_t at = kGlbHeaderBytes; at < content.size(); ++number) {
        if (content.size() - at < kChunkHeaderBytes ||
            content.size() - at - kChunkHeaderBytes < numberAt<std::uint32_t>(content, at)) {
            throw damaged("a chunk is longer than the file");
        }
        const std::size_t length = numberAt<std::uint32_t>(content, at);
        const auto type = numberAt<std::uint32_t>(content, at + 4);
        const std::string_view chunk = content.substr(at + kChunkHeaderBytes, length);
        if (number == 0) {
            if (type != kJsonChunk) {
                throw damaged("its first chunk is not JSON");
            }
            chunks.json = chunk;
        } else if (number == 1 && type == kBinaryChunk) {
            chunks.binary = chunk;
        }
        at += kChunkHeaderBytes + length;
    }
    return chunks;
}

/// Extensions that a file may require: materials, lights, and those implemented here.
bool isHarmless(const std::string& extension) {
    constexpr std::array<std::string_view, 11> kKnown{
        "KHR_mesh_quantization", "KHR_texture_transform", "KHR_texture_basisu", "KHR_lights_punctual",
        "KHR_xmp_json_ld",       "EXT_texture_webp",      "EXT_texture_avif",   "EXT_lights_image_based",
        "MSFT_texture_dds",      "KHR_animation_pointer", "KHR_node_visibility"};
    return extension.starts_with("KHR_materials_") ||
           std::find(kKnown.begin(), kKnown.end(), extension) != kKnown.end();
}

/// A relative reference with its escapes (%20) taken out.
std::filesystem::path pathOf(const std::string& uri) {
    const auto hex = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    if (uri.find("://") != std::string::npos) {
        throw GltfRefusal{"its buffer " + inQuotes(uri) + " is not in a file in its folder; save it there"};
    }
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool escape = uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0;
        text += escape ? static_cast<char>(16 * hex(uri[i + 1]) + hex(uri[i + 2])) : uri[i];
        i += escape ? 2 : 0;
    }
    if (text.find('\0') != std::string::npos) {
        throw GltfRefusal{"the name of a buffer holds a zero byte"};
    }
    return text;
}

} // namespace

GltfDocument::GltfDocument(const MeshSource& source) : source_(source) {
    GlbChunks chunks{source.content, {}};
    if (lowerEnding(source.path) == ".glb" || source.content.starts_with("glTF")) {
        chunks = splitGlb(source.content);
    }
    root_ = GltfJson::parse(chunks.json);
    binaryChunk_ = chunks.binary;
    checkVersion();
    takeExtensions();
}

void GltfDocument::checkVersion() const {
    const GltfJson* const asset = root_.is_object() ? member(root_, "asset") : nullptr;
    if (asset == nullptr || !asset->is_object()) {
        throw GltfRefusal{"it is not a glTF file (no 'asset')"};
    }
    for (const char* key : {"version", "minVersion"}) {
        const std::string version = textOf(*asset, key);
        if (!version.starts_with("2.") && !(version.empty() && key[0] == 'm')) {
            throw GltfRefusal{"it is glTF " + inQuotes(version) + "; glTF 2 is needed"};
        }
    }
    const std::string least = textOf(*asset, "minVersion");
    if (!least.empty() && least != "2.0") {
        throw GltfRefusal{"it needs a reader of glTF " + inQuotes(least) + "; this one reads 2.0"};
    }
}

void GltfDocument::takeExtensions() {
    for (const char* key : {"extensionsRequired", "extensionsUsed"}) {
        for (const GltfJson& name : list(key)) {
            if (!name.is_string()) {
                throw GltfRefusal{std::string("'") + key + "' is not a list of names"};
            }
            const auto extension = name.get<std::string>();
            if (key == std::string_view("extensionsRequired") && !isHarmless(extension)) {
                throw GltfRefusal{"it requires the extension " + inQuotes(extension) +
                                  ", which is not supported; export it without"};
            }
            extensions_.insert(extension);
        }
    }
}

const GltfJson& GltfDocument::list(const char* key) const {
    static const GltfJson kNone = GltfJson::array();
    const GltfJson* const found = member(root_, key);
    if (found != nullptr && !found->is_array()) {
        throw GltfRefusal{std::string("'") + key + "' is not a list"};
    }
    return found == nullptr ? kNone : *found;
}

const GltfJson& GltfDocument::item(const char* key, std::uint64_t index) const {
    const GltfJson& all = list(key);
    if (index >= all.size() || !all[index].is_object()) {
        throw GltfRefusal{"it refers to number " + std::to_string(index) + " of its '" + key +
                          "', which does not exist"};
    }
    return all[index];
}

std::string GltfDocument::load(std::uint64_t index, const std::string& uri) const {
    if (uri.starts_with("data:")) {
        const std::size_t comma = uri.find(";base64,");
        if (comma == std::string::npos) {
            throw GltfRefusal{"the data of buffer " + std::to_string(index) + " is not base64"};
        }
        std::optional<std::string> bytes = decodedBase64(std::string_view(uri).substr(comma + 8));
        if (!bytes) {
            throw GltfRefusal{"a buffer's base64 is damaged"};
        }
        return std::move(*bytes);
    }
    const std::filesystem::path path = pathOf(uri);
    if (!source_.other) {
        throw GltfRefusal{"its buffer " + inQuotes(uri) + " is another file"};
    }
    Result<std::string> content = source_.other(path);
    if (!content.ok()) {
        throw GltfRefusal{content.error().text};
    }
    return std::move(*content);
}

std::string_view GltfDocument::buffer(std::uint64_t index) {
    const GltfJson& json = item("buffers", index);
    const std::uint64_t stated = neededNatural(json, "byteLength");
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
        const GltfJson* const extensions = member(json, "extensions");
        const GltfJson* const extension = extensions == nullptr ? nullptr : member(*extensions, name);
        if (extension != nullptr && flag(*extension, "fallback")) {
            throw GltfRefusal{std::string("it is compressed with ") + name + "; export it without"};
        }
    }
    std::string_view bytes;
    if (member(json, "uri") == nullptr) {
        if (index != 0 || !binaryChunk_) {
            throw GltfRefusal{"buffer " + std::to_string(index) + " has no data"};
        }
        bytes = *binaryChunk_;
    } else {
        const auto [entry, isNew] = loaded_.try_emplace(index);
        if (isNew) {
            entry->second = load(index, textOf(json, "uri"));
        }
        bytes = entry->second;
    }
    if (bytes.size() < stated) {
        throw GltfRefusal{"it is truncated: buffer " + std::to_string(index) + " has " + std::to_string(bytes.size()) +
                          " bytes, " + std::to_string(stated) + " are stated"};
    }
    return bytes.substr(0, stated);
}

std::string_view GltfDocument::view(std::uint64_t index) {
    const GltfJson& json = item("bufferViews", index);
    const std::string_view bytes = buffer(neededNatural(json, "buffer"));
    const std::uint64_t offset = natural(json, "byteOffset", 0);
    const std::uint64_t length = neededNatural(json, "byteLength");
    if (offset > bytes.size() || length > bytes.size() - offset) {
        throw GltfRefusal{"buffer view " + std::to_string(index) + " reaches beyond its buffer"};
    }
    return bytes.substr(offset, length);
}

} // namespace voxtact::io
