// SPDX-License-Identifier: MIT
#include "io/byte_source.h"
#include "io/errors.h"
#include "io/volume/volume_container.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kHeaderBytes = 348;
constexpr std::int32_t kNifti2HeaderBytes = 540;

/// Offsets in the NIfTI-1 header.
constexpr std::size_t kDimensions = 40;
constexpr std::size_t kDataType = 70;
constexpr std::size_t kVoxelOffset = 108;
constexpr std::size_t kQformCode = 252;
constexpr std::size_t kSformCode = 254;
constexpr std::size_t kMagic = 344;

constexpr std::int16_t kFloat = 16;
constexpr std::int16_t kDouble = 64;

/// niftilib replaces NaN and infinity by zero without a word, so they are looked for in the bytes as they go by.
template <class Number> class FiniteScan {
  public:
    FiniteScan(std::uint64_t begin, std::uint64_t bytes, bool swapped)
        : begin_(begin), end_(begin + bytes), swapped_(swapped) {}

    void take(std::string_view chunk) {
        const std::uint64_t from = std::min<std::uint64_t>(chunk.size(), begin_ - std::min(begin_, offset_));
        const std::uint64_t to = std::min<std::uint64_t>(chunk.size(), end_ - std::min(end_, offset_));
        offset_ += chunk.size();
        chunk = chunk.substr(from, to - std::min(from, to));
        if (!rest_.empty()) {
            const std::size_t missing = std::min(sizeof(Number) - rest_.size(), chunk.size());
            rest_ += chunk.substr(0, missing);
            chunk.remove_prefix(missing);
            if (rest_.size() == sizeof(Number)) {
                scan(rest_);
                rest_.clear();
            }
        }
        const std::size_t whole = chunk.size() / sizeof(Number) * sizeof(Number);
        scan(chunk.substr(0, whole));
        rest_ += chunk.substr(whole);
    }

    [[nodiscard]] const std::optional<std::uint64_t>& firstBad() const noexcept { return firstBad_; }
    [[nodiscard]] bool isNan() const noexcept { return isNan_; }

  private:
    void scan(std::string_view numbers) {
        for (std::size_t at = 0; at < numbers.size() && !firstBad_; at += sizeof(Number), ++voxel_) {
            const auto value = numberAt<Number>(numbers, at, swapped_);
            if (!std::isfinite(value)) {
                firstBad_ = voxel_;
                isNan_ = std::isnan(value);
            }
        }
    }

    std::uint64_t begin_;
    std::uint64_t end_;
    bool swapped_;
    std::uint64_t offset_ = 0;
    std::uint64_t voxel_ = 0;
    std::string rest_;
    std::optional<std::uint64_t> firstBad_;
    bool isNan_ = false;
};

struct NiftiFiles {
    fs::path header;
    fs::path image;
};

/// A pair is named by either of its files; both may be compressed.
NiftiFiles filesOf(const fs::path& path) {
    const std::string ending = lowerEnding(path);
    if (ending == ".nii" || ending == ".nii.gz") {
        return {path, path};
    }
    const std::string name = path.string();
    const std::string stem = name.substr(0, name.size() - ending.size());
    const auto present = [&](const char* plain, const char* upper) {
        std::error_code ignored;
        for (const std::string& candidate : {stem + plain, stem + plain + ".gz", stem + upper, stem + upper + ".GZ"}) {
            if (fs::exists(candidate, ignored)) {
                return fs::path(candidate);
            }
        }
        return fs::path(stem + plain);
    };
    return {present(".hdr", ".HDR"), present(".img", ".IMG")};
}

/// Bytes a voxel, or the reason why such voxels are no scalars.
Result<std::uint64_t> voxelBytes(const fs::path& path, std::int16_t type) {
    struct Known {
        std::int16_t type;
        std::uint64_t bytes;
    };
    constexpr std::array<Known, 10> kScalars{
        {{2, 1}, {4, 2}, {8, 4}, {16, 4}, {64, 8}, {256, 1}, {512, 2}, {768, 4}, {1024, 8}, {1280, 8}}};
    for (const Known& known : kScalars) {
        if (known.type == type) {
            return known.bytes;
        }
    }
    const char* const what = type == 128 || type == 2304                  ? "colours (RGB)"
                             : type == 32 || type == 1792 || type == 2048 ? "complex numbers"
                             : type == 1                                  ? "single bits"
                                                                          : "of a type that is not supported";
    return cannotRead(path, std::string("its voxels are ") + what + " (NIfTI data type " + std::to_string(type) +
                                "); convert it to integers or floats");
}

Result<std::string> readHeader(const fs::path& path) {
    Result<std::string> head = contentHead(path, kHeaderBytes);
    if (!head.ok()) {
        return head;
    }
    if (head->size() < kHeaderBytes) {
        return cannotRead(path, "it is truncated: a NIfTI header takes 348 bytes, " + std::to_string(head->size()) +
                                    " are there; get the file again");
    }
    return head;
}

struct NiftiHeader {
    bool swapped = false;
    std::string magic;
    std::vector<std::int64_t> sizes;
    std::int16_t type = 0;
    std::uint64_t voxelOffset = 0;
    bool oriented = false;
};

