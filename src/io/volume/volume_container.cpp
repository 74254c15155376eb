// SPDX-License-Identifier: MIT
#include "io/volume/volume_container.h"

#include "core/base/text.h"
#include "core/base/try.h"
#include "io/errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace voxtact::io {

namespace {

/// Bytes: far above any memory, and far below overflow.
constexpr std::uint64_t kMost = std::uint64_t{1} << 50;

Error tooMany(const std::filesystem::path& path) {
    return cannotRead(path, "its header asks for more voxels than memory can hold");
}

} // namespace

std::optional<VolumeFormat> volumeFormat(const std::filesystem::path& path) {
    const std::string ending = lowerEnding(path);
    for (const char* nifti : {".nii", ".nii.gz", ".hdr", ".hdr.gz", ".img", ".img.gz"}) {
        if (ending == nifti) {
            return VolumeFormat::Nifti;
        }
    }
    if (ending == ".nrrd" || ending == ".nhdr") {
        return VolumeFormat::Nrrd;
    }
    if (ending == ".mha" || ending == ".mhd") {
        return VolumeFormat::Meta;
    }
    return std::nullopt;
}

bool VolumeSource::has(const std::filesystem::path& path) const {
    std::error_code ignored;
    return content_ ? path == name_ : std::filesystem::exists(path, ignored);
}

Result<ByteReader> VolumeSource::open(const std::filesystem::path& path) const {
    if (content_ && path != name_) {
        return cannotRead(path, "only one file is in memory; read the volume from its folder", ErrorCode::File);
    }
    Result<ByteReader> reader = content_ ? ByteReader::ofMemory(name_, *content_) : ByteReader::ofFile(path, progress_);
    if (reader.ok() && reader->stored() == 0) {
        return cannotRead(path, "the file is empty");
    }
    return reader;
}

Result<ByteReader> VolumeSource::openBeside(const std::filesystem::path& header, std::string_view name) const {
    constexpr std::size_t kLongest = 1000;
    const bool isName = name.size() <= kLongest && std::none_of(name.begin(), name.end(), [](char c) {
                            return static_cast<unsigned char>(c) < 0x20 || c == '\x7F';
                        });
    if (!isName) {
        return cannotRead(header, "its header is damaged: what it names as the file of its voxels is no name");
    }
    Result<ByteReader> reader = open(header.parent_path() / name);
    // The name is the header's: say which header.
    return reader.ok() ? std::move(reader) : cannotRead(header, reader.error().text, reader.error().code);
}

namespace {

/// Returns the error of an unknown ending.
Error unknownFormat(const VolumeSource& source, const std::filesystem::path& path) {
    Result<ByteReader> reader = source.open(path);
    VOXTACT_TRY(reader);
    const Result<std::string> head = reader->head(132);
    if (head.ok() && head->size() == 132 && head->substr(128) == "DICM") {
        return cannotRead(path, "it is one DICOM file; give the folder that holds the series");
    }
    return cannotRead(path, "its ending is none of .nii, .nii.gz, .hdr, .img, .nrrd, .nhdr, .mha and .mhd; convert it");
}

} // namespace

Result<ContainedImage> readContainer(const VolumeSource& source, const std::filesystem::path& path,
                                     const VolumeReadOptions& options) {
    const std::optional<VolumeFormat> format = volumeFormat(path);
    if (!format) {
        return unknownFormat(source, path);
    }
    if (!options.series.empty()) {
        return cannotRead(path, "it is a file, and no folder that holds the DICOM series '" + options.series + "'");
    }
    if (*format == VolumeFormat::Nifti) {
        return readNifti(source, path, options);
    }
    Result<ContainedImage> read = *format == VolumeFormat::Nrrd ? readNrrd(source, path) : readMeta(source, path);
    VOXTACT_TRY(read);
    VOXTACT_TRY(frameOf(path, 1, options)); // their files hold one
    return read;
}

Result<std::uint64_t> frameOf(const std::filesystem::path& path, std::uint64_t frames,
                              const VolumeReadOptions& options) {
    if (!options.frame && frames > 1) {
        return cannotRead(path, "it is 4D and holds " + std::to_string(frames) +
                                    " images; name the one that is meant (frame 0 to " + std::to_string(frames - 1) +
                                    "; to the program: PATH#0)");
    }
    const std::uint64_t frame = options.frame.value_or(0);
    if (frame >= frames) {
        return cannotRead(path, "it has no frame " + std::to_string(frame) + ": it holds " + std::to_string(frames) +
                                    (frames == 1 ? " image" : " images") + ", counted from 0");
    }
    return frame;
}

