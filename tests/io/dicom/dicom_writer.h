// SPDX-License-Identifier: MIT
#pragma once

#include "io_test_support.h"

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace voxtact::test {

inline constexpr const char* kImplicit = "1.2.840.10008.1.2";
inline constexpr const char* kExplicit = "1.2.840.10008.1.2.1";
inline constexpr const char* kDeflated = "1.2.840.10008.1.2.1.99";
inline constexpr const char* kBigEndian = "1.2.840.10008.1.2.2";
inline constexpr const char* kGeBigPixels = "1.2.840.113619.5.2";
inline constexpr const char* kRle = "1.2.840.10008.1.2.5";
inline constexpr const char* kJpegBaseline = "1.2.840.10008.1.2.4.50";
inline constexpr const char* kJpegExtended = "1.2.840.10008.1.2.4.51";
inline constexpr const char* kJpegLossless = "1.2.840.10008.1.2.4.70";
inline constexpr const char* kJpegLs = "1.2.840.10008.1.2.4.80";
inline constexpr const char* kJpeg2000 = "1.2.840.10008.1.2.4.90";

/// A DICOM data set by hand, written apart from what reads it.
class DicomSet {
  public:
    DicomSet& text(std::uint32_t tag, const char* type, const std::string& value);
    DicomSet& number(std::uint32_t tag, std::uint16_t value);
    DicomSet& sequence(std::uint32_t tag, std::vector<DicomSet> items);
    /// 16 bits per word, of the type OW.
    DicomSet& words(std::uint32_t tag, std::vector<std::uint16_t> values);
    /// Of the type OB.
    DicomSet& bytes(std::uint32_t tag, const std::string& values);
    /// Encapsulated: an empty table of offsets, and the pieces.
    DicomSet& pieces(std::uint32_t tag, std::vector<std::string> values);
    DicomSet& remove(std::uint32_t tag);

    /// The file, with its 128 bytes and meta header.
    [[nodiscard]] std::string file(const std::string& syntax = kExplicit) const;
    /// The elements alone.
    [[nodiscard]] std::string body(bool typed = true, bool big = false, bool bigPixels = false) const;

  private:
    struct Element {
        std::string type;
        std::string bytes;
        std::vector<std::uint16_t> words;
        std::vector<DicomSet> items;
        std::vector<std::string> pieces;
    };
    std::map<std::uint32_t, Element> elements_;
};

inline constexpr std::uint16_t kColumns = 5;
inline constexpr std::uint16_t kRows = 3;
inline constexpr double kGap = 2.5;

/// The value that slices made by ctSlice() hold.
[[nodiscard]] constexpr int ctValue(int slice, int row, int column) {
    return 100 * slice + 10 * row + column - 60;
}
/// Slice `index` of a CT series: 5 x 3 pixels of signed 16 bits, 0.5 mm along rows, 0.8 mm along columns, 2.5 mm apart
/// along +z from (-10, 20, 5).
[[nodiscard]] DicomSet ctSlice(int index);
[[nodiscard]] std::vector<std::uint16_t> ctWords(int index);
/// A folder's worth: "s0.dcm", "s1.dcm", ...
void writeCt(const TemporaryFolder& folder, int slices, const std::string& syntax = kExplicit);

/// Two bytes per pixel: as they are in as few pieces as can be, or in runs.
[[nodiscard]] std::string rleFrame(std::span<const std::uint16_t> cells, bool literal);
/// JPEG of one component. Lossless: predictor 1 to 7.
[[nodiscard]] std::string jpegLosslessFrame(std::span<const std::uint16_t> cells, unsigned columns, unsigned bits,
                                            unsigned predictor, unsigned restartRows);
/// Sequential, all quantization steps 1: every pixel comes back within 1.
[[nodiscard]] std::string jpegFrame(std::span<const std::uint16_t> cells, unsigned columns, unsigned bits,
                                    unsigned restartBlocks);

} // namespace voxtact::test
