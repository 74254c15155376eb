// SPDX-License-Identifier: MIT
#include "cli/output/target_path.h"

#include "cli/output/outcome.h"
#include "cli/output/text_for_messages.h"

#include <map>
#include <string_view>

namespace voxtact::app {

namespace {

constexpr std::string_view kPlace = "{target}";

/// Keeps letters, digits and non-ASCII characters; the result cannot name another folder or a hidden file.
std::string fileName(const std::string& target) {
    constexpr std::string_view kKept = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
    std::string name = target;
    for (char& one : name) {
        const bool ascii = static_cast<unsigned char>(one) < 0x80;
        one = !ascii || kKept.find(one) != std::string_view::npos ? one : '_';
    }
    if (name.starts_with('.')) {
        name.front() = '_';
    }
    return name;
}

} // namespace

std::filesystem::path targetPath(const std::filesystem::path& path, const std::string& target) {
    const std::string name = fileName(target);
    std::string text = path.string();
    for (std::size_t at = text.find(kPlace); at != std::string::npos; at = text.find(kPlace, at + name.size())) {
        text.replace(at, kPlace.size(), name);
    }
    return text;
}

Result<void> checkTargetPaths(const std::string& option, const std::filesystem::path& path,
                              std::span<const std::string> targets) {
    if (targets.size() > 1 && path.string().find(kPlace) == std::string::npos) {
        return badArgument(option + ": there are " + std::to_string(targets.size()) +
                           " targets with one file each; put {target} into '" + path.string() + "'");
    }
    std::map<std::string, std::string> files;
    for (const std::string& target : targets) {
        const std::string file = targetPath(path, target).string();
        const auto [there, isNew] = files.emplace(file, target);
        if (!isNew) {
            return badArgument(option + ": the targets " + forMessage(there->second) + " and " + forMessage(target) +
                               " would both be written to '" + file + "'; rename one of them in a file of --targets");
        }
    }
    return {};
}

} // namespace voxtact::app
