// SPDX-License-Identifier: MIT
#include "io_test_support.h"

#include <cstdlib>
#include <fstream>
#include <iterator>

#include <unistd.h>
#include <zlib.h>

namespace voxtact::test {

namespace fs = std::filesystem;

TemporaryFolder::TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "voxtact-io-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
        std::abort();
    }
    path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

fs::path TemporaryFolder::write(const std::string& name, std::string_view content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
}

std::size_t TemporaryFolder::entries() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path_), fs::directory_iterator()));
}

std::string contentOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

fs::path sharedData() {
    const char* named = std::getenv("VOXTACT_TEST_DATA");
    const fs::path folder = named != nullptr ? named : VOXTACT_TEST_DATA_DEFAULT;
    return fs::exists(folder / "MANIFEST.md") ? folder : fs::path();
}

std::string compressed(std::string_view content, Wrapping wrapping) {
    z_stream stream{};
    deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS + (wrapping == Wrapping::Gzip ? 16 : 0), 8,
                 Z_DEFAULT_STRATEGY);
    std::string in(content);
    std::string out(deflateBound(&stream, in.size()) + 64, '\0');
    stream.next_in = reinterpret_cast<Bytef*>(in.data());
    stream.avail_in = static_cast<uInt>(in.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

std::string NiftiFile::bytes() const {
    std::string header(352, '\0');
    const auto put = [&](std::size_t offset, auto value) { std::memcpy(header.data() + offset, &value, sizeof value); };
    put(0, std::int32_t{348});
    put(40, static_cast<std::int16_t>(sizes.size()));
    for (std::size_t i = 0; i < 7; ++i) {
        put(42 + 2 * i, i < sizes.size() ? sizes[i] : std::int16_t{1});
    }
    put(70, type);
    put(72, bits);
    put(76, 1.0F);
    for (std::size_t i = 0; i < 3; ++i) {
        put(80 + 4 * i, spacing[i]);
    }
    put(108, 352.0F);
    put(112, slope);
    put(254, static_cast<std::int16_t>(hasSform ? 1 : 0));
    for (std::size_t i = 0; i < 12; ++i) {
        put(280 + 4 * i, sform[i]);
    }
    std::memcpy(header.data() + 344, "n+1", 4);
    return header + voxels;
}

} // namespace voxtact::test
