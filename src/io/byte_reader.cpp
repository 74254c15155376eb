// SPDX-License-Identifier: MIT
#include "io/byte_reader.h"

#include "core/base/guard.h"
#include "core/base/try.h"
#include "io/errors.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include <zlib.h>

namespace voxtact::io {

namespace {

constexpr std::size_t kChunk = std::size_t{1} << 18;
constexpr std::size_t kTold = std::size_t{1} << 23; // bytes, at most, from one ReadProgress to the next
constexpr const char* kDamaged = "its compressed data is cut off or damaged; get the file again";

Error wasCancelled(const std::filesystem::path& path) {
    return {ErrorCode::Cancelled, 0, "reading '" + path.string() + "' was cancelled"};
}

bool beginsAsGzip(std::span<const std::byte> bytes) {
    return bytes.size() >= 2 && bytes[0] == std::byte{0x1F} && bytes[1] == std::byte{0x8B};
}

} // namespace

/// The bytes as they are stored: all in memory, or a part of a file and the rest behind it.
struct ByteReader::Stored {
    std::ifstream file;
    std::vector<std::byte> chunk;
    std::span<const std::byte> ready; ///< in `chunk`, or in the caller's memory
    std::uint64_t all = 0;            ///< bytes of the file
    std::uint64_t behind = 0;         ///< bytes of the file that come after `ready`
    ReadProgress progress;            ///< empty: nobody hears of it
    bool cancelled = false;           ///< by that
    bool failed = false;              ///< the file could not be read although it says it has more

    [[nodiscard]] std::uint64_t left() const noexcept { return ready.size() + behind; }

    std::size_t fromFile(std::byte* to, std::size_t length) {
        const std::size_t wanted = static_cast<std::size_t>(std::min<std::uint64_t>(length, behind));
        std::size_t got = 0;
        while (got < wanted && !failed && !cancelled) {
            const std::size_t part = std::min(wanted - got, kTold);
            file.read(reinterpret_cast<char*>(to) + got, static_cast<std::streamsize>(part));
            const auto read = static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0));
            failed = read < part;
            got += read;
            behind -= read;
            cancelled = progress && !progress(all - behind, all);
        }
        behind = failed || cancelled ? 0 : behind;
        return got;
    }

    /// Makes at least `least` bytes ready, fewer only at the end; `least` <= kChunk.
    void fill(std::size_t least) {
        if (ready.size() >= least || behind == 0) {
            return;
        }
        std::vector<std::byte> next(kChunk);
        std::copy(ready.begin(), ready.end(), next.begin());
        const std::size_t kept = ready.size();
        const std::size_t got = fromFile(next.data() + kept, next.size() - kept);
        chunk = std::move(next);
        ready = std::span<const std::byte>(chunk).first(kept + got);
    }

    std::size_t read(std::byte* to, std::size_t length) {
        const std::size_t kept = std::min(length, ready.size());
        std::copy_n(ready.begin(), kept, to);
        ready = ready.subspan(kept);
        return kept + (kept < length ? fromFile(to + kept, length - kept) : 0);
    }

    std::uint64_t skip(std::uint64_t length) {
        const auto kept = static_cast<std::size_t>(std::min<std::uint64_t>(length, ready.size()));
        ready = ready.subspan(kept);
        const std::uint64_t over = std::min(length - kept, behind);
        if (over > 0) {
            file.seekg(static_cast<std::streamoff>(over), std::ios::cur);
            behind -= over;
        }
        return kept + over;
    }
};

struct ByteReader::Inflater {
    z_stream stream{};
    Packing packing = Packing::Gzip;
    bool ended = false;

    Inflater() = default;
    Inflater(const Inflater&) = delete;
    Inflater& operator=(const Inflater&) = delete;
    ~Inflater() { inflateEnd(&stream); }
};

ByteReader::ByteReader(std::filesystem::path path, std::unique_ptr<Stored> stored)
    : path_(std::move(path)), stored_(std::move(stored)) {}
ByteReader::ByteReader(ByteReader&&) noexcept = default;
ByteReader& ByteReader::operator=(ByteReader&&) noexcept = default;
ByteReader::~ByteReader() = default;

Result<ByteReader> ByteReader::ofFile(const std::filesystem::path& path, ReadProgress progress) {
    const Result<std::uint64_t> size = readableFile(path);
    VOXTACT_TRY(size);
    auto stored = std::make_unique<Stored>();
    errno = 0;
    stored->file.open(path, std::ios::binary);
    if (!stored->file) {
        return cannotOpen(path, errno);
    }
    stored->all = stored->behind = *size;
    stored->progress = std::move(progress);
    return ByteReader(path, std::move(stored));
}

ByteReader ByteReader::ofMemory(std::filesystem::path name, std::span<const std::byte> bytes) {
    auto stored = std::make_unique<Stored>();
    stored->ready = bytes;
    return {std::move(name), std::move(stored)};
}

Result<void> ByteReader::unpack(Packing packing) {
    stored_->fill(2);
    if (packing == Packing::GzipOrPlain && !beginsAsGzip(stored_->ready)) {
        return {};
    }
    inflater_ = std::make_unique<Inflater>();
    inflater_->packing = packing;
    constexpr int kGzipOnly = 16;
    constexpr int kEither = 32;
    if (inflateInit2(&inflater_->stream, MAX_WBITS + (packing == Packing::ZlibOrGzip ? kEither : kGzipOnly)) != Z_OK) {
        return Error{ErrorCode::OutOfMemory, 0, "out of host memory"};
    }
    return {};
}

