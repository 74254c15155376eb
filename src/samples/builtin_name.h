// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace voxtact {

/// `stem` or `stem:number`.
struct BuiltinName {
    std::string stem;
    std::optional<std::uint32_t> number;
};

/// `kind` ("mesh") and `numberOf` ("triangles") are words for the error text.
[[nodiscard]] Result<BuiltinName> parseBuiltinName(std::string_view kind, std::string_view name,
                                                   std::string_view numberOf);

} // namespace voxtact
