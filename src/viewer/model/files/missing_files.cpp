// SPDX-License-Identifier: MIT
#include "viewer/model/files/missing_files.h"

#include "viewer/model/files/source_paths.h"

#include <algorithm>

namespace voxtact::view {

namespace {

namespace fs = std::filesystem;

bool isThere(const std::string& path) {
    std::error_code ignored;
    // The part after '#' names one of several images in a file.
    return fs::exists(path, ignored) || fs::exists(path.substr(0, path.rfind('#')), ignored);
}

} // namespace

std::vector<MissingFile> missingFiles(Sources sources, const fs::path& session) {
    std::vector<MissingFile> out;
    for (const SourceMember& member : membersOf(sources)) {
        const std::string& path = *member.path;
        if (!isFile(path) || isThere(path)) {
            continue;
        }
        const std::string beside = (session.parent_path() / fs::path(path).filename()).string();
        out.push_back({member.name, !session.empty() && isThere(beside) ? beside : path});
    }
    return out;
}

Sources found(Sources sources, const std::vector<MissingFile>& files) {
    const std::vector<SourceMember> members = membersOf(sources);
    for (const MissingFile& file : files) {
        const auto member = std::ranges::find(members, file.name, &SourceMember::name);
        if (member != members.end()) {
            *member->path = file.path;
        }
    }
    return sources;
}

} // namespace voxtact::view
