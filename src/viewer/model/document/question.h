// SPDX-License-Identifier: MIT
#pragma once

#include "viewer/model/files/missing_files.h"

#include <optional>
#include <string>
#include <vector>

namespace voxtact::view {

/// A dialog with a choice. Enter takes the first button, Escape the last.
struct Question {
    enum class Kind {
        Coarser, ///< the volume is too large: a coarser copy?
        Missing, ///< files of a session are gone: where are they?
        Lost     ///< the device was lost: who answers now?
    };
    Kind kind = Kind::Coarser;
    std::string title;
    std::string text;
    std::vector<MissingFile> files{}; ///< fields for their paths
    std::vector<std::string> buttons{};
    std::optional<std::size_t> chosen{}; ///< a button, once one was pressed
};

} // namespace voxtact::view
