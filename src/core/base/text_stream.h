// SPDX-License-Identifier: MIT
#pragma once

#include <ios>
#include <sstream>

namespace voxtact {

/// A text that is written piece by piece. Throws where there is no memory for a piece; a std::ostringstream leaves it
/// out and goes on.
class TextStream : public std::ostringstream {
  public:
    TextStream() { exceptions(std::ios::badbit); }
};

} // namespace voxtact