Result<NiftiHeader> parseHeader(const fs::path& path, std::string_view head, bool single) {
    NiftiHeader header;
    header.swapped = numberAt<std::int32_t>(head, 0) != static_cast<std::int32_t>(kHeaderBytes);
    const auto headerBytes = numberAt<std::int32_t>(head, 0, header.swapped);
    if (numberAt<std::int32_t>(head, 0) == kNifti2HeaderBytes || headerBytes == kNifti2HeaderBytes) {
        return cannotRead(path, "it is NIfTI-2, which is not supported; convert it to NIfTI-1");
    }
    header.magic = head.substr(kMagic, 3);
    if (headerBytes != static_cast<std::int32_t>(kHeaderBytes) || (single && header.magic != "n+1")) {
        return cannotRead(path, "it is not a NIfTI file (its header is not one)");
    }
    const auto dimensions = numberAt<std::int16_t>(head, kDimensions, header.swapped);
    if (dimensions < 1 || dimensions > 7) {
        return cannotRead(path, "its NIfTI header is damaged (" + std::to_string(dimensions) + " dimensions)");
    }
    for (std::size_t i = 1; i <= static_cast<std::size_t>(dimensions); ++i) {
        header.sizes.push_back(numberAt<std::int16_t>(head, kDimensions + 2 * i, header.swapped));
    }
    // ITK takes an image one slice thick for a 2D one.
    while (header.sizes.size() > 2 && header.sizes.back() == 1) {
        header.sizes.pop_back();
    }
    header.type = numberAt<std::int16_t>(head, kDataType, header.swapped);
    const auto offset = static_cast<double>(numberAt<float>(head, kVoxelOffset, header.swapped));
    if (!(offset >= 0 && offset < 1e9)) {
        return cannotRead(path, "its NIfTI header is damaged (voxel offset)");
    }
    header.voxelOffset = std::max<std::uint64_t>(static_cast<std::uint64_t>(offset), single ? kHeaderBytes : 0);
    header.oriented = numberAt<std::int16_t>(head, kQformCode, header.swapped) != 0 ||
                      numberAt<std::int16_t>(head, kSformCode, header.swapped) != 0;
    return header;
}

template <class Number>
Result<void> checkFloats(const fs::path& path, const NiftiHeader& header, std::uint64_t needed) {
    FiniteScan<Number> scan(header.voxelOffset, needed, header.swapped);
    const Result<std::uint64_t> length = contentLength(path, [&](std::string_view chunk) { scan.take(chunk); });
    if (!length.ok()) {
        return length.error();
    }
    if (scan.firstBad()) {
        const auto width = static_cast<std::uint64_t>(header.sizes[0]);
        const auto height = static_cast<std::uint64_t>(header.sizes[1]);
        const std::uint64_t voxel = *scan.firstBad();
        return cannotRead(
            path, "voxel (" + std::to_string(voxel % width) + ", " + std::to_string(voxel / width % height) + ", " +
                      std::to_string(voxel / width / height) + ") is " + (scan.isNan() ? "NaN" : "infinite"));
    }
    return checkLength(path, needed, *length - std::min(*length, header.voxelOffset));
}

Result<void> checkVoxels(const fs::path& path, const NiftiHeader& header, std::uint64_t needed) {
    if (const Result<std::uint64_t> size = readableFile(path); !size.ok()) {
        return size.error();
    }
    if (header.type == kFloat) {
        return checkFloats<float>(path, header, needed);
    }
    if (header.type == kDouble) {
        return checkFloats<double>(path, header, needed);
    }
    const Result<std::uint64_t> length = contentLength(path);
    if (!length.ok()) {
        return length.error();
    }
    return checkLength(path, needed, *length - std::min(*length, header.voxelOffset));
}

} // namespace

Result<ContainerFacts> checkNifti(const fs::path& path) {
    const NiftiFiles files = filesOf(path);
    const Result<std::string> head = readHeader(files.header);
    if (!head.ok()) {
        return head.error();
    }
    const Result<NiftiHeader> header = parseHeader(path, *head, files.header == files.image);
    if (!header.ok()) {
        return header.error();
    }
    const Result<std::uint64_t> bytes = voxelBytes(path, header->type);
    if (!bytes.ok()) {
        return bytes.error();
    }
    const Result<std::uint64_t> needed = imageBytes(path, header->sizes, *bytes);
    if (!needed.ok()) {
        return needed.error();
    }
    if (Result<void> voxels = checkVoxels(files.image, *header, *needed); !voxels.ok()) {
        return voxels.error();
    }
    ContainerFacts facts{VolumeFormat::Nifti, files.header, {}};
    if (header->magic != "n+1" && header->magic != "ni1") {
        facts.notes.emplace_back("the file is Analyze 7.5, which does not say how the patient lies; ITK assumes it");
    } else if (!header->oriented) {
        facts.notes.emplace_back(
            "the file does not say how the patient lies (qform and sform are unset); the voxel axes "
            "are taken as right, anterior, superior");
    }
    return facts;
}

} // namespace voxtact::io
