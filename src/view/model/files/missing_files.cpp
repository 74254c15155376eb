// SPDX-License-Identifier: MIT
#include "view/model/files/missing_files.h"

#include <algorithm>

namespace voxtact::view {

namespace {

namespace fs = std::filesystem;

struct Member {
    std::string name;
    std::string* path;
};

std::vector<Member> membersOf(Sources& sources) {
    std::vector<Member> out{{"volume", &sources.volume}};
    for (std::size_t i = 0; i < sources.meshes.size(); ++i) {
        out.push_back({sources.meshes.size() == 1 ? "mesh" : "mesh " + std::to_string(i + 1), &sources.meshes[i].path});
    }
    out.push_back({"label map", &sources.labels});
    out.push_back({"label names", &sources.labelNames});
    return out;
}

bool isThere(const std::string& path) {
    std::error_code ignored;
    // Of a file with several images one is named behind a '#'.
    return fs::exists(path, ignored) || fs::exists(path.substr(0, path.rfind('#')), ignored);
}

} // namespace

std::vector<MissingFile> missingFiles(Sources sources, const fs::path& session) {
    std::vector<MissingFile> out;
    for (const Member& member : membersOf(sources)) {
        const std::string& path = *member.path;
        if (path.empty() || path.starts_with("builtin:") || isThere(path)) {
            continue;
        }
        const std::string beside = (session.parent_path() / fs::path(path).filename()).string();
        out.push_back({member.name, !session.empty() && isThere(beside) ? beside : path});
    }
    return out;
}

Sources found(Sources sources, const std::vector<MissingFile>& files) {
    const std::vector<Member> members = membersOf(sources);
    for (const MissingFile& file : files) {
        const auto member = std::ranges::find(members, file.name, &Member::name);
        if (member != members.end()) {
            *member->path = file.path;
        }
    }
    return sources;
}

} // namespace voxtact::view
