// SPDX-License-Identifier: MIT
#pragma once

#include "io/mesh/mesh_file.h"

#include <nlohmann/json.hpp>

#include <map>
#include <optional>
#include <set>

namespace voxtact::io {

using GltfJson = nlohmann::json;

/// Why a glTF file cannot be used. Thrown inside the reader, where the JSON library throws too; readGltf() makes an
/// Error of it.
struct GltfRefusal {
    std::string reason;
};

/// The JSON of a glTF file, strictly: a member that is there has the type that it must have. And its buffers.
class GltfDocument {
  public:
    explicit GltfDocument(const MeshSource& source);

    /// A list at the root; empty where there is none.
    [[nodiscard]] const GltfJson& list(const char* key) const;
    /// An object of such a list.
    [[nodiscard]] const GltfJson& item(const char* key, std::uint64_t index) const;
    [[nodiscard]] const GltfJson& root() const noexcept { return root_; }

    /// True where the file says that it uses the extension.
    [[nodiscard]] bool uses(const std::string& extension) const { return extensions_.contains(extension); }

    /// Returns the stated number of bytes of a buffer; reads them on first use.
    [[nodiscard]] std::string_view buffer(std::uint64_t index);
    /// The bytes of a view.
    [[nodiscard]] std::string_view view(std::uint64_t index);

  private:
    void checkVersion() const;
    void takeExtensions();
    [[nodiscard]] std::string load(std::uint64_t index, const std::string& uri) const;

    const MeshSource& source_;
    GltfJson root_;
    std::optional<std::string_view> binaryChunk_;
    std::set<std::string> extensions_;
    std::map<std::uint64_t, std::string> loaded_;
};

/// The member, or null where there is none. `object` must be an object.
[[nodiscard]] const GltfJson* member(const GltfJson& object, const char* key);
[[nodiscard]] std::optional<std::uint64_t> natural(const GltfJson& object, const char* key);
[[nodiscard]] std::uint64_t natural(const GltfJson& object, const char* key, std::uint64_t otherwise);
/// Returns a required member.
[[nodiscard]] std::uint64_t neededNatural(const GltfJson& object, const char* key);
[[nodiscard]] std::string textOf(const GltfJson& object, const char* key);
[[nodiscard]] bool flag(const GltfJson& object, const char* key);
/// A list of natural numbers; empty where there is none.
[[nodiscard]] std::vector<std::uint64_t> naturals(const GltfJson& object, const char* key);
/// Reads this number of finite numbers.
[[nodiscard]] std::optional<std::vector<double>> numbers(const GltfJson& object, const char* key, std::size_t count);
/// A list of objects; empty where there is none.
[[nodiscard]] const GltfJson& objects(const GltfJson& object, const char* key);

} // namespace voxtact::io
