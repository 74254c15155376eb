// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>

namespace voxtact::test {

/// While it is there, a read of this process from a file in a folder fails (EIO), as on a disk that is damaged or on
/// the other side of a network. One at a time.
class FailingReads {
  public:
    /// The one with that number, counted from 0, and `forGood`, all that follow.
    FailingReads(std::filesystem::path folder, std::int64_t number, bool forGood);
    FailingReads(const FailingReads&) = delete;
    FailingReads& operator=(const FailingReads&) = delete;
    ~FailingReads();

    /// How many did.
    [[nodiscard]] std::int64_t failures() const;
};

/// While it is there, this process can make no hard links, as on a file system that has none. One at a time.
class FailingLinks {
  public:
    FailingLinks();
    FailingLinks(const FailingLinks&) = delete;
    FailingLinks& operator=(const FailingLinks&) = delete;
    ~FailingLinks();
};

} // namespace voxtact::test
