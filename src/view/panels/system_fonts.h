// SPDX-License-Identifier: MIT
#pragma once

#include "view/model/shown/letters.h"

#include <string>
#include <vector>

namespace voxtact::view {

/// A font of the system, and what is taken from it.
struct SystemFont {
    std::string file;
    int number = 0; ///< of a file with several
    Letters letters;
};

/// Those that have some of the letters, the nearest to a plain sans-serif first: each letter is of the first that has
/// it, and of none where no font has it. Takes long where the system has not looked at its fonts before.
[[nodiscard]] std::vector<SystemFont> systemFontsFor(Letters letters);

} // namespace voxtact::view
