// SPDX-License-Identifier: MIT
#pragma once

#include "cli_fixture.h"

#include <sys/types.h>

namespace voxtact::test {

/// The program while it runs: its standard input is written, and its standard output read, by the test.
class Child {
  public:
    /// `longestFile`: bytes of a file, beyond which writing fails as on a full disk; 0: any.
    explicit Child(const Arguments& arguments, std::uint64_t longestFile = 0);
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child();

    void write(const std::string& text) const;
    void closeInput();
    /// Reads until there are so many lines in all; fewer where the output ends, or after two minutes.
    std::vector<std::string> lines(std::size_t count);
    void signal(int number) const;
    /// Reads what is left, and waits. The status is that of a shell: 128 and the signal's number where one ended it.
    Ran end();
    /// The most memory that it had, in KiB; after end().
    [[nodiscard]] long mostMemory() const { return mostMemory_; }

  private:
    bool readSome(int milliseconds);

    pid_t process_ = -1;
    int input_ = -1;
    int output_ = -1;
    std::FILE* errors_;
    std::string text_;
    long mostMemory_ = 0;
};

} // namespace voxtact::test
