// SPDX-License-Identifier: MIT
#include "io/byte_source.h"
#include "io/errors.h"
#include "io/mesh/mesh_census.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>

namespace voxtact::io {

namespace {

using Json = nlohmann::json;

constexpr std::size_t kGlbHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

struct GlbChunks {
    std::string_view json;
    std::string_view binary;
};

Result<GlbChunks> splitGlb(const std::filesystem::path& path, std::string_view content) {
    const auto damaged = [&](const std::string& what) {
        return cannotRead(path, "it is truncated or damaged: " + what + "; get the file again");
    };
    if (content.size() < kGlbHeaderBytes + kChunkHeaderBytes || !content.starts_with("glTF")) {
        return cannotRead(path, "it is not a GLB file");
    }
    if (numberAt<std::uint32_t>(content, 4) != 2) {
        return cannotRead(path,
                          "it is glTF " + std::to_string(numberAt<std::uint32_t>(content, 4)) + "; glTF 2 is needed");
    }
    if (numberAt<std::uint32_t>(content, 8) != content.size()) {
        return damaged("its header states " + std::to_string(numberAt<std::uint32_t>(content, 8)) + " bytes, " +
                       std::to_string(content.size()) + " are there");
    }
    GlbChunks chunks;
    for (std::size_t at = kGlbHeaderBytes; at < content.size();) {
        if (content.size() - at < kChunkHeaderBytes ||
            content.size() - at - kChunkHeaderBytes < numberAt<std::uint32_t>(content, at)) {
            return damaged("a chunk is longer than the file");
        }
        const std::size_t length = numberAt<std::uint32_t>(content, at);
        const auto type = numberAt<std::uint32_t>(content, at + 4);
        const std::string_view chunk = content.substr(at + kChunkHeaderBytes, length);
        if (type == kJsonChunk && chunks.json.empty()) {
            chunks.json = chunk;
        } else if (type == kBinaryChunk && chunks.binary.empty()) {
            chunks.binary = chunk;
        }
        at += kChunkHeaderBytes + length;
    }
    return chunks;
}

/// Members that are missing or of the wrong type make this throw; the caller turns it into an Error.
struct Malformed {
    std::string reason;
};

std::uint64_t natural(const Json& object, const char* key, std::uint64_t otherwise) {
    const auto found = object.find(key);
    if (found == object.end()) {
        return otherwise;
    }
    if (!found->is_number_unsigned()) {
        throw Malformed{std::string("'") + key + "' is not a natural number"};
    }
    return found->get<std::uint64_t>();
}

std::string textOf(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

class GltfCensus {
  public:
    GltfCensus(const std::filesystem::path& path, const Json& root, std::string_view binary)
        : path_(path), root_(root), binary_(binary) {}

    std::uint64_t count() {
        if (!root_.is_object() || !root_.contains("asset")) {
            throw Malformed{"it is not a glTF file (no 'asset')"};
        }
        if (!textOf(root_["asset"], "version").starts_with("2")) {
            throw Malformed{"it is glTF " + textOf(root_["asset"], "version") + "; glTF 2 is needed"};
        }
        checkExtensions();
        checkBuffers();
        std::uint64_t triangles = 0;
        for (std::size_t mesh = 0; mesh < list("meshes").size(); ++mesh) {
            const Json& primitives = list("meshes")[mesh].value("primitives", Json::array());
            for (const Json& primitive : primitives) {
                triangles += trianglesOf(primitive);
            }
        }
        return triangles;
    }

  private:
    [[nodiscard]] const Json& list(const char* key) const {
        static const Json kNone = Json::array();
        const auto found = root_.find(key);
        return found != root_.end() && found->is_array() ? *found : kNone;
    }

    [[nodiscard]] const Json& item(const char* key, std::uint64_t index) const {
        if (index >= list(key).size() || !list(key)[index].is_object()) {
            throw Malformed{"it refers to number " + std::to_string(index) + " of its '" + key +
                            "', which does not exist"};
        }
        return list(key)[index];
    }

    /// Those that change what the vertices are, which assimp passes over or reads wrongly.
    void checkExtensions() const {
        for (const char* key : {"extensionsRequired", "extensionsUsed"}) {
            for (const Json& name : list(key)) {
                for (const char* geometry :
                     {"KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression",
                      "KHR_mesh_quantization", "EXT_mesh_gpu_instancing"}) {
                    if (name == geometry) {
                        throw Malformed{std::string("it uses the extension ") + geometry +
                                        ", which is not supported; export it without"};
                    }
                }
            }
        }
    }

    void checkBuffers() const {
        for (std::size_t i = 0; i < list("buffers").size(); ++i) {
            const std::uint64_t stated = natural(item("buffers", i), "byteLength", 0);
            const std::uint64_t present = bufferBytes(textOf(item("buffers", i), "uri"));
            if (present < stated) {
                throw Malformed{"it is truncated: buffer " + std::to_string(i) + " has " + std::to_string(present) +
                                " bytes, " + std::to_string(stated) + " are stated"};
            }
        }
    }

    [[nodiscard]] std::uint64_t bufferBytes(const std::string& uri) const {
        if (uri.empty()) {
            return binary_.size();
        }
        if (uri.starts_with("data:")) {
            const std::size_t comma = uri.find(";base64,");
            if (comma == std::string::npos) {
                throw Malformed{"a buffer's data is not base64"};
            }
            const std::string_view text = std::string_view(uri).substr(comma + 8);
            const std::size_t digits = std::min(text.find('='), text.size());
            return digits * 3 / 4;
        }
        const Result<std::uint64_t> size = readableFile(path_.parent_path() / decoded(uri));
        if (!size.ok()) {
            throw Malformed{size.error().text};
        }
        return *size;
    }

    /// %20 and the like.
    static std::string decoded(const std::string& uri) {
        std::string text;
        for (std::size_t i = 0; i < uri.size(); ++i) {
            const bool escape = uri[i] == '%' && i + 2 < uri.size();
            text += escape ? static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16)) : uri[i];
            i += escape ? 2 : 0;
        }
        return text;
    }

