// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

/// Files one behind the other in one: before each stands how long it is.
namespace voxtact::app {

/// What stands before a file of so many bytes.
[[nodiscard]] std::string frameHead(std::uint64_t length);

/// Takes what was framed, part by part, and tells the files apart.
class FrameReader {
  public:
    struct Files {
        std::function<Result<void>()> begin; ///< the next file
        std::function<Result<void>(std::string_view)> add;
        std::function<Result<void>()> end; ///< of that file
    };
    explicit FrameReader(Files files) : files_(std::move(files)) {}

    /// The next bytes. Refuses what is no frame (Format), and what `Files` refuses.
    [[nodiscard]] Result<void> add(std::string_view text);
    /// Whether the last file has ended.
    [[nodiscard]] bool isBetween() const noexcept { return !open_ && head_.empty(); }

  private:
    [[nodiscard]] Result<void> begin();

    Files files_;
    std::string head_; ///< as far as it has come
    std::uint64_t left_ = 0;
    bool open_ = false;
};

} // namespace voxtact::app
