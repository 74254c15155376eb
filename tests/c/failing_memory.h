// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace voxtact::test {

/// While it is there, an allocation of this process fails, on whichever thread it is made. One at a time.
class FailingMemory {
  public:
    /// The one with that number, counted from 0, and `forGood`, all that follow.
    FailingMemory(std::int64_t number, bool forGood);
    FailingMemory(const FailingMemory&) = delete;
    FailingMemory& operator=(const FailingMemory&) = delete;
    ~FailingMemory() { end(); }

    void end() const;
    /// How many did.
    [[nodiscard]] std::uint64_t failures() const;
};

} // namespace voxtact::test
