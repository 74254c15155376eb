// SPDX-License-Identifier: MIT
// The legacy format of VTK, for PolyData.
#include "core/base/try.h"
#include "io/errors.h"
#include "io/mesh/mesh_file.h"
#include "io/mesh/mesh_text.h"
#include "io/mesh/vtk/vtk_cells.h"
#include "io/mesh/vtk/vtk_text.h"
#include "io/text/text_lines.h"

#include <algorithm>
#include <array>
#include <bit>

namespace voxtact::io {

namespace {

constexpr bool kSwapped = std::endian::native == std::endian::little; // binary files are big-endian
constexpr const char* kCut = "the file is truncated or damaged; get it again";

std::optional<VtkCellKind> cellKind(std::string_view section) {
    constexpr std::array<std::pair<std::string_view, VtkCellKind>, 4> kKinds{{{"vertices", VtkCellKind::Vertices},
                                                                              {"lines", VtkCellKind::Lines},
                                                                              {"triangle_strips", VtkCellKind::Strips},
                                                                              {"polygons", VtkCellKind::Polygons}}};
    for (const auto& [name, kind] : kKinds) {
        if (name == section) {
            return kind;
        }
    }
    return std::nullopt;
}

class VtkReader {
  public:
    explicit VtkReader(const MeshSource& source) : path_(source.path), text_(source.content) {}

    Result<MeshFile> read() {
        if (const auto reason = takeHeader()) {
            return cannotRead(path_, *reason);
        }
        while (!takePadding(text_.rest(), file_)) {
            const std::string section = lowered(std::string(text_.word()));
            if (section == "point_data" || section == "cell_data") {
                break; // values of points and cells, up to the end of the file
            }
            if (const auto reason = takeSection(section)) {
                return isBinary_ ? cannotRead(path_, *reason) : badLine(path_, text_.lineNumber(), *reason);
            }
        }
        return std::move(file_);
    }

  private:
    std::optional<std::string> takeHeader() {
        const auto version = text_.line();
        const auto title = text_.line();
        if (!version || !version->starts_with("# vtk DataFile Version") || !title) {
            return "it is not a VTK file (it does not begin with # vtk DataFile Version)";
        }
        takeSpace(*title, file_);
        const std::string coding = lowered(std::string(text_.word()));
        if (coding != "ascii" && coding != "binary") {
            return "its third line is neither ASCII nor BINARY";
        }
        isBinary_ = coding == "binary";
        const std::string word = lowered(std::string(text_.word()));
        const std::string_view kind = word == "dataset" ? text_.word() : std::string_view(word);
        if (word != "dataset" || lowered(std::string(kind)) != "polydata") {
            return kind.empty() ? kCut
                                : "it holds " + inQuotes(kind) + ", which is no surface; save the surface as PolyData";
        }
        return std::nullopt;
    }

    std::optional<std::string> takeSection(const std::string& section) {
        if (section == "points") {
            return takePoints();
        }
        if (const std::optional<VtkCellKind> kind = cellKind(section)) {
            if (std::exchange(taken_[static_cast<std::size_t>(*kind)], true)) {
                return "there are two sections " + section;
            }
            std::optional<std::string> reason = takeCells(*kind);
            return reason ? section + ": " + *reason : std::optional<std::string>();
        }
        if (section == "field") {
            return takeField();
        }
        if (section == "metadata") {
            return skipVtkMetadata(text_) ? std::nullopt : std::optional<std::string>(kCut);
        }
        return inQuotes(section) + " is no section of PolyData";
    }

    std::optional<std::string> takePoints() {
        const std::optional<std::uint64_t> count = parseNatural(text_.word());
        const std::optional<StoredType> type = vtkType(lowered(std::string(text_.word())));
        if (!count || !type) {
            return "POINTS needs a number and a type (float or double)";
        }
        if (std::exchange(hasPoints_, true)) {
            return "there are two sections POINTS";
        }
        std::vector<double> coordinates;
        if (*count > text_.rest().size() || !takeLineEnd()) {
            return "points: " + std::string(kCut);
        }
        if (isBinary_) {
            const auto bytes = text_.bytes(3 * *count * storedBytes(*type));
            if (!bytes) {
                return "points: " + std::string(kCut);
            }
            appendVtkReals(*bytes, *type, kSwapped, coordinates);
        }
        for (std::uint64_t i = 0; !isBinary_ && i < 3 * *count; ++i) {
            const std::string_view word = text_.word();
            double value = 0;
            if (auto reason = word.empty() ? std::optional<std::string>(kCut) : parseNumber(word, value)) {
                return "point " + std::to_string(i / 3) + ": " + *reason;
            }
            coordinates.push_back(value);
        }
        return addVtkPoints(coordinates, file_) ? std::nullopt
                                                : std::optional<std::string>("it has more points than 32 bits count");
    }

