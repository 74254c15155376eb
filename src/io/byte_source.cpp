// SPDX-License-Identifier: MIT
#include "io/byte_source.h"

#include "io/byte_reader.h"

namespace voxtact::io {

Result<std::string> contentHead(const std::filesystem::path& path, std::size_t length) {
    Result<ByteReader> reader = ByteReader::ofFile(path);
    if (!reader.ok()) {
        return reader.error();
    }
    if (Result<void> unpacked = reader->unpack(ByteReader::Packing::GzipOrPlain); !unpacked.ok()) {
        return unpacked.error();
    }
    return reader->head(length);
}

} // namespace voxtact::io
