// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "io/errors.h"
#include "io/volume/nifti_header.h"
#include "io/volume/volume_container.h"
#include "voxtact/io.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <new>
#include <ostream>
#include <string_view>
#include <vector>

namespace voxtact::io {

namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "voxels are written as they lie in memory");

StoredType storedType(ScalarType type) {
    switch (type) {
    case ScalarType::UInt8:
        return StoredType::UInt8;
    case ScalarType::Int16:
        return StoredType::Int16;
    case ScalarType::UInt16:
        return StoredType::UInt16;
    case ScalarType::Float32:
        break;
    }
    return StoredType::Float32;
}

std::string vector(const Vec3& numbers, const char* between) {
    return number(numbers[0]) + between + number(numbers[1]) + between + number(numbers[2]);
}

Vec3 directionOf(const Grid& grid, std::size_t axis) {
    return {grid.direction[3 * axis], grid.direction[3 * axis + 1], grid.direction[3 * axis + 2]};
}

std::string sizesOf(const Grid& grid) {
    return std::to_string(grid.size[0]) + " " + std::to_string(grid.size[1]) + " " + std::to_string(grid.size[2]);
}

std::string nrrdHead(const VolumeView& volume) {
    const char* const type = volume.type == ScalarType::UInt8    ? "uint8"
                             : volume.type == ScalarType::Int16  ? "int16"
                             : volume.type == ScalarType::UInt16 ? "uint16"
                                                                 : "float";
    const Grid& grid = volume.grid;
    std::string text = "NRRD0004\ntype: " + std::string(type) +
                       "\ndimension: 3\nspace: left-posterior-superior\nsizes: " + sizesOf(grid) +
                       "\nspace directions:";
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3 step = directionOf(grid, axis);
        for (double& component : step) {
            component *= grid.spacing[axis];
        }
        text += " (" + vector(step, ",") + ")";
    }
    return text + "\nkinds: domain domain domain\nendian: little\nencoding: raw\nspace origin: (" +
           vector(grid.origin, ",") + ")\n\n";
}

std::string metaHead(const VolumeView& volume) {
    const char* const type = volume.type == ScalarType::UInt8    ? "MET_UCHAR"
                             : volume.type == ScalarType::Int16  ? "MET_SHORT"
                             : volume.type == ScalarType::UInt16 ? "MET_USHORT"
                                                                 : "MET_FLOAT";
    const Grid& grid = volume.grid;
    return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
           "CompressedData = False\nTransformMatrix = " +
           vector(directionOf(grid, 0), " ") + " " + vector(directionOf(grid, 1), " ") + " " +
           vector(directionOf(grid, 2), " ") + "\nOffset = " + vector(grid.origin, " ") +
           "\nCenterOfRotation = 0 0 0\nElementSpacing = " + vector(grid.spacing, " ") +
           "\nDimSize = " + sizesOf(grid) + "\nElementType = " + type + "\nElementDataFile = LOCAL\n";
}

/// Refuses volumes that NIfTI cannot hold: it has single precision, 16-bit sizes, and right angles.
Result<std::string> niftiHead(const fs::path& path, const VolumeView& volume) {
    const auto refused = [&] {
        return cannotWrite(path, "this format cannot hold the image's size, place or direction; write a .nrrd file",
                           ErrorCode::Format);
    };
    const Grid& grid = volume.grid;
    if (std::ranges::max(grid.size) > static_cast<std::uint32_t>(INT16_MAX)) {
        return refused();
    }
    constexpr std::size_t kNoExtension = 4;
    NiftiHeader header;
    header.voxelOffset = kNifti1Bytes + kNoExtension;
    header.slope = 1;
    setNiftiGrid(header, grid);
    std::string bytes = nifti1Bytes(header, storedType(volume.type));
    const Result<NiftiHeader> read = parseNiftiHeader(path, bytes, true);
    std::vector<std::string> notes;
    const Result<Grid> found =
        read.ok() && imageBytes(path, read->sizes, 1).ok() ? niftiGrid(path, *read, notes) : Result<Grid>(refused());
    constexpr double kShare = 0.01;
    if (!found.ok() || !(cornersApart(*found, grid) <= kShare * std::ranges::min(grid.spacing))) {
        return refused();
    }
    bytes.append(kNoExtension, '\0');
    return bytes;
}

