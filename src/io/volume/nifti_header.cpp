// SPDX-License-Identifier: MIT
#include "io/volume/nifti_header.h"

#include "io/byte_source.h"
#include "io/errors.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <utility>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

/// Offsets of the fields. NIfTI-2 has the same fields, most of them wider.
struct Offsets {
    std::size_t sizes, type, pixdim, voxelOffset, slope, intercept, units, qformCode, sformCode, quaternion, qoffset,
        srow, magic;
};
constexpr Offsets kNifti1{40, 70, 76, 108, 112, 116, 123, 252, 254, 256, 268, 280, 344};
constexpr Offsets kNifti2{16, 12, 104, 168, 176, 184, 500, 344, 348, 352, 376, 400, 4};
/// SPM's origin: five int16 in Analyze's `originator`.
constexpr std::size_t kAnalyzeOrigin = 253;

/// The sizes, offsets and codes are of one type each in both versions; the reals are all floats or all doubles.
template <class Size, class Code, class Real> class Fields {
  public:
    Fields(std::string_view head, bool swapped) : head_(head), swapped_(swapped) {}

    [[nodiscard]] std::int64_t size(std::size_t offset, std::size_t i) const { return at<Size>(offset, i); }
    [[nodiscard]] std::int32_t code(std::size_t offset) const { return at<Code>(offset, 0); }
    [[nodiscard]] double real(std::size_t offset, std::size_t i = 0) const {
        return static_cast<double>(at<Real>(offset, i));
    }
    template <class Number> [[nodiscard]] Number at(std::size_t offset, std::size_t i) const {
        return numberAt<Number>(head_, offset + i * sizeof(Number), swapped_);
    }

  private:
    std::string_view head_;
    bool swapped_;
};

template <class Read>
Result<NiftiHeader> parse(const fs::path& path, const Read& read, const Offsets& offsets, NiftiHeader header) {
    const std::int64_t dimensions = read.size(offsets.sizes, 0);
    if (dimensions < 1 || dimensions > 7) {
        return cannotRead(path, "its NIfTI header is damaged (" + std::to_string(dimensions) + " dimensions)");
    }
    for (std::size_t i = 1; i <= static_cast<std::size_t>(dimensions); ++i) {
        header.sizes.push_back(read.size(offsets.sizes, i));
    }
    header.type = read.template at<std::int16_t>(offsets.type, 0);
    for (std::size_t i = 0; i < 4; ++i) {
        header.pixdim[i] = read.real(offsets.pixdim, i);
    }
    header.slope = read.real(offsets.slope);
    header.intercept = read.real(offsets.intercept);
    if (header.kind == NiftiHeader::Kind::Analyze) {
        for (std::size_t i = 0; i < 3; ++i) {
            header.analyzeOrigin[i] = read.template at<std::int16_t>(kAnalyzeOrigin, i);
        }
        return header;
    }
    header.qformCode = read.code(offsets.qformCode);
    header.sformCode = read.code(offsets.sformCode);
    for (std::size_t i = 0; i < 3; ++i) {
        header.quaternion[i] = read.real(offsets.quaternion, i);
        header.qoffset[i] = read.real(offsets.qoffset, i);
        for (std::size_t column = 0; column < 4; ++column) {
            header.srow[i][column] = read.real(offsets.srow, 4 * i + column);
        }
    }
    return header;
}

/// No voxels precede the header's end.
Result<NiftiHeader> withOffset(const fs::path& path, NiftiHeader header, double offset, bool single) {
    const std::size_t least = !single ? 0 : header.kind == NiftiHeader::Kind::Nifti2 ? kNifti2Bytes : kNifti1Bytes;
    constexpr double kMost = 1e15;
    if (!(offset >= static_cast<double>(least) && offset < kMost)) {
        return cannotRead(path, "its NIfTI header is damaged: its voxels cannot begin at its vox_offset");
    }
    header.voxelOffset = static_cast<std::uint64_t>(offset);
    return header;
}

Result<NiftiHeader> parseFirst(const fs::path& path, std::string_view head, bool single, NiftiHeader header) {
    const std::string_view magic = head.substr(kNifti1.magic, 4);
    if (magic == std::string_view("ni1\0", 4) || magic == std::string_view("n+1\0", 4)) {
        if (single && magic[1] == 'i') {
            return cannotRead(path, "its header says that its voxels are in a separate .img file; name it .hdr");
        }
        header.kind = NiftiHeader::Kind::Nifti1;
    } else if (!single) {
        header.kind = NiftiHeader::Kind::Analyze;
    } else {
        return cannotRead(path, "it is not a NIfTI file (its header is not one)");
    }
    const Fields<std::int16_t, std::int16_t, float> fields(head, header.swapped);
    const bool isNifti = header.kind == NiftiHeader::Kind::Nifti1;
    header.units = isNifti ? static_cast<unsigned char>(head[kNifti1.units]) : 0;
    Result<NiftiHeader> parsed = parse(path, fields, kNifti1, std::move(header));
    return parsed.ok() ? withOffset(path, std::move(*parsed), fields.real(kNifti1.voxelOffset), single) : parsed;
}

