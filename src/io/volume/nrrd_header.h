// SPDX-License-Identifier: MIT
#pragma once

#include "io/volume/volume_container.h"

#include <array>
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
    std::map<std::string, std::string, std::less<>> keys;   ///< "key:=value", escapes replaced
    std::vector<std::string> listed;                        ///< the files that follow "data file: LIST"
    bool complete = false; ///< the empty line that ends a header with attached voxels was seen

    [[nodiscard]] std::string get(std::string_view key) const {
        const auto found = fields.find(key);
        return found == fields.end() ? std::string() : found->second;
    }
    /// 0 where there is no such field; none where it is no whole number.
    [[nodiscard]] std::optional<std::int64_t> integer(std::string_view key) const;
};

/// The image of a file behind its header. `times`: number of values per voxel in the file, as if the image were
/// as many times as long along `axis` (of the axes in space); the grid that is returned is that of one.
[[nodiscard]] Result<ContainedImage> readNrrdImage(const VolumeSource& source, ByteReader reader,
                                                   const NrrdHeader& header, std::size_t axis = 0,
                                                   std::uint32_t times = 1);

/// In lower case.
[[nodiscard]] std::string withoutBlanks(std::string_view key);

/// Leaves the reader after the header. Refuses other files, and a header without required fields.
[[nodiscard]] Result<NrrdHeader> readNrrdHeader(ByteReader& reader);

/// The axes of a file: first those in space. An axis of size 1 that is none in space ("stub", "list") may come first in
/// the file.
struct NrrdAxes {
    std::vector<std::int64_t> sizes;
    std::array<std::size_t, 3> places{}; ///< of the axes in space, among all in the file
};
[[nodiscard]] Result<NrrdAxes> nrrdAxes(const std::filesystem::path& path, const NrrdHeader& header);

/// The vectors "(1,0,0)" of a field; none for "none" and for one of NaN, which stand for an axis that is not in space.
/// None at all where the text is no list of vectors.
[[nodiscard]] std::optional<std::vector<std::optional<Vec3>>> nrrdVectors(std::string_view text);

/// mm, LPS. `axes`: three and more, the sizes of those after the third are 1. Notes assumptions.
[[nodiscard]] Result<Grid> nrrdGrid(const std::filesystem::path& path, const NrrdHeader& header, const NrrdAxes& axes,
                                    std::vector<std::string>& notes);

} // namespace voxtact::io
