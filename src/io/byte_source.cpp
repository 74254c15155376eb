// SPDX-License-Identifier: MIT
#include "io/byte_source.h"

#include "core/base/try.h"
#include "io/byte_reader.h"

namespace voxtact::io {

Result<std::string> contentHead(const std::filesystem::path& path, std::size_t length) {
    Result<ByteReader> reader = ByteReader::ofFile(path);
    VOXTACT_TRY(reader);
    VOXTACT_TRY(reader->unpack(ByteReader::Packing::GzipOrPlain));
    return reader->head(length);
}

} // namespace voxtact::io
