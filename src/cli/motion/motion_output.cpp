// SPDX-License-Identifier: MIT
#include "cli/motion/motion_output.h"

#include "cli/output/standard_streams.h"
#include "cli/pairs/extra_outputs.h"
#include "cli/version.h"
#include "core/base/try.h"

namespace voxtact::app {

Result<std::unique_ptr<MotionOutput>> MotionOutput::create(const MotionOptions& options, const MotionInputs& inputs) {
    std::optional<io::OutputFile> file;
    if (!options.output.path.empty()) {
        Result<io::OutputFile> opened = io::OutputFile::create(options.output.path);
        VOXTACT_TRY(opened);
        file = std::move(*opened);
    }
    return std::unique_ptr<MotionOutput>(new MotionOutput(options, inputs, std::move(file)));
}

MotionOutput::MotionOutput(const MotionOptions& options, const MotionInputs& inputs, std::optional<io::OutputFile> file)
    : options_(options), inputs_(inputs), file_(std::move(file)),
      writer_(file_ ? file_->stream() : text_, options.output.format()) {
    facts_ = {{"voxtact", std::string(programVersion())},
              {"question", std::string("motion")},
              {"opacity_threshold", options.transferFunction.threshold},
              {"interpolation", options.interpolation},
              {"resolution", options.resolution}};
    if (!options.shard.hasHead()) {
        writer_.omitHead();
    }
}

Result<void> MotionOutput::add(std::span<const MotionRow> rows) {
    rows_ += rows.size();
    ends_.add(rows);
    const std::vector<char>* const resampled = options_.resample ? &inputs_.isResampled : nullptr;
    writer_.add(MotionTable{options_.meshes.sources, options_.volumes, inputs_.labels, inputs_.labelNames, resampled,
                            rows, facts_}
                    .table());
    return pass();
}

/// Writes the pending text to standard output.
Result<void> MotionOutput::pass() {
    if (file_) {
        // After a failure, as on a full disk, the rest would fail, too.
        return file_->stream() ? Result<void>() : file_->close();
    }
    const std::string part = text_.str();
    text_.str({});
    return writeStandardOutput(part);
}

Result<void> MotionOutput::finish(double wallMilliseconds) {
    io::TableEnd timing{"timing"};
    if (options_.timing) {
        const double perSecond = 1000 * static_cast<double>(rows_) / wallMilliseconds;
        timing.cells = {{"segments", rows_},
                        {"wall_ms", rounded(wallMilliseconds, 1e6)},
                        {"segments_per_s", rounded(wallMilliseconds > 0 ? perSecond : 0, 10)}};
    }
    writer_.end({&timing, 1});
    if (!file_) {
        return pass();
    }
    VOXTACT_TRY(file_->close());
    return file_->commit();
}

Result<void> MotionOutput::fail() {
    return rows_ > 0 && options_.output.format() == io::Format::Json ? breakOff() : Result<void>();
}

Result<void> MotionOutput::breakOff() {
    if (file_) {
        return {};
    }
    if (rows_ == 0) {
        VOXTACT_TRY(add({})); // an empty table also has its header
    }
    writer_.end({}, false);
    return pass();
}

} // namespace voxtact::app
