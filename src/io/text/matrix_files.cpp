// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "io/text/text_lines.h"
#include "voxtact/io.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <ostream>

namespace voxtact::io {

namespace {

constexpr std::size_t kElements = 16;
constexpr std::size_t kRows = 12; // without the last row, 0 0 0 1
constexpr std::size_t kRigid = 7; // a translation and a quaternion

constexpr std::array kFormats{PoseFormat::Matrix, PoseFormat::TranslationXyzw, PoseFormat::TranslationWxyz,
                              PoseFormat::XyzwTranslation, PoseFormat::WxyzTranslation};
constexpr std::array kFormatNames{"matrix", "t-xyzw", "t-wxyz", "xyzw-t", "wxyz-t"};

std::string lineName(const std::filesystem::path& path, std::uint64_t line) {
    return path.string() + " line " + std::to_string(line);
}

/// The file holds rows, Mat4 holds columns.
std::size_t columnMajor(std::size_t rowMajor) {
    return 4 * (rowMajor % 4) + rowMajor / 4;
}

/// The numbers of a line: with blanks between them, or as a row of a CSV file.
Result<std::vector<double>> numbersOf(std::string_view text, const std::filesystem::path& path, std::uint64_t line) {
    std::vector<std::string_view> tokens;
    const auto commas = std::count(text.begin(), text.end(), ',');
    // Any other number of them is one of decimal commas.
    if (commas == 3 || commas == kRigid - 1 || commas == kRows - 1 || commas == kElements - 1) {
        for (std::size_t end = text.find(','); end != std::string_view::npos; end = text.find(',')) {
            tokens.push_back(trimmed(text.substr(0, end)));
            text.remove_prefix(end + 1);
        }
        tokens.push_back(trimmed(text));
    } else {
        splitTokens(text, tokens);
    }
    std::vector<double> numbers(tokens.size());
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        if (const auto reason = parseNumber(tokens[i], numbers[i])) {
            return badLine(path, line, *reason);
        }
    }
    return numbers;
}

Result<Mat4> makePose(std::vector<double> numbers, const std::filesystem::path& path, std::uint64_t line) {
    if (numbers.size() == kRows) {
        numbers.insert(numbers.end(), {0, 0, 0, 1});
    }
    if (numbers.size() != kElements) {
        return badLine(path, line,
                       std::to_string(numbers.size()) + (numbers.size() == 1 ? " number" : " numbers") +
                           ", a pose has 16, or 12 (row by row)");
    }
    Mat4 pose{};
    for (std::size_t i = 0; i < kElements; ++i) {
        pose[columnMajor(i)] = numbers[i];
    }
    if (Result<void> affine = checkAffine(pose, lineName(path, line)); !affine.ok()) {
        return Error{ErrorCode::Format, 0, affine.error().text};
    }
    return pose;
}

Result<Mat4> rigidPose(const std::vector<double>& numbers, PoseFormat format, const std::filesystem::path& path,
                       std::uint64_t line) {
    constexpr double kOff = 1e-3; // tolerance for rounded digits only
    if (numbers.size() != kRigid) {
        return badLine(path, line,
                       std::to_string(numbers.size()) + (numbers.size() == 1 ? " number" : " numbers") +
                           ", a pose of the format " + toString(format) + " has 7");
    }
    const bool isTranslationFirst = format == PoseFormat::TranslationXyzw || format == PoseFormat::TranslationWxyz;
    const bool isScalarFirst = format == PoseFormat::TranslationWxyz || format == PoseFormat::WxyzTranslation;
    const double* const translation = numbers.data() + (isTranslationFirst ? 0 : 4);
    const double* const quaternion = numbers.data() + (isTranslationFirst ? 3 : 0);
    const double norm = std::sqrt(quaternion[0] * quaternion[0] + quaternion[1] * quaternion[1] +
                                  quaternion[2] * quaternion[2] + quaternion[3] * quaternion[3]);
    if (!(std::abs(norm - 1) <= kOff)) {
        return badLine(path, line,
                       "the quaternion has the norm " + number(norm) +
                           ", not 1; are its numbers in the order of the "
                           "format " +
                           toString(format) + "?");
    }
    const double* const imaginary = quaternion + (isScalarFirst ? 1 : 0);
    const double w = quaternion[isScalarFirst ? 0 : 3] / norm;
    const double x = imaginary[0] / norm;
    const double y = imaginary[1] / norm;
    const double z = imaginary[2] / norm;
    return Mat4{1 - 2 * (y * y + z * z), 2 * (x * y + w * z),     2 * (x * z - w * y),     0,
                2 * (x * y - w * z),     1 - 2 * (x * x + z * z), 2 * (y * z + w * x),     0,
                2 * (x * z + w * y),     2 * (y * z - w * x),     1 - 2 * (x * x + y * y), 0,
                translation[0],          translation[1],          translation[2],          1};
}

} // namespace

