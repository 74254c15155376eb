// SPDX-License-Identifier: MIT
#pragma once

#include "io/dicom/dicom_data_set.h"
#include "io/dicom/dicom_stream.h"

#include <cstddef>

namespace voxtact::io {

/// Walks a data set element by element. Checks every length against the enclosing data before use.
class DicomWalker {
  public:
    DicomWalker(DicomStream& stream, const DicomSyntax& syntax);

    /// The elements of group 0002.
    [[nodiscard]] bool meta(DicomDataSet& into);
    /// All elements up to the pixels, or to the end of the file where there are none.
    [[nodiscard]] bool dataSet(DicomDataSet& into);
    /// After dataSet(), where there are pixels: all elements behind them. `zeros`: how many bytes of zero fill the last
    /// block of the file.
    [[nodiscard]] bool behindPixels(std::uint64_t& zeros);

    /// Why the last call gave false.
    [[nodiscard]] const std::string& problem() const noexcept { return problem_; }
    [[nodiscard]] const std::optional<DicomPixelData>& pixels() const noexcept { return pixels_; }
    [[nodiscard]] std::size_t elements() const noexcept { return elements_; }

    /// Returns true if two letters are a type of PS3.5.
    [[nodiscard]] static bool isType(std::string_view letters);

  private:
    struct Element {
        DicomTag tag = 0;
        std::uint64_t at = 0; ///< of the tag
        std::string type;     ///< empty where it is not said
        std::uint32_t length = 0;
    };

    [[nodiscard]] bool fail(const Element& element, std::string_view what);
    [[nodiscard]] bool header(Element& element);
    [[nodiscard]] bool length(Element& element, std::size_t bytes);
    [[nodiscard]] bool fits(const Element& element, std::uint64_t end);
    [[nodiscard]] bool element(const Element& element, DicomDataSet& into, std::uint64_t end);
    [[nodiscard]] bool value(const Element& element, DicomDataSet& into);
    [[nodiscard]] bool items(const Element& element, std::vector<DicomDataSet>& into, std::uint64_t end);
    [[nodiscard]] bool item(const Element& item, DicomDataSet& into, std::uint64_t end);
    [[nodiscard]] bool fragments(const Element& element, DicomPixelData& into);
    [[nodiscard]] bool pixelData(const Element& element, const DicomDataSet& set);
    [[nodiscard]] bool zerosToTheEnd(std::uint64_t& zeros);

    DicomStream& stream_;
    bool typed_;
    bool big_;
    bool encapsulated_;
    std::size_t depth_ = 0;
    std::size_t elements_ = 0;
    std::string problem_;
    std::optional<DicomPixelData> pixels_;
};

} // namespace voxtact::io