    /// Binary data begins behind the line of its section.
    bool takeLineEnd() { return !isBinary_ || text_.line().has_value(); }

    std::optional<std::string> takeCells(VtkCellKind kind) {
        const std::optional<std::uint64_t> first = parseNatural(text_.word());
        const std::optional<std::uint64_t> second = parseNatural(text_.word());
        if (!first || !second) {
            return "it needs two numbers, of cells and of their data";
        }
        VtkCells cells(file_, 0);
        std::vector<std::uint64_t> numbers;
        VtkText ahead = text_;
        if (ahead.word() == "OFFSETS") {
            return takeListed(kind, *first, *second, cells);
        }
        if (!takeLineEnd() && *second != 0) {
            return kCut;
        }
        if (auto reason = takeNaturals(*second, StoredType::Int32, numbers)) {
            return reason;
        }
        return cells.addCounted(kind, numbers, *first);
    }

    /// The layout since version 5.1.
    std::optional<std::string> takeListed(VtkCellKind kind, std::uint64_t ends, std::uint64_t corners,
                                          VtkCells& cells) {
        std::vector<std::uint64_t> offsets;
        std::vector<std::uint64_t> connectivity;
        if (auto reason = takeArray("OFFSETS", ends, offsets)) {
            return reason;
        }
        if (auto reason = takeArray("CONNECTIVITY", corners, connectivity)) {
            return reason;
        }
        if (offsets.empty() || offsets.front() != 0) {
            return "its OFFSETS do not begin with 0";
        }
        return cells.addListed(kind, std::span(offsets).subspan(1), connectivity);
    }

    std::optional<std::string> takeArray(std::string_view name, std::uint64_t count,
                                         std::vector<std::uint64_t>& values) {
        if (text_.word() != name) {
            return "it has no " + std::string(name);
        }
        const std::optional<StoredType> type = vtkType(lowered(std::string(text_.word())));
        if (!type || *type >= StoredType::Float32) {
            return "its " + std::string(name) + " are not of a type of whole numbers";
        }
        return takeLineEnd() || count == 0 ? takeNaturals(count, *type, values) : std::optional<std::string>(kCut);
    }

    std::optional<std::string> takeNaturals(std::uint64_t count, StoredType type, std::vector<std::uint64_t>& values) {
        if (count > text_.rest().size()) {
            return kCut;
        }
        if (isBinary_) {
            const auto bytes = text_.bytes(count * storedBytes(type));
            if (!bytes) {
                return kCut;
            }
            return appendVtkNaturals(*bytes, type, kSwapped, values)
                       ? std::nullopt
                       : std::optional<std::string>("it has a negative number");
        }
        for (std::uint64_t i = 0; i < count; ++i) {
            const std::string_view word = text_.word();
            const std::optional<std::uint64_t> value = parseNatural(word);
            if (!value) {
                return word.empty() ? kCut : inQuotes(word) + " is not a natural number";
            }
            values.push_back(*value);
        }
        return std::nullopt;
    }

    /// Field data: of all arrays 3D Slicer's SPACE alone is used.
    std::optional<std::string> takeField() {
        static_cast<void>(text_.word()); // its name
        const std::optional<std::uint64_t> arrays = parseNatural(text_.word());
        if (!arrays || (!text_.line() && *arrays != 0)) {
            return "FIELD needs a name and a number of arrays";
        }
        for (std::uint64_t i = 0; i < *arrays; ++i) {
            VtkText ahead = text_;
            if (lowered(std::string(ahead.word())) == "metadata") {
                text_ = ahead;
                if (!skipVtkMetadata(text_)) {
                    return kCut;
                }
            }
            std::string_view name;
            std::string_view value;
            if (!skipVtkFieldArray(text_, isBinary_, name, value)) {
                return "field array " + std::to_string(i) + ": " + kCut;
            }
            if (name == "SPACE") {
                takeVtkSpace(value, file_);
            }
        }
        return std::nullopt;
    }

    const std::filesystem::path& path_;
    VtkText text_;
    bool isBinary_ = false;
    bool hasPoints_ = false;
    std::array<bool, 4> taken_{};
    MeshFile file_;
};

} // namespace

Result<MeshFile> readVtk(const MeshSource& source) {
    return VtkReader(source).read();
}

} // namespace voxtact::io
