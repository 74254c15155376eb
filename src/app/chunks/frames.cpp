// SPDX-License-Identifier: MIT
#include "app/chunks/frames.h"

#include "core/base/try.h"

#include <algorithm>
#include <charconv>

namespace voxtact::app {

namespace {

constexpr std::size_t kDigits = 20; // of 2^64
constexpr std::size_t kHead = kDigits + 1;

} // namespace

std::string frameHead(std::uint64_t length) {
    std::string text = std::to_string(length);
    text.insert(0, kDigits - text.size(), '0');
    return text + "\n";
}

Result<void> FrameReader::begin() {
    const char* const end = head_.data() + kDigits;
    const auto [last, bad] = std::from_chars(head_.data(), end, left_);
    if (bad != std::errc() || last != end || *end != '\n') {
        return Error{ErrorCode::Format, 0, "the length of a file in it is none"};
    }
    head_.clear();
    open_ = true;
    return files_.begin();
}

Result<void> FrameReader::add(std::string_view text) {
    while (!text.empty() || (open_ && left_ == 0)) {
        if (!open_) {
            const std::string_view more = text.substr(0, kHead - head_.size());
            head_ += more;
            text.remove_prefix(more.size());
            if (head_.size() == kHead) {
                VOXTACT_TRY(begin());
            }
            continue;
        }
        const std::string_view more =
            text.substr(0, static_cast<std::size_t>(std::min<std::uint64_t>(left_, text.size())));
        VOXTACT_TRY(files_.add(more));
        left_ -= more.size();
        text.remove_prefix(more.size());
        if (left_ == 0) {
            open_ = false;
            VOXTACT_TRY(files_.end());
        }
    }
    return {};
}

} // namespace voxtact::app
