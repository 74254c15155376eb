// SPDX-License-Identifier: MIT
#include "view/model/missing_files.h"

#include <algorithm>
#include <array>

namespace voxtact::view {

namespace {

namespace fs = std::filesystem;

struct Member {
    const char* name;
    std::string Sources::*path;
};
constexpr std::array<Member, 4> kMembers{{{"volume", &Sources::volume},
                                          {"mesh", &Sources::mesh},
                                          {"label map", &Sources::labels},
                                          {"label names", &Sources::labelNames}}};

bool isThere(const std::string& path) {
    std::error_code ignored;
    // Of a file with several images one is named behind a '#'.
    return fs::exists(path, ignored) || fs::exists(path.substr(0, path.rfind('#')), ignored);
}

} // namespace

std::vector<MissingFile> missingFiles(const Sources& sources, const fs::path& session) {
    std::vector<MissingFile> out;
    for (const Member& member : kMembers) {
        const std::string& path = sources.*member.path;
        if (path.empty() || path.starts_with("builtin:") || isThere(path)) {
            continue;
        }
        const std::string beside = (session.parent_path() / fs::path(path).filename()).string();
        out.push_back({member.name, !session.empty() && isThere(beside) ? beside : path});
    }
    return out;
}

Sources found(Sources sources, const std::vector<MissingFile>& files) {
    for (const MissingFile& file : files) {
        const auto* const member =
            std::ranges::find_if(kMembers, [&file](const Member& one) { return file.name == one.name; });
        if (member != kMembers.end()) {
            sources.*member->path = file.path;
        }
    }
    return sources;
}

} // namespace voxtact::view
