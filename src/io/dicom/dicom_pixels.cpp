// SPDX-License-Identifier: MIT
#include "io/dicom/dicom_pixels.h"

#include "core/base/try.h"
#include "io/byte_source.h"
#include "io/dicom/dicom_codecs.h"
#include "io/dicom/dicom_stream.h"
#include "io/errors.h"

namespace voxtact::io {

namespace {

/// Returns the pieces of each frame: one each, or by the table of offsets.
Result<std::vector<std::vector<DicomPiece>>> piecesOfFrames(const DicomFile& file, std::uint32_t frames) {
    const DicomPixelData& data = *file.pixels;
    std::vector<std::vector<DicomPiece>> result(frames);
    if (frames == 1) {
        result[0] = data.pieces;
        return result;
    }
    if (data.pieces.size() == frames) {
        for (std::uint32_t frame = 0; frame < frames; ++frame) {
            result[frame] = {data.pieces[frame]};
        }
        return result;
    }
    constexpr std::uint64_t kItemHeader = 8;
    const std::uint64_t base = data.pieces.front().offset - kItemHeader;
    std::size_t frame = 0;
    const bool begins = data.frameOffsets.size() == frames && data.frameOffsets[0] == 0;
    for (const DicomPiece& piece : data.pieces) {
        if (begins && frame + 1 < frames && piece.offset - kItemHeader - base == data.frameOffsets[frame + 1]) {
            ++frame;
        }
        result[frame].push_back(piece);
    }
    if (!begins || frame + 1 != frames) {
        return cannotRead(file.path, "it holds " + std::to_string(frames) + " frames in " +
                                         std::to_string(data.pieces.size()) +
                                         " compressed pieces, and its table of offsets does not say which belong "
                                         "together; convert it to explicit VR little endian");
    }
    return result;
}

class FrameSource {
  public:
    FrameSource(const DicomFile& file, const DicomImage& image, DicomStream stream)
        : file_(file), image_(image), stream_(std::move(stream)), cells_(image.pixels()) {}

    Result<void> begin() {
        if (!stream_.skip(file_.dataSetAt)) {
            return cut();
        }
        constexpr std::uint64_t kAll = ~std::uint64_t{0}; // it was inflated before, within bounds
        return file_.syntax->deflated ? stream_.inflateFromHere(kAll) : Result<void>();
    }

    Result<void> native(const DicomFrameVisitor& visit) {
        if (!stream_.skip(file_.pixels->pieces.front().offset - stream_.position())) {
            return cut();
        }
        if (image_.bitsAllocated == 1) {
            return bits(visit);
        }
        for (std::uint32_t frame = 0; frame < image_.frames; ++frame) {
            bytes_.resize(image_.frameBytes());
            if (!stream_.read(bytes_.data(), bytes_.size())) {
                return cut();
            }
            unpack();
            visit(frame, cells_);
        }
        return {};
    }

    /// One bit a pixel, the lowest of a byte first; frames begin anywhere in a byte.
    Result<void> bits(const DicomFrameVisitor& visit) {
        std::uint64_t used = 8; // of the bits of the byte that a frame shares with the one before
        char shared = 0;
        for (std::uint32_t frame = 0; frame < image_.frames; ++frame) {
            const std::uint64_t fresh = image_.pixels() > 8 - used ? image_.pixels() - (8 - used) : 0;
            bytes_.assign(1, shared);
            bytes_.resize(1 + (fresh + 7) / 8);
            if (!stream_.read(bytes_.data() + 1, bytes_.size() - 1)) {
                return cut();
            }
            for (std::size_t i = 0; i < cells_.size(); ++i) {
                const std::uint64_t bit = used + i;
                cells_[i] = static_cast<unsigned char>(bytes_[bit / 8]) >> (bit % 8) & 1U;
            }
            shared = bytes_.back();
            used = used + cells_.size() - 8 * (bytes_.size() - 1);
            visit(frame, cells_);
        }
        return {};
    }

    Result<void> compressed(const std::vector<std::vector<DicomPiece>>& frames, const DicomFrameVisitor& visit) {
        for (std::uint32_t frame = 0; frame < frames.size(); ++frame) {
            bytes_.clear();
            for (const DicomPiece& piece : frames[frame]) {
                const std::size_t before = bytes_.size();
                bytes_.resize(before + piece.length);
                if (!stream_.skip(piece.offset - stream_.position()) ||
                    !stream_.read(bytes_.data() + before, piece.length)) {
                    return cut();
                }
            }
            if (const Result<void> decoded = decode(); !decoded.ok()) {
                const std::string which = image_.isMultiFrame ? "frame " + std::to_string(frame + 1) + ": " : "";
                return cannotRead(file_.path, which + decoded.error().text + "; get the file again",
                                  decoded.error().code);
            }
            visit(frame, cells_);
        }
        return {};
    }

  private:
    [[nodiscard]] Error cut() const {
        if (stream_.failed()) {
            return readingStopped(file_.path);
        }
        return cannotRead(file_.path, "it is truncated or damaged: the file ends before its pixels do; get the file "
                                      "again");
    }

    template <class Cell> void unpackAs() {
        for (std::size_t i = 0; i < cells_.size(); ++i) {
            cells_[i] = numberAt<Cell>(bytes_, i * sizeof(Cell), file_.syntax->bigPixels);
        }
    }

    void unpack() {
        switch (image_.bitsAllocated) {
        case 8:
            return unpackAs<std::uint8_t>();
        case 16:
            return unpackAs<std::uint16_t>();
        default:
            return unpackAs<std::uint32_t>();
        }
    }

    Result<void> decode() {
        switch (file_.syntax->coding) {
        case DicomCoding::Rle:
            return decodeRle(bytes_, image_, cells_);
        case DicomCoding::Jpeg:
            return decodeJpeg(bytes_, image_, cells_);
        case DicomCoding::JpegLs:
            return decodeJpegLs(bytes_, image_, cells_);
        case DicomCoding::Jpeg2000:
        case DicomCoding::Native:
            break;
        }
        return decodeJpeg2000(bytes_, image_, cells_);
    }

    const DicomFile& file_;
    const DicomImage& image_;
    DicomStream stream_;
    std::string bytes_;
    std::vector<std::uint32_t> cells_;
};

} // namespace

Result<void> readDicomFrames(const DicomFile& file, const DicomImage& image, const DicomFrameVisitor& visit) {
    Result<DicomStream> stream = DicomStream::open(file.path);
    VOXTACT_TRY(stream);
    FrameSource source(file, image, std::move(stream).value());
    VOXTACT_TRY(source.begin());
    if (!file.pixels->encapsulated) {
        return source.native(visit);
    }
    const Result<std::vector<std::vector<DicomPiece>>> frames = piecesOfFrames(file, image.frames);
    VOXTACT_TRY(frames);
    return source.compressed(*frames, visit);
}

} // namespace voxtact::io
