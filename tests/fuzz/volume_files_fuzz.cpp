// SPDX-License-Identifier: MIT
// From the path to checked data: files in a folder of their own. The first byte says which names they have; where a
// format may be two files, the second begins behind the first line that is `=`.
#include "file_folder.h"
#include "volume_promises.h"

#include <array>
#include <filesystem>
#include <string_view>

namespace {

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

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace fuzz = voxtact::fuzz;
    if (size == 0) {
        return 0;
    }
    const Names& names = kNames[data[0] % kNames.size()];
    std::string_view first(reinterpret_cast<const char*>(data) + 1, size - 1);
    if (names.second != nullptr) {
        constexpr std::string_view kBetween = "\n=\n";
        const std::size_t at = first.find(kBetween);
        fuzz::write(fuzz::folder() / names.second,
                    at == std::string_view::npos ? "" : first.substr(at + kBetween.size()));
        first = first.substr(0, at == std::string_view::npos ? at : at + 1);
    }
    fuzz::write(fuzz::folder() / names.first, first);
    fuzz::requireVolume(voxtact::io::readVolume(fuzz::folder() / names.first));
    if (names.second != nullptr) {
        fuzz::requireVolume(voxtact::io::readVolume(fuzz::folder() / names.second));
        std::filesystem::remove(fuzz::folder() / names.second);
    }
    std::filesystem::remove(fuzz::folder() / names.first);
    return 0;
}