std::span<const PoseFormat> poseFormats() noexcept {
    return kFormats;
}

const char* toString(PoseFormat format) noexcept {
    return kFormatNames[static_cast<std::size_t>(format)];
}

std::optional<PoseFormat> poseFormatFromName(std::string_view name) noexcept {
    const auto found = std::ranges::find_if(kFormats, [name](PoseFormat format) { return toString(format) == name; });
    return found == kFormats.end() ? std::nullopt : std::optional(*found);
}

struct PoseReader::State {
    LineReader lines;
    PoseFormat format = PoseFormat::Matrix;
    bool any = false;

    /// Returns the next pose; empty at the end.
    Result<std::optional<Mat4>> next();

  private:
    /// Returns the next line that is not empty; none at the end.
    Result<std::optional<std::string_view>> line();
    /// The rest of a matrix of four lines.
    Result<Mat4> block(std::vector<double> numbers);
    /// Reads the lines after "Transform: TYPE".
    Result<Mat4> transform(std::string_view type);
    /// The numbers of the line that begins so.
    Result<std::vector<double>> field(std::string_view name, std::size_t count);
};

Result<std::optional<std::string_view>> PoseReader::State::line() {
    for (;;) {
        Result<std::optional<std::string_view>> line = lines.next();
        if (!line.ok() || !line->has_value() || !(*line)->empty()) {
            return line;
        }
    }
}

Result<std::optional<Mat4>> PoseReader::State::next() {
    constexpr std::string_view kTransform = "Transform:";
    const Result<std::optional<std::string_view>> first = line();
    VOXTACT_TRY(first);
    if (!first->has_value()) {
        return any ? Result(std::optional<Mat4>())
                   : cannotRead(lines.name(), format == PoseFormat::Matrix
                                                  ? "it holds no pose; a pose is a line of 16 numbers, row by row"
                                                  : "it holds no pose; a pose is a line of 7 numbers");
    }
    const Result<Mat4> pose = [&]() -> Result<Mat4> {
        if (format == PoseFormat::Matrix && (*first)->starts_with(kTransform)) {
            return transform(trimmed((*first)->substr(kTransform.size())));
        }
        Result<std::vector<double>> numbers = numbersOf(**first, lines.name(), lines.lineNumber());
        VOXTACT_TRY(numbers);
        if (format != PoseFormat::Matrix) {
            return rigidPose(*numbers, format, lines.name(), lines.lineNumber());
        }
        return numbers->size() == 4 ? block(std::move(*numbers))
                                    : makePose(std::move(*numbers), lines.name(), lines.lineNumber());
    }();
    VOXTACT_TRY(pose);
    any = true;
    return std::optional(*pose);
}

Result<Mat4> PoseReader::State::block(std::vector<double> numbers) {
    while (numbers.size() < kElements) {
        const Result<std::optional<std::string_view>> next = line();
        VOXTACT_TRY(next);
        const Result<std::vector<double>> row =
            next->has_value() ? numbersOf(**next, lines.name(), lines.lineNumber()) : std::vector<double>();
        VOXTACT_TRY(row);
        if (row->size() != 4) {
            return badLine(lines.name(), lines.lineNumber(),
                           (next->has_value() ? std::to_string(row->size()) + " numbers" : std::string("the end")) +
                               " in a pose of four lines of 4 numbers; a pose may also be a line of 16");
        }
        numbers.insert(numbers.end(), row->begin(), row->end());
    }
    return makePose(std::move(numbers), lines.name(), lines.lineNumber());
}

