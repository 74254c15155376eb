// SPDX-License-Identifier: MIT
#include "cli/options/cache_folder.h"

#include "cli/version.h"
#include "io/text/small_file.h"
#include "voxtact/io.h"

#include <array>
#include <cstdint>
#include <cstdlib>
#include <ostream>
#include <utility>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace voxtact::app {

namespace {

namespace fs = std::filesystem;

/// Far above the cache of our few pipelines: larger files are not ours.
constexpr std::uintmax_t kMaxBytes = 64U << 20U;

/// Returns an absolute path from an environment variable; the XDG specification ignores relative ones.
fs::path folderFrom(const char* variable) {
    const char* value = std::getenv(variable);
    const fs::path folder = value == nullptr ? "" : value;
    return folder.is_absolute() ? folder : fs::path();
}

fs::path standardFolder() {
    if (const fs::path cache = folderFrom("XDG_CACHE_HOME"); !cache.empty()) {
        return cache / "voxtact";
    }
    const fs::path home = folderFrom("HOME");
    return home.empty() ? fs::path() : home / ".cache" / "voxtact";
}

std::string hexadecimal(std::uint64_t value, int digits) {
    std::string text;
    for (int shift = 4 * (digits - 1); shift >= 0; shift -= 4) {
        text += "0123456789abcdef"[(value >> shift) & 15U];
    }
    return text;
}

/// Returns the first line of a file: length and checksum, since a damaged pipeline cache may crash a driver.
std::string headOf(std::string_view content) {
    return "voxtact cache " + hexadecimal(content.size(), 16) + " " +
           hexadecimal(XXH3_64bits(content.data(), content.size()), 16) + "\n";
}

} // namespace

CacheFolder::CacheFolder(const std::string& wanted) {
    if (wanted != "off") {
        path_ = wanted.empty() ? standardFolder() : fs::path(wanted);
    }
}

std::optional<std::string> CacheFolder::read(const std::string& name) const {
    if (!on()) {
        return std::nullopt;
    }
    const Result<std::string> file = io::readSmallFile(path_ / name, kMaxBytes);
    if (!file.ok()) {
        return std::nullopt;
    }
    const std::size_t head = file->find('\n') + 1; // 0 if there is none
    std::string content = file->substr(head);
    return file->substr(0, head) == headOf(content) ? std::optional(std::move(content)) : std::nullopt;
}

bool CacheFolder::write(const std::string& name, std::string_view content) const {
    if (!on()) {
        return false;
    }
    std::error_code error;
    fs::create_directories(path_, error);
    if (fs::exists(path_ / name, error) && !fs::is_regular_file(path_ / name, error)) {
        return false; // a pipe would block without a reader
    }
    const Result<void> written = io::writeFile(path_ / name, [&](std::ostream& out) -> Result<void> {
        out << headOf(content) << content;
        return {};
    });
    return written.ok();
}

std::string cacheKey(const device::PhysicalDevice& device) {
    std::string key;
    for (const std::uint8_t byte : device.pipelineCacheUuid) {
        key += hexadecimal(byte, 2);
    }
    return key + "-" + hexadecimal(device.driverVersion, 8) + "-" + programVersion();
}

} // namespace voxtact::app
