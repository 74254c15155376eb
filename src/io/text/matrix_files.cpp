// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "voxtact/io.h"

#include <limits>
#include <memory>
#include <optional>
#include <ostream>

namespace voxtact::io {

namespace {

constexpr std::size_t kElements = 16;

std::string lineName(const std::filesystem::path& path, std::uint64_t line) {
    return path.string() + " line " + std::to_string(line);
}

/// The file holds rows, Mat4 holds columns.
std::size_t columnMajor(std::size_t rowMajor) {
    return 4 * (rowMajor % 4) + rowMajor / 4;
}

Result<Mat4> parsePose(const std::vector<std::string_view>& tokens, const std::filesystem::path& path,
                       std::uint64_t line) {
    Mat4 pose{};
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        double value = 0;
        if (const auto reason = parseNumber(tokens[i], value)) {
            return badLine(path, line, *reason);
        }
        if (i < kElements) {
            pose[columnMajor(i)] = value;
        }
    }
    if (tokens.size() != kElements) {
        return badLine(path, line,
                       std::to_string(tokens.size()) + (tokens.size() == 1 ? " number" : " numbers") +
                           ", a pose has 16 (row by row)");
    }
    if (Result<void> affine = checkAffine(pose, lineName(path, line)); !affine.ok()) {
        return Error{ErrorCode::Format, 0, affine.error().text};
    }
    return pose;
}

} // namespace

struct PoseReader::State {
    LineReader lines;
    std::vector<std::string_view> tokens{};
    bool any = false;

    /// The next pose; nothing at the end.
    Result<std::optional<Mat4>> next();
};

Result<std::optional<Mat4>> PoseReader::State::next() {
    do {
        const Result<std::optional<std::string_view>> line = lines.next();
        VOXTACT_TRY(line);
        if (!line->has_value()) {
            return any ? Result(std::optional<Mat4>())
                       : cannotRead(lines.name(), "it holds no pose; a pose is a line of 16 numbers, row by row");
        }
        splitTokens(**line, tokens);
    } while (tokens.empty());
    const Result<Mat4> pose = parsePose(tokens, lines.name(), lines.lineNumber());
    VOXTACT_TRY(pose);
    any = true;
    return std::optional(*pose);
}

PoseReader::PoseReader(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
PoseReader::PoseReader(PoseReader&&) noexcept = default;
PoseReader& PoseReader::operator=(PoseReader&&) noexcept = default;
PoseReader::~PoseReader() = default;

Result<PoseReader> PoseReader::open(const std::filesystem::path& path) {
    return guard([&]() -> Result<PoseReader> {
        Result<LineReader> lines = LineReader::open(path);
        VOXTACT_TRY(lines);
        return PoseReader(std::make_unique<State>(State{std::move(*lines)}));
    });
}

Result<PoseReader> PoseReader::over(std::istream& stream, const std::string& name) {
    return guard([&]() -> Result<PoseReader> {
        if (stream.bad() || stream.rdbuf() == nullptr) {
            return readingStopped(name);
        }
        return PoseReader(std::make_unique<State>(State{LineReader::over(stream, name)}));
    });
}

Result<bool> PoseReader::read(std::size_t most, std::vector<Mat4>& world_from_object) {
    return guard([&]() -> Result<bool> {
        for (std::size_t i = 0; i < most; ++i) {
            const Result<std::optional<Mat4>> pose = state_->next();
            VOXTACT_TRY(pose);
            if (!pose->has_value()) {
                return false;
            }
            world_from_object.push_back(**pose);
        }
        return true;
    });
}

Result<std::vector<Mat4>> readPoses(const std::filesystem::path& path) {
    return guard([&]() -> Result<std::vector<Mat4>> {
        Result<PoseReader> reader = PoseReader::open(path);
        VOXTACT_TRY(reader);
        std::vector<Mat4> poses;
        const Result<bool> more = reader->read(std::numeric_limits<std::size_t>::max(), poses);
        return more.ok() ? Result<std::vector<Mat4>>(std::move(poses)) : more.error();
    });
}

Result<Mat4> readCamera(const std::filesystem::path& path) {
    return guard([&]() -> Result<Mat4> {
        Mat4 clip_from_world{};
        std::size_t count = 0;
        VOXTACT_TRY(forWords(path, [&](const auto& words, std::uint64_t line) -> Result<void> {
            for (const std::string_view word : words) {
                if (count == kElements) {
                    return badLine(path, line, "more than 16 numbers, a camera has 16 (row by row)");
                }
                if (const auto reason = parseNumber(word, clip_from_world[columnMajor(count)])) {
                    return badLine(path, line, *reason);
                }
                ++count;
            }
            return {};
        }));
        if (count != kElements) {
            return cannotRead(path, std::to_string(count) + (count == 1 ? " number" : " numbers") +
                                        ", a camera has 16 (row by row)");
        }
        if (!inverse(clip_from_world).ok()) {
            return cannotRead(path, "the matrix is singular, so it is no camera");
        }
        return clip_from_world;
    });
}

} // namespace voxtact::io