std::uint64_t ByteReader::stored() const noexcept {
    return stored_->left();
}

Result<std::size_t> ByteReader::inflate(std::byte* to, std::size_t length) {
    Inflater& inflater = *inflater_;
    z_stream& stream = inflater.stream;
    std::size_t done = 0;
    while (done < length && !inflater.ended) {
        stored_->fill(1);
        // zlib counts in unsigned; a chunk at a time is enough.
        const std::size_t in = std::min(stored_->ready.size(), kChunk);
        const std::size_t out = std::min(length - done, std::size_t{1} << 30);
        // zlib does not write to its input; its pointer is not const by default.
        stream.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(stored_->ready.data()));
        stream.avail_in = static_cast<uInt>(in);
        stream.next_out = reinterpret_cast<Bytef*>(to + done);
        stream.avail_out = static_cast<uInt>(out);
        const int state = ::inflate(&stream, Z_NO_FLUSH);
        const std::size_t taken = in - stream.avail_in;
        const std::size_t given = out - stream.avail_out;
        stored_->ready = stored_->ready.subspan(taken);
        done += given;
        if (state == Z_STREAM_END) {
            // gzip files may be joined end to end; anything else behind the end is nobody's.
            stored_->fill(2);
            inflater.ended = inflater.packing == Packing::ZlibOrGzip || !beginsAsGzip(stored_->ready) ||
                             inflateReset(&stream) != Z_OK;
        } else if (state == Z_MEM_ERROR) {
            return noHostMemory();
        } else if (state != Z_OK || (taken == 0 && given == 0)) {
            return cannotRead(path_, kDamaged);
        }
    }
    return done;
}

Result<std::size_t> ByteReader::read(std::byte* to, std::size_t length) {
    Result<std::size_t> got = inflater_ ? inflate(to, length) : stored_->read(to, length);
    if (stored_->cancelled) {
        return wasCancelled(path_);
    }
    if (stored_->failed) {
        return readingStopped(path_);
    }
    return got;
}

Result<std::string> ByteReader::head(std::size_t length) {
    std::string text(length, '\0');
    const Result<std::size_t> got = read(reinterpret_cast<std::byte*>(text.data()), length);
    VOXTACT_TRY(got);
    text.resize(*got);
    return text;
}

Result<std::uint64_t> ByteReader::skip(std::uint64_t length) {
    if (!inflater_) {
        return stored_->skip(length);
    }
    std::vector<std::byte> ignored(kChunk);
    std::uint64_t done = 0;
    while (done < length) {
        const auto wanted = static_cast<std::size_t>(std::min<std::uint64_t>(length - done, kChunk));
        const Result<std::size_t> got = read(ignored.data(), wanted);
        VOXTACT_TRY(got);
        done += *got;
        if (*got < wanted) {
            break;
        }
    }
    return done;
}

Result<std::optional<std::string>> ByteReader::line(std::size_t longest) {
    std::string text;
    lineEnded_ = false;
    if (stored_->left() == 0) {
        return std::optional<std::string>();
    }
    while (!lineEnded_ && text.size() < longest) {
        stored_->fill(1);
        const std::span<const std::byte> ready =
            stored_->ready.first(std::min(stored_->ready.size(), longest - text.size()));
        if (ready.empty()) {
            break;
        }
        const auto feed = std::find(ready.begin(), ready.end(), std::byte{'\n'});
        const auto length = static_cast<std::size_t>(feed - ready.begin());
        lineEnded_ = length < ready.size();
        text.append(reinterpret_cast<const char*>(ready.data()), length);
        stored_->ready = stored_->ready.subspan(length + (lineEnded_ ? 1 : 0));
    }
    if (stored_->failed) {
        return readingStopped(path_);
    }
    return std::optional(std::move(text));
}

Result<std::vector<std::byte>> ByteReader::take(std::uint64_t needed) {
    const auto truncated = [&](std::uint64_t present) {
        return cannotRead(path_, "it is truncated: its voxels take " + std::to_string(needed) + " bytes, " +
                                     std::to_string(present) + " are there; get the file again");
    };
    if (stored_->cancelled) { // while the header was read
        return wasCancelled(path_);
    }
    if (!inflater_ && needed > stored_->left()) {
        return truncated(stored_->left());
    }
    // Reserves the usual size of unpacked data at once, the rest as it comes.
    constexpr std::uint64_t kCommonInAByte = 16;
    std::vector<std::byte> bytes;
    bytes.reserve(std::min(needed, inflater_ ? stored_->left() * kCommonInAByte : needed));
    constexpr std::uint64_t kStep = std::uint64_t{1} << 24;
    while (bytes.size() < needed) {
        const std::size_t begin = bytes.size();
        const auto step = static_cast<std::size_t>(std::min(needed - begin, kStep));
        bytes.resize(begin + step);
        const Result<std::size_t> got = read(bytes.data() + begin, step);
        VOXTACT_TRY(got);
        if (*got < step) {
            return truncated(begin + *got);
        }
    }
    return bytes;
}

Result<std::uint64_t> ByteReader::finish() {
    return skip(~std::uint64_t{0});
}

} // namespace voxtact::io