Result<NiftiHeader> parseSecond(const fs::path& path, std::string_view head, bool single, NiftiHeader header) {
    const std::string_view magic = head.substr(kNifti2.magic, 8);
    // The last four bytes are damaged where a transfer took the file for text.
    if (magic != std::string_view("n+2\0\r\n\032\n", 8) && magic != std::string_view("ni2\0\r\n\032\n", 8)) {
        return cannotRead(path, "its NIfTI-2 header is damaged (its magic bytes); get the file again");
    }
    if (single && magic[1] == 'i') {
        return cannotRead(path, "its header says that its voxels are in a separate .img file; name it .hdr");
    }
    const Fields<std::int64_t, std::int32_t, double> fields(head, header.swapped);
    header.kind = NiftiHeader::Kind::Nifti2;
    header.units = fields.code(kNifti2.units);
    Result<NiftiHeader> parsed = parse(path, fields, kNifti2, std::move(header));
    const auto offset = static_cast<double>(fields.at<std::int64_t>(kNifti2.voxelOffset, 0));
    return parsed.ok() ? withOffset(path, std::move(*parsed), offset, single) : parsed;
}

/// Writes the fields of a NIfTI-1 header.
class Writer {
  public:
    Writer() : bytes_(kNifti1Bytes, '\0') {}

    template <class Number> void put(std::size_t offset, std::size_t i, Number number) {
        std::memcpy(bytes_.data() + offset + i * sizeof number, &number, sizeof number);
    }
    void putReals(std::size_t offset, std::span<const double> numbers) {
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            put(offset, i, static_cast<float>(numbers[i]));
        }
    }
    [[nodiscard]] std::string take() { return std::move(bytes_); }

  private:
    std::string bytes_;
};

bool beginsWith(std::string_view head, std::size_t headerBytes, bool swapped) {
    return numberAt<std::int32_t>(head, 0, swapped) == static_cast<std::int32_t>(headerBytes);
}

} // namespace

bool isNifti2(std::string_view head) {
    return head.size() >= 4 && (beginsWith(head, kNifti2Bytes, false) || beginsWith(head, kNifti2Bytes, true));
}

std::string nifti1Bytes(const NiftiHeader& header, StoredType voxels) {
    const NiftiType type = *std::ranges::find(kNiftiTypes, voxels, &NiftiType::stored);
    Writer out;
    out.put(0, 0, static_cast<std::int32_t>(kNifti1Bytes));
    out.put(kNifti1.sizes, 0, static_cast<std::int16_t>(header.sizes.size()));
    for (std::size_t i = 1; i < 8; ++i) {
        const std::int64_t size = i <= header.sizes.size() ? header.sizes[i - 1] : 1;
        out.put(kNifti1.sizes, i, static_cast<std::int16_t>(size));
    }
    out.put(kNifti1.type, 0, type.number);
    out.put(kNifti1.type, 1, static_cast<std::int16_t>(8 * storedBytes(voxels))); // bitpix
    out.putReals(kNifti1.pixdim, header.pixdim);
    out.put(kNifti1.voxelOffset, 0, static_cast<float>(header.voxelOffset));
    out.putReals(kNifti1.slope, std::array{header.slope, header.intercept});
    out.put(kNifti1.units, 0, static_cast<std::uint8_t>(header.units));
    out.put(kNifti1.qformCode, 0, static_cast<std::int16_t>(header.qformCode));
    out.put(kNifti1.sformCode, 0, static_cast<std::int16_t>(header.sformCode));
    out.putReals(kNifti1.quaternion, header.quaternion);
    out.putReals(kNifti1.qoffset, header.qoffset);
    for (std::size_t row = 0; row < 3; ++row) {
        out.putReals(kNifti1.srow + row * 4 * sizeof(float), header.srow[row]);
    }
    out.put(kNifti1.magic, 0, std::array{'n', '+', '1', '\0'});
    return out.take();
}

Result<NiftiHeader> parseNiftiHeader(const fs::path& path, std::string_view head, bool single) {
    const auto truncated = [&](std::size_t bytes) {
        return cannotRead(path, "it is truncated: a NIfTI header takes " + std::to_string(bytes) + " bytes, " +
                                    std::to_string(head.size()) + " are there; get the file again");
    };
    if (head.size() < kNifti1Bytes) {
        return truncated(kNifti1Bytes);
    }
    NiftiHeader header;
    for (const bool swapped : {false, true}) {
        header.swapped = swapped;
        if (beginsWith(head, kNifti1Bytes, swapped)) {
            return parseFirst(path, head, single, std::move(header));
        }
        if (beginsWith(head, kNifti2Bytes, swapped)) {
            return head.size() < kNifti2Bytes ? truncated(kNifti2Bytes)
                                              : parseSecond(path, head, single, std::move(header));
        }
    }
    return cannotRead(path, "it is not a NIfTI file (its header is not one)");
}

} // namespace voxtact::io