Result<std::uint64_t> imageBytes(const std::filesystem::path& path, std::span<const std::int64_t> sizes,
                                 std::uint64_t bytesPerVoxel) {
    if (sizes.size() < 3) {
        return cannotRead(path, "it is " + std::to_string(sizes.size()) + "D; a 3D image is needed");
    }
    std::uint64_t bytes = bytesPerVoxel;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
        if (sizes[i] <= 0) {
            return cannotRead(path, "it has no voxels (its size along axis " + std::to_string(i) + " is " +
                                        std::to_string(sizes[i]) + ")");
        }
        if (i >= 3 && sizes[i] > 1) {
            return cannotRead(path, "it is " + std::to_string(i + 1) + "D and holds " + std::to_string(sizes[i]) +
                                        " images or components; extract one 3D image");
        }
        if (bytes > kMost / static_cast<std::uint64_t>(sizes[i]) || !std::in_range<std::uint32_t>(sizes[i])) {
            return tooMany(path);
        }
        bytes *= static_cast<std::uint64_t>(sizes[i]);
    }
    return bytes;
}

Result<std::uint64_t> frameBytes(const std::filesystem::path& path, std::vector<std::int64_t> sizes,
                                 std::uint64_t bytesPerVoxel, std::uint64_t& frames) {
    frames = 1;
    if (sizes.size() > 3 && sizes[3] > 1) {
        frames = static_cast<std::uint64_t>(sizes[3]);
        sizes[3] = 1;
    }
    const Result<std::uint64_t> bytes = imageBytes(path, sizes, bytesPerVoxel);
    return bytes.ok() && *bytes > kMost / frames ? Result<std::uint64_t>(tooMany(path)) : bytes;
}

Result<void> setSteps(Grid& grid, const AffineSteps& affine, const std::filesystem::path& path) {
    constexpr double kRounding = 1e-6; // of a unit vector in floats
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Vec3& direction = affine.directions[axis];
        const double norm = std::hypot(direction[0], direction[1], direction[2]);
        const bool isUnit = std::abs(norm - 1) < kRounding; // then both are kept as the file has them
        const double length = isUnit ? affine.lengths[axis] : affine.lengths[axis] * norm;
        if (!std::isfinite(length) || !std::isfinite(affine.origin[axis])) {
            return cannotRead(path, "its header is damaged: its spacing, direction or origin is not finite");
        }
        if (!(length >= kMinSpacing && length <= kMaxSpacing)) {
            return cannotRead(path, "its voxels along axis " + std::to_string(axis) + " are " + number(length) +
                                        " mm apart, which cannot be; mend its header");
        }
        if (std::abs(affine.origin[axis]) > kMaxSpacing) {
            return cannotRead(path, "its origin is " + number(affine.origin[axis]) +
                                        " mm away, which cannot be; mend its header");
        }
        grid.spacing[axis] = length;
        grid.origin[axis] = affine.origin[axis] + 0.0; // no -0
        for (std::size_t row = 0; row < 3; ++row) {
            grid.direction[3 * axis + row] = (isUnit ? direction[row] : direction[row] / norm) + 0.0;
        }
    }
    const Result<void> checked = checkGrid(grid);
    return checked.ok() ? checked : cannotRead(path, checked.error().text);
}

double cornersApart(const Grid& a, const Grid& b) {
    const Mat4 world_from_a = worldFromTexture(a);
    const Mat4 world_from_b = worldFromTexture(b);
    double most = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const Vec3 texture{corner & 1U ? 1.0 : 0.0, corner & 2U ? 1.0 : 0.0, corner & 4U ? 1.0 : 0.0};
        const Vec3 p = transformPoint(world_from_a, texture);
        const Vec3 q = transformPoint(world_from_b, texture);
        most = std::max(most, std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
    }
    return most;
}

double shearDegrees(const Grid& grid) noexcept {
    double most = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3;
        double cosine = 0;
        for (std::size_t row = 0; row < 3; ++row) {
            cosine += grid.direction[3 * a + row] * grid.direction[3 * b + row];
        }
        most = std::max(most, std::asin(std::min(1.0, std::abs(cosine))));
    }
    return most * 180 / std::numbers::pi;
}

std::string shearNote(const Grid& grid) {
    constexpr double kRounding = 0.01;
    const double shear = shearDegrees(grid);
    return shear > kRounding ? "the image's axes are not at right angles: it is sheared by " +
                                   number(std::round(shear * 1000) / 1000) + " degrees, and taken so"
                             : std::string();
}

void noteShear(const Grid& grid, std::vector<std::string>& notes) {
    if (std::string note = shearNote(grid); !note.empty()) {
        notes.push_back(std::move(note));
    }
}

} // namespace voxtact::io
