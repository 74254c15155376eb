// SPDX-License-Identifier: MIT
// Runs one fuzz target over the files of a folder: `voxtact_fuzz_replay TARGET FOLDER`. What a fuzzer once found goes
// into the folder, and every build looks at it again. The arrangement needs no libFuzzer.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

#include "fuzz_targets.h"

namespace {

std::vector<std::filesystem::path> filesOf(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.is_regular_file()) {
            files.push_back(entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    return files;
}

int replay(const FuzzTarget& target, const std::filesystem::path& folder) {
    const std::vector<std::filesystem::path> files = filesOf(folder);
    if (files.empty()) {
        std::fprintf(stderr, "%s: no files\n", folder.c_str());
        return 1;
    }
    for (const std::filesystem::path& path : files) {
        // Named before it runs, so that a crash says which file it was.
        std::printf("%s\n", path.filename().c_str());
        std::fflush(stdout);
        std::ifstream file(path, std::ios::binary);
        const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
        const std::vector<std::uint8_t> data(bytes.begin(), bytes.end());
        (void)target.run(data.data(), data.size());
    }
    std::printf("%zu inputs\n", files.size());
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    if (argc == 3) {
        for (const FuzzTarget& target : kFuzzTargets) {
            if (std::string_view(target.name) == argv[1]) {
                return replay(target, argv[2]);
            }
        }
    }
    std::fputs("usage: voxtact_fuzz_replay TARGET FOLDER\n", stderr);
    return 2;
}
