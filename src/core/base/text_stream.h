// SPDX-License-Identifier: MIT
#pragma once

#include <ios>
#include <sstream>

namespace voxtact {

/// Collects text piece by piece. Throws if memory runs out; std::ostringstream would drop the piece and continue.
class TextStream : public std::ostringstream {
  public:
    TextStream() { exceptions(std::ios::badbit); }
};

} // namespace voxtact
