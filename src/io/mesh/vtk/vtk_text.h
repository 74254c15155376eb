// SPDX-License-Identifier: MIT
#pragma once

#include "io/volume/stored_image.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace voxtact::io {

/// Words, lines and bytes of a legacy VTK file, each taken once from the front.
class VtkText {
  public:
    explicit VtkText(std::string_view content) : content_(content) {}

    /// The next word, across lines; empty at the end.
    [[nodiscard]] std::string_view word();
    /// The rest of the line, without its end; none at the end of the file.
    [[nodiscard]] std::optional<std::string_view> line();
    /// The next bytes; none if fewer are left.
    [[nodiscard]] std::optional<std::string_view> bytes(std::uint64_t count);

    [[nodiscard]] std::string_view rest() const noexcept { return content_.substr(at_); }
    /// The line of the last word or line, from 1.
    [[nodiscard]] std::uint64_t lineNumber() const;

  private:
    std::string_view content_;
    std::size_t at_ = 0;
    std::size_t last_ = 0; ///< begin of the last word or line
};

/// The type of an array in a legacy file; none if it is no number, or of a size that depends on the machine.
[[nodiscard]] std::optional<StoredType> vtkType(std::string_view name);

/// Skips one array of a FIELD section, or over a METADATA section; false if the file is truncated or damaged. `value`
/// becomes the first text of an array of texts.
[[nodiscard]] bool skipVtkFieldArray(VtkText& text, bool isBinary, std::string_view& name, std::string_view& value);
[[nodiscard]] bool skipVtkMetadata(VtkText& text);

} // namespace voxtact::io