Result<std::vector<double>> PoseReader::State::field(std::string_view name, std::size_t count) {
    const Result<std::optional<std::string_view>> next = line();
    VOXTACT_TRY(next);
    if (!next->has_value() || !(*next)->starts_with(name)) {
        return badLine(lines.name(), lines.lineNumber(), "a line '" + std::string(name) + "' is missing");
    }
    Result<std::vector<double>> numbers = numbersOf((*next)->substr(name.size()), lines.name(), lines.lineNumber());
    if (numbers.ok() && numbers->size() != count) {
        return badLine(lines.name(), lines.lineNumber(),
                       "'" + std::string(name) + "' has " + std::to_string(numbers->size()) + " numbers, not " +
                           std::to_string(count));
    }
    return numbers;
}

/// ITK's point y = A (x - c) + t + c goes from the place of the object back to the object, as 3D Slicer writes it: the
/// pose is its inverse.
Result<Mat4> PoseReader::State::transform(std::string_view type) {
    const bool isAffine = type.starts_with("AffineTransform_") || type.starts_with("MatrixOffsetTransformBase_");
    if (!isAffine || !type.ends_with("_3_3")) {
        return badLine(lines.name(), lines.lineNumber(),
                       "the ITK transform " + inQuotes(type) + " is not supported; save it as an affine one");
    }
    const Result<std::vector<double>> parameters = field("Parameters:", 12);
    VOXTACT_TRY(parameters);
    const Result<std::vector<double>> centre = field("FixedParameters:", 3);
    VOXTACT_TRY(centre);
    Mat4 object_from_world = identity();
    for (std::size_t row = 0; row < 3; ++row) {
        double& offset = object_from_world[12 + row];
        offset = (*parameters)[9 + row] + (*centre)[row];
        for (std::size_t column = 0; column < 3; ++column) {
            const double element = (*parameters)[3 * row + column];
            object_from_world[4 * column + row] = element;
            offset -= element * (*centre)[column];
        }
    }
    const std::string name = lineName(lines.name(), lines.lineNumber());
    Result<void> affine = checkAffine(object_from_world, name);
    Result<Mat4> pose = affine.ok() ? inverse(object_from_world) : Result<Mat4>(affine.error());
    if (affine.ok() && !pose.ok()) {
        return badLine(lines.name(), lines.lineNumber(), pose.error().text);
    }
    affine = pose.ok() ? checkAffine(*pose, name) : affine;
    for (std::size_t i = 0; affine.ok() && i < kElements; ++i) {
        (*pose)[i] += 0.0; // no -0
    }
    return affine.ok() ? std::move(pose) : Error{ErrorCode::Format, 0, affine.error().text};
}

PoseReader::PoseReader(std::unique_ptr<State> state) noexcept : state_(std::move(state)) {}
PoseReader::PoseReader(PoseReader&&) noexcept = default;
PoseReader& PoseReader::operator=(PoseReader&&) noexcept = default;
PoseReader::~PoseReader() = default;

Result<PoseReader> PoseReader::open(const std::filesystem::path& path, PoseFormat format) {
    return guard([&]() -> Result<PoseReader> {
        Result<LineReader> lines = LineReader::open(path);
        VOXTACT_TRY(lines);
        return PoseReader(std::make_unique<State>(State{std::move(*lines), format}));
    });
}

Result<PoseReader> PoseReader::over(std::istream& stream, const std::string& name, PoseFormat format) {
    return guard([&]() -> Result<PoseReader> {
        if (stream.bad() || stream.rdbuf() == nullptr) {
            return readingStopped(name);
        }
        return PoseReader(std::make_unique<State>(State{LineReader::over(stream, name), format}));
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

Result<std::vector<Mat4>> readPoses(const std::filesystem::path& path, PoseFormat format) {
    return guard([&]() -> Result<std::vector<Mat4>> {
        Result<PoseReader> reader = PoseReader::open(path, format);
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
