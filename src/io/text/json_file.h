// SPDX-License-Identifier: MIT
#pragma once

#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "io/text/twice_said.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace voxtact::io {

/// Parses a JSON file. Refuses objects that name a member twice.
[[nodiscard]] inline Result<nlohmann::json> readJsonFile(const std::filesystem::path& path) {
    using Json = nlohmann::json;
    const Result<std::string> text = readWholeFile(path);
    VOXTACT_TRY(text);
    try {
        TwiceSaid<Json> twice;
        Json root = Json::parse(
            *text, [&twice](int, Json::parse_event_t event, const Json& parsed) { return twice(event, parsed); });
        return twice.found() ? Result<Json>(cannotRead(path, "it says " + inQuotes(*twice.found()) + " twice"))
                             : Result<Json>(std::move(root));
    } catch (const Json::exception& problem) {
        return cannotRead(path, jsonReason(problem.what()));
    }
}

} // namespace voxtact::io