    /// The number of elements; refuses those that reach beyond their buffer, and other types than the ones named.
    std::uint64_t checkAccessor(std::uint64_t index, std::string_view type,
                                std::span<const std::uint64_t> components) const {
        const Json& accessor = item("accessors", index);
        const std::string name = "accessor " + std::to_string(index);
        const std::uint64_t component = natural(accessor, "componentType", 0);
        if (textOf(accessor, "type") != type ||
            std::find(components.begin(), components.end(), component) == components.end()) {
            throw Malformed{name + " is of a type that positions or indices cannot have"};
        }
        if (accessor.contains("sparse") || !accessor.contains("bufferView")) {
            throw Malformed{name + " is sparse, which is not supported; export it without"};
        }
        const std::uint64_t componentBytes = component == 5121 ? 1 : component == 5123 ? 2 : 4;
        const std::uint64_t bytes = componentBytes * (type == "VEC3" ? 3 : 1);
        const Json& view = item("bufferViews", natural(accessor, "bufferView", 0));
        const std::uint64_t stride = natural(view, "byteStride", bytes);
        const std::uint64_t count = natural(accessor, "count", 0);
        const std::uint64_t length = natural(view, "byteLength", 0);
        const std::uint64_t buffer = natural(item("buffers", natural(view, "buffer", 0)), "byteLength", 0);
        constexpr std::uint64_t kMost = std::uint64_t{1} << 40;
        const std::uint64_t offset = natural(accessor, "byteOffset", 0);
        const std::uint64_t viewOffset = natural(view, "byteOffset", 0);
        if (std::max({count, offset, viewOffset, length}) > kMost || stride < bytes || stride > 4096 || count == 0 ||
            offset + stride * (count - 1) + bytes > length || viewOffset + length > buffer) {
            throw Malformed{name + " reaches beyond its buffer"};
        }
        return count;
    }

    std::uint64_t trianglesOf(const Json& primitive) const {
        const std::uint64_t mode = natural(primitive, "mode", 4);
        const Json attributes = primitive.value("attributes", Json::object());
        if (mode > 6 || !attributes.contains("POSITION")) {
            throw Malformed{"a primitive has no positions, or an unknown mode"};
        }
        constexpr std::array<std::uint64_t, 1> kFloat{5126};
        constexpr std::array<std::uint64_t, 3> kIndices{5121, 5123, 5125};
        std::uint64_t corners = checkAccessor(natural(attributes, "POSITION", 0), "VEC3", kFloat);
        if (primitive.contains("indices")) {
            corners = checkAccessor(natural(primitive, "indices", 0), "SCALAR", kIndices);
        }
        if (mode < 4) {
            return 0;
        }
        if (mode == 4 && corners % 3 != 0) {
            throw Malformed{"a primitive has " + std::to_string(corners) + " corners, not three a triangle"};
        }
        return mode == 4 ? corners / 3 : corners < 3 ? 0 : corners - 2;
    }

    const std::filesystem::path& path_;
    const Json& root_;
    std::string_view binary_;
};

} // namespace

Result<std::uint64_t> statedByGltf(const std::filesystem::path& path, std::string_view content) {
    GlbChunks chunks{content, {}};
    if (lowerEnding(path) == ".glb") {
        Result<GlbChunks> split = splitGlb(path, content);
        if (!split.ok()) {
            return split.error();
        }
        chunks = *split;
    }
    try {
        const Json root = Json::parse(chunks.json);
        return GltfCensus(path, root, chunks.binary).count();
    } catch (const Malformed& malformed) {
        return cannotRead(path, malformed.reason);
    } catch (const Json::exception& problem) {
        return cannotRead(path, "it is not a proper glTF file: " + oneLine(problem.what()));
    }
}

} // namespace voxtact::io
