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

namespace {

/// Where the fields are, and how wide.
struct NiftiLayout {
    std::size_t bytes, magic, sizes, type, bits, pixdim, offset, slope, units, codes, quaternion, srow;
};
constexpr NiftiLayout kFirst{348, 344, 40, 70, 72, 76, 108, 112, 123, 252, 256, 280};
constexpr NiftiLayout kSecond{540, 4, 16, 12, 14, 104, 168, 176, 500, 344, 352, 400};

class HeaderWriter {
  public:
    HeaderWriter(const NiftiFile& file, const NiftiLayout& layout)
        : file_(file), layout_(layout), header_(layout.bytes, '\0') {}

    template <class Number> void put(std::size_t offset, Number value) {
        std::string raw;
        append(raw, value);
        header_.replace(offset, raw.size(), file_.swapped ? std::string(raw.rbegin(), raw.rend()) : raw);
    }
    void size(std::size_t i, std::int64_t value) {
        file_.second ? put(layout_.sizes + 8 * i, value) : put(layout_.sizes + 2 * i, static_cast<std::int16_t>(value));
    }
    void code(std::size_t i, int value) {
        file_.second ? put(layout_.codes + 4 * i, std::int32_t{value})
                     : put(layout_.codes + 2 * i, static_cast<std::int16_t>(value));
    }
    void real(std::size_t begin, std::size_t i, double value) {
        file_.second ? put(begin + 8 * i, value) : put(begin + 4 * i, static_cast<float>(value));
    }
    std::string header() && { return std::move(header_); }
    void magic(const std::string& text) { header_.replace(layout_.magic, text.size(), text); }

  private:
    const NiftiFile& file_;
    const NiftiLayout& layout_;
    std::string header_;
};

} // namespace

std::string NiftiFile::bytes() const {
    const NiftiLayout& layout = second ? kSecond : kFirst;
    HeaderWriter writer(*this, layout);
    writer.put(0, static_cast<std::int32_t>(layout.bytes));
    writer.magic(std::string(pair ? "ni" : "n+") + (second ? "2" : "1") +
                 (second ? std::string("\0\r\n\032\n", 5) : ""));
    for (std::size_t i = 0; i < 8; ++i) {
        writer.size(i, i == 0 ? static_cast<std::int64_t>(sizes.size()) : i <= sizes.size() ? sizes[i - 1] : 1);
    }
    writer.put(layout.type, type);
    writer.put(layout.bits, bits);
    writer.real(layout.pixdim, 0, qfac);
    for (std::size_t i = 0; i < 3; ++i) {
        writer.real(layout.pixdim, i + 1, spacing[i]);
        writer.real(layout.quaternion, i, quaternion[i]);
        writer.real(layout.quaternion, i + 3, qoffset[i]);
    }
    const std::size_t offset = pair ? 0 : layout.bytes + extension.size();
    second ? writer.put(layout.offset, static_cast<std::int64_t>(offset))
           : writer.put(layout.offset, static_cast<float>(offset));
    writer.real(layout.slope, 0, slope);
    writer.real(layout.slope, 1, intercept);
    second ? writer.put(layout.units, std::int32_t{units}) : writer.put(layout.units, static_cast<std::int8_t>(units));
    writer.code(0, qformCode);
    writer.code(1, sformCode);
    for (std::size_t i = 0; i < 12; ++i) {
        writer.real(layout.srow, i, sform[i]);
    }
    return std::move(writer).header() + (pair ? "" : extension + voxels);
}

} // namespace voxtact::test
