// SPDX-License-Identifier: MIT
#include "cli/pairs/pose_source.h"

#include "cli/options/inputs.h"
#include "cli/output/outcome.h"
#include "core/base/try.h"

#include <algorithm>
#include <iostream>
#include <limits>
#include <span>

namespace voxtact::app {

namespace {

/// Maximum poses in memory: 8 MB of matrices.
constexpr std::size_t kMaxKept = std::size_t{1} << 16U;

constexpr const char* kStandardInput = "standard input";

/// Errors in the contents of a file are run-time failures, not invalid arguments.
Error fileFault(Error error) {
    error.code = error.code == ErrorCode::InvalidArgument ? ErrorCode::Format : error.code;
    return error;
}

} // namespace

Result<io::PoseReader> PoseSource::reader() const {
    return path_ == "-" ? io::PoseReader::over(std::cin, kStandardInput, format_)
                        : io::PoseReader::open(path_, format_);
}

Result<PoseSource> PoseSource::open(const ViewOptions& how, bool again) {
    const std::filesystem::path& path = how.poses;
    PoseSource source;
    source.path_ = path;
    source.space_ = how.posesSpace;
    source.format_ = how.posesFormat;
    if (path.empty()) {
        source.kept_ = {identity()};
        source.isKept_ = true;
        source.count_ = 1;
        return source;
    }
    if (path == "-") {
        std::ios::sync_with_stdio(false); // faster
    }
    if (path == "-" && !again) {
        return source;
    }
    const Result<void> stock = source.takeStock();
    return stock.ok() ? Result<PoseSource>(std::move(source)) : fileFault(stock.error());
}

Result<void> PoseSource::takeStock() {
    const bool standardInput = path_ == "-";
    Result<io::PoseReader> reader = this->reader();
    VOXTACT_TRY(reader);
    std::vector<Mat4> part;
    std::uint64_t count = 0;
    bool more = true;
    while (more) {
        // Kept poses need no second read, which standard input does not allow.
        const Result<bool> read = reader->read(kMaxKept, part);
        VOXTACT_TRY(read);
        more = *read;
        if (!standardInput && (more || count > 0)) {
            count += part.size();
            part.clear();
        }
    }
    isKept_ = !part.empty();
    kept_ = std::move(part);
    count_ = isKept_ ? kept_.size() : count;
    return {};
}

Result<void> PoseSource::begin(std::uint64_t from) {
    if (isKept_) {
        given_ = from;
        return {};
    }
    if (!reader_ || from == 0 || from < given_) {
        given_ = 0;
        Result<io::PoseReader> reader = this->reader();
        if (!reader.ok()) {
            return fileFault(reader.error());
        }
        reader_ = std::move(*reader);
    }
    std::vector<Mat4> passed;
    while (given_ < from) {
        VOXTACT_TRY(next(std::min<std::uint64_t>(kMaxKept, from - given_), passed));
    }
    return {};
}

Result<void> PoseSource::next(std::size_t max, std::vector<Mat4>& poses) {
    poses.clear();
    if (isKept_) {
        const std::span<const Mat4> rest = std::span<const Mat4>(kept_).subspan(static_cast<std::size_t>(given_));
        const std::span<const Mat4> taken = rest.first(std::min(max, rest.size()));
        poses.assign(taken.begin(), taken.end());
    } else if (const Result<bool> read = reader_->read(max, poses); !read.ok()) {
        return fileFault(read.error());
    }
    for (Mat4& pose : poses) {
        pose = lpsFrom(space_, pose);
    }
    given_ += poses.size();
    if (count_ && (given_ > *count_ || (poses.size() < max && given_ < *count_))) {
        return Error{ErrorCode::File, 0, "cannot read '" + path_.string() + "': it changed while it was read"};
    }
    return {};
}

} // namespace voxtact::app
