// SPDX-License-Identifier: MIT
// From the path to checked data: files in a folder of their own. The first byte says which names they have; where a
// format may be two files, the second begins behind the first line that is `=`.
#include "volume_promises.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include <unistd.h>

namespace {

namespace fs = std::filesystem;

struct Names {
    const char* first;
    const char* second; ///< null: one file
};

constexpr std::array<Names, 9> kNames{{{"v.nii", nullptr},
                                       {"v.nii.gz", nullptr},
                                       {"v.nrrd", nullptr},
                                       {"v.mha", nullptr},
                                       {"v.hdr", "v.img"},
                                       {"v.hdr.gz", "v.img.gz"},
                                       {"v.nhdr", "v.raw"},
                                       {"v.mhd", "v.raw"},
                                       {"v.txt", nullptr}}};

/// One folder a process.
const fs::path& folder() {
    static const fs::path path = [] {
        std::string name = (fs::temp_directory_path() / "voxtact-fuzz-XXXXXX").string();
        voxtact::fuzz::require(::mkdtemp(name.data()) != nullptr, "there is room for a folder");
        return fs::path(name);
    }();
    static const struct Removal {
        const fs::path& path;
        ~Removal() {
            std::error_code ignored;
            fs::remove_all(path, ignored);
        }
    } removal{path};
    return path;
}

void write(const fs::path& path, std::string_view content) {
    std::ofstream(path, std::ios::binary | std::ios::trunc) << content;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) {
        return 0;
    }
    const Names& names = kNames[data[0] % kNames.size()];
    std::string_view first(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (names.second != nullptr) {
        constexpr std::string_view kBetween = "\n=\n";
        const std::size_t at = first.find(kBetween);
        write(folder() / names.second, at == std::string_view::npos ? "" : first.substr(at + kBetween.size()));
        first = first.substr(0, at == std::string_view::npos ? at : at + 1);
    }
    write(folder() / names.first, first);
    voxtact::fuzz::requireVolume(voxtact::io::readVolume(folder() / names.first));
    if (names.second != nullptr) {
        voxtact::fuzz::requireVolume(voxtact::io::readVolume(folder() / names.second));
        fs::remove(folder() / names.second);
    }
    fs::remove(folder() / names.first);
    return 0;
}
