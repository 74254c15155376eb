// SPDX-License-Identifier: MIT
#pragma once

#include "io/volume/volume_container.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace voxtact::io {

struct NrrdHeader {
    std::map<std::string, std::string, std::less<>> fields; ///< by the field's name in lower case, without blanks
    bool complete = false; ///< the empty line that ends a header with attached voxels was seen

    [[nodiscard]] std::string get(std::string_view key) const {
        const auto found = fields.find(key);
        return found == fields.end() ? std::string() : found->second;
    }
    /// 0 where there is no such field; none where it is no whole number.
    [[nodiscard]] std::optional<std::int64_t> integer(std::string_view key) const;
};

/// In lower case.
[[nodiscard]] std::string withoutBlanks(std::string_view key);

/// Leaves the reader behind the header. Refuses what is not NRRD, and a header without what every one has.
[[nodiscard]] Result<NrrdHeader> readNrrdHeader(ByteReader& reader);
[[nodiscard]] Result<std::vector<std::int64_t>> nrrdSizes(const std::filesystem::path& path, const NrrdHeader& header);

/// mm, LPS. `sizes`: three and more, those after the third are 1. What is assumed is noted.
[[nodiscard]] Result<Grid> nrrdGrid(const std::filesystem::path& path, const NrrdHeader& header,
                                    const std::vector<std::int64_t>& sizes, std::vector<std::string>& notes);

} // namespace voxtact::io