/// Packs the output as gzip.
class GzipWriter {
  public:
    explicit GzipWriter(std::ostream& out) : out_(out) {
        constexpr int kMostWindow = 15;
        constexpr int kGzip = 16;
        constexpr int kMemory = 8; // zlib's own default
        if (::deflateInit2(&stream_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kMostWindow + kGzip, kMemory,
                           Z_DEFAULT_STRATEGY) != Z_OK) {
            throw std::bad_alloc();
        }
    }
    GzipWriter(const GzipWriter&) = delete;
    GzipWriter& operator=(const GzipWriter&) = delete;
    ~GzipWriter() { ::deflateEnd(&stream_); }

    /// The last one says so. Stops where `out` does.
    void write(std::string_view bytes, bool last) {
        constexpr std::size_t kPiece = std::size_t{1} << 30U; // zlib counts in 32 bits
        do {
            const std::string_view piece = bytes.substr(0, kPiece);
            bytes.remove_prefix(piece.size());
            // zlib does not write there; its old interface only does not say so.
            stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));
            stream_.avail_in = static_cast<uInt>(piece.size());
            drain(last && bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
        } while (!bytes.empty() && out_);
    }

  private:
    void drain(int flush) {
        do {
            stream_.next_out = reinterpret_cast<Bytef*>(packed_.data());
            stream_.avail_out = static_cast<uInt>(packed_.size());
            ::deflate(&stream_, flush);
            out_.write(packed_.data(), static_cast<std::streamsize>(packed_.size() - stream_.avail_out));
        } while (stream_.avail_out == 0 && out_);
    }

    std::ostream& out_;
    z_stream stream_{};
    std::vector<char> packed_ = std::vector<char>(std::size_t{1} << 16U);
};

Result<std::string> headOf(const fs::path& path, VolumeFormat format, const VolumeView& volume) {
    switch (format) {
    case VolumeFormat::Nifti:
        return niftiHead(path, volume);
    case VolumeFormat::Nrrd:
        return nrrdHead(volume);
    case VolumeFormat::Meta:
        break;
    }
    return metaHead(volume);
}

/// A volume that can be written under a name: its head.
Result<std::string> checkedHead(const fs::path& name, const VolumeView& volume) {
    const std::string ending = lowerEnding(name);
    if (ending != ".nii" && ending != ".nii.gz" && ending != ".nrrd" && ending != ".mha") {
        return cannotWrite(name, "the ending of a volume is .nii, .nii.gz, .nrrd or .mha", ErrorCode::InvalidArgument);
    }
    if (const Result<ValueRange> range = checkVolume(volume); !range.ok()) {
        return cannotWrite(name, range.error().text, range.error().code);
    }
    return headOf(name, volumeFormat(name).value_or(VolumeFormat::Nrrd), volume);
}

void writeParts(std::ostream& out, const fs::path& name, const std::string& head, const VolumeView& volume) {
    const std::string_view voxels(reinterpret_cast<const char*>(volume.voxels.data()), volume.voxels.size());
    if (lowerEnding(name).ends_with(".gz")) {
        GzipWriter packed(out);
        packed.write(head, false);
        packed.write(voxels, true);
    } else {
        out.write(head.data(), static_cast<std::streamsize>(head.size()));
        out.write(voxels.data(), static_cast<std::streamsize>(voxels.size()));
    }
}

} // namespace

Result<void> writeVolume(std::ostream& out, const fs::path& name, const VolumeView& volume) {
    return guard([&]() -> Result<void> {
        const Result<std::string> head = checkedHead(name, volume);
        VOXTACT_TRY(head);
        writeParts(out, name, *head, volume);
        return {};
    });
}

Result<void> writeVolume(const fs::path& path, const VolumeView& volume) {
    return guard([&]() -> Result<void> {
        const Result<std::string> head = checkedHead(path, volume);
        VOXTACT_TRY(head);
        return writeFile(path, [&](std::ostream& out) -> Result<void> {
            writeParts(out, path, *head, volume);
            return {}; // the file's close() says whether all was written
        });
    });
}

} // namespace voxtact::io
