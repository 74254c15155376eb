// SPDX-License-Identifier: MIT
#include "viewer/model/files/source_paths.h"

#include "core/base/whole_path.h"

#include <algorithm>

namespace voxtact::view {

namespace {

namespace fs = std::filesystem;

/// Calls `change` with each that is a file's.
template <class Change> Sources changed(Sources sources, const Change& change) {
    for (const SourceMember& member : membersOf(sources)) {
        if (isFile(*member.path)) {
            *member.path = change(fs::path(*member.path)).string();
        }
    }
    return sources;
}

} // namespace

std::vector<SourceMember> membersOf(Sources& sources) {
    std::vector<SourceMember> out{{"volume", &sources.volume}};
    for (std::size_t i = 0; i < sources.meshes.size(); ++i) {
        out.push_back({sources.meshes.size() == 1 ? "mesh" : "mesh " + std::to_string(i + 1), &sources.meshes[i].path});
    }
    out.push_back({"label map", &sources.labels});
    out.push_back({"label names", &sources.labelNames});
    return out;
}

bool isFile(const std::string& path) {
    return !path.empty() && !path.starts_with("builtin:");
}

Sources seenFrom(Sources sources, const fs::path& folder) {
    const fs::path base = wholePath(folder.empty() ? fs::path(".") : folder);
    return changed(std::move(sources), [&](const fs::path& path) {
        const fs::path whole = wholePath(path);
        const fs::path relative = whole.lexically_relative(base);
        // A path with ".." may lead elsewhere, behind a link.
        return relative.empty() || std::ranges::find(relative, fs::path("..")) != relative.end() ? whole : relative;
    });
}

Sources foundFrom(Sources sources, const fs::path& folder) {
    return changed(std::move(sources), [&](const fs::path& path) { return path.is_absolute() ? path : folder / path; });
}

} // namespace voxtact::view
