// SPDX-License-Identifier: MIT
#include "viewer/model/files/state_folder.h"

#include "io/text/small_file.h"
#include "voxtact/io.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>

namespace voxtact::view {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostStateBytes = std::uintmax_t{1} << 20U;

/// An absolute path, as the XDG base directory specification asks for; empty otherwise.
fs::path folderOf(const char* variable) {
    const char* const text = std::getenv(variable);
    const fs::path path = text == nullptr ? "" : text;
    return path.is_absolute() ? path : fs::path();
}

} // namespace

fs::path stateFolder() {
    if (const fs::path state = folderOf("XDG_STATE_HOME"); !state.empty()) {
        return state / "voxtact";
    }
    const fs::path home = folderOf("HOME");
    return home.empty() ? fs::path() : home / ".local" / "state" / "voxtact";
}

RecentFiles::RecentFiles(fs::path file) : file_(std::move(file)) {
    const Result<std::string> text = io::readSmallFile(file_, kMostStateBytes);
    if (!text.ok()) {
        return;
    }
    const nlohmann::json json = nlohmann::json::parse(*text, nullptr, false);
    if (!json.is_array()) {
        return;
    }
    for (const nlohmann::json& path : json) {
        if (path.is_string() && !path.get_ref<const std::string&>().empty() && paths_.size() < kMost) {
            paths_.push_back(path.get<std::string>());
        }
    }
}

void RecentFiles::add(const std::string& path) {
    if (path.empty() || path.starts_with("builtin:")) {
        return;
    }
    std::error_code failed;
    const fs::path absolute = fs::absolute(path, failed);
    const std::string text = failed ? path : absolute.lexically_normal().string();
    std::erase(paths_, text);
    paths_.insert(paths_.begin(), text);
    paths_.resize(std::min(paths_.size(), kMost));
    if (file_.empty()) {
        return;
    }
    fs::create_directories(file_.parent_path(), failed);
    static_cast<void>(io::writeFile(file_, [this](std::ostream& out) -> Result<void> {
        out << nlohmann::json(paths_).dump(1, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
        return {};
    }));
}

} // namespace voxtact::view
