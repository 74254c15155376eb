// SPDX-License-Identifier: MIT
#include "io/byte_source.h"

#include "io/errors.h"

#include <fstream>
#include <memory>
#include <vector>

#include <zlib.h>

namespace voxtact::io {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 18;
constexpr const char* kDamaged = "its compressed data is cut off or damaged; get the file again";

struct GzipClose {
    void operator()(gzFile_s* file) const noexcept { gzclose_r(file); }
};
using GzipFile = std::unique_ptr<gzFile_s, GzipClose>;

GzipFile openGzip(const std::filesystem::path& path) {
    GzipFile file(gzopen(path.c_str(), "rb"));
    if (file) {
        gzbuffer(file.get(), kChunk);
    }
    return file;
}

/// gzread() returns what it has at a premature end, and tells only gzerror().
bool isDamaged(gzFile_s* file) {
    int code = Z_OK;
    gzerror(file, &code);
    return code != Z_OK && code != Z_STREAM_END;
}

} // namespace

Result<std::uint64_t> contentLength(const std::filesystem::path& path, const ByteVisitor& visit) {
    const GzipFile file = openGzip(path);
    if (!file) {
        return cannotRead(path, "it cannot be opened", ErrorCode::File);
    }
    std::vector<char> chunk(kChunk);
    std::uint64_t length = 0;
    int got = 0;
    while ((got = gzread(file.get(), chunk.data(), kChunk)) > 0) {
        length += static_cast<std::uint64_t>(got);
        if (visit) {
            visit(std::string_view(chunk.data(), static_cast<std::size_t>(got)));
        }
    }
    if (got < 0 || isDamaged(file.get())) {
        return cannotRead(path, kDamaged);
    }
    return length;
}

Result<std::string> contentHead(const std::filesystem::path& path, std::size_t length) {
    if (const Result<std::uint64_t> size = readableFile(path); !size.ok()) {
        return size.error();
    }
    const GzipFile file = openGzip(path);
    std::string head(length, '\0');
    const int got = file ? gzread(file.get(), head.data(), static_cast<unsigned>(length)) : -1;
    if (got < 0) {
        return cannotRead(path, kDamaged);
    }
    head.resize(static_cast<std::size_t>(got));
    return head;
}

Result<std::uint64_t> inflatedLength(const std::filesystem::path& path, std::uint64_t offset, Compression compression) {
    std::ifstream file(path, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(offset));
    z_stream stream{};
    constexpr int kGzipOnly = 16;
    constexpr int kEither = 32;
    if (inflateInit2(&stream, MAX_WBITS + (compression == Compression::Gzip ? kGzipOnly : kEither)) != Z_OK) {
        return Error{ErrorCode::OutOfMemory, 0, "out of host memory"};
    }
    const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
    std::vector<char> in(kChunk);
    std::vector<Bytef> out(kChunk);
    std::uint64_t length = 0;
    int state = Z_OK;
    while (state == Z_OK) {
        if (stream.avail_in == 0) {
            file.read(in.data(), static_cast<std::streamsize>(in.size()));
            stream.next_in = reinterpret_cast<Bytef*>(in.data());
            stream.avail_in = static_cast<uInt>(file.gcount());
        }
        stream.next_out = out.data();
        stream.avail_out = static_cast<uInt>(out.size());
        state = inflate(&stream, Z_NO_FLUSH);
        length += out.size() - stream.avail_out;
    }
    if (state != Z_STREAM_END) {
        return cannotRead(path, kDamaged);
    }
    return length;
}

} // namespace voxtact::io
