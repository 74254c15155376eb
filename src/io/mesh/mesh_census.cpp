// SPDX-License-Identifier: MIT
#include "io/mesh/mesh_census.h"

#include "io/errors.h"

namespace voxtact::io {

bool TextLines::next(std::string_view& line) {
    if (rest_.empty()) {
        return false;
    }
    const std::size_t end = rest_.find('\n');
    line = rest_.substr(0, end);
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    if (line.ends_with('\r')) {
        line.remove_suffix(1);
    }
    ++number_;
    return true;
}

Result<void> checkEncoding(const std::filesystem::path& path, std::string_view content) {
    if (content.starts_with("\xFE\xFF") || content.starts_with("\xFF\xFE")) {
        return cannotRead(path, "its text is UTF-16; save it as UTF-8");
    }
    if (content.find('\0') != std::string_view::npos) {
        return cannotRead(path, "it is not text, or it is damaged (it holds a zero byte)");
    }
    return {};
}

Result<std::uint64_t> statedTriangles(const std::filesystem::path& path) {
    const Result<std::string> content = readWholeFile(path);
    if (!content.ok()) {
        return content.error();
    }
    if (content->empty()) {
        return cannotRead(path, "the file is empty");
    }
    const std::string ending = lowerEnding(path);
    if (ending == ".stl") {
        return statedByStl(path, *content);
    }
    if (ending == ".obj") {
        return statedByObj(path, *content);
    }
    if (ending == ".ply") {
        return statedByPly(path, *content);
    }
    if (ending == ".off") {
        return statedByOff(path, *content);
    }
    if (ending == ".gltf" || ending == ".glb") {
        return statedByGltf(path, *content);
    }
    return cannotRead(path, "its ending is none of .stl, .obj, .ply, .off, .gltf and .glb; convert it");
}

} // namespace voxtact::io
