// SPDX-License-Identifier: MIT
// The XML format of VTK, for PolyData.
#include "io/errors.h"
#include "io/mesh/mesh_file.h"
#include "io/mesh/vtk/vtk_cells.h"
#include "io/mesh/vtk/vtp_data.h"
#include "io/text/text_lines.h"

#include <array>
#include <new>
#include <tuple>

namespace voxtact::io {

namespace {

/// The XML of a file, and the appended data that an XML reader cannot take.
struct VtpParts {
    std::string xml;
    std::string_view appended; ///< behind the underscore
};

VtpParts splitVtp(std::string_view content) {
    const std::size_t begin = content.find("<AppendedData");
    if (begin == std::string_view::npos) {
        return {std::string(content), {}};
    }
    const std::size_t end = content.find('>', begin);
    const std::size_t close = content.rfind("</AppendedData");
    const std::size_t underscore = content.find_first_not_of(" \t\r\n", end == std::string_view::npos ? end : end + 1);
    if (end == std::string_view::npos || close == std::string_view::npos || underscore >= close ||
        content[underscore] != '_') {
        throw VtpRefusal{"it is truncated or damaged: its appended data does not begin with _ and end with "
                         "</AppendedData>"};
    }
    return {std::string(content.substr(0, end + 1)) + std::string(content.substr(close)),
            content.substr(underscore + 1, close - underscore - 1)};
}

pugi::xml_node childArray(pugi::xml_node parent, std::string_view name) {
    for (const pugi::xml_node array : parent.children("DataArray")) {
        if (name.empty() || name == array.attribute("Name").value()) {
            return array;
        }
    }
    throw VtpRefusal{"its " + std::string(*parent.name() == '\0' ? "Piece" : parent.name()) + " has no array " +
                     std::string(name.empty() ? "of points" : name)};
}

class VtpReader {
  public:
    explicit VtpReader(std::string_view content) : parts_(splitVtp(content)) {}

    MeshFile read(MeshFile file) {
        file_ = std::move(file);
        const pugi::xml_parse_result parsed = document_.load_buffer(parts_.xml.data(), parts_.xml.size());
        if (parsed.status == pugi::status_out_of_memory) {
            throw std::bad_alloc();
        }
        if (!parsed) {
            throw VtpRefusal{"its XML is damaged or cut off at byte " + std::to_string(parsed.offset) + " (" +
                             oneLine(parsed.description()) + ")"};
        }
        const pugi::xml_node root = document_.child("VTKFile");
        const std::string_view type = root.attribute("type").value();
        if (!root || type != "PolyData" || !root.child("PolyData")) {
            throw VtpRefusal{root ? "it holds " + inQuotes(type) + ", which is no surface; save the surface as PolyData"
                                  : "it is not a VTK file (it has no element VTKFile)"};
        }
        const std::string_view encoding = root.child("AppendedData").attribute("encoding").value();
        if (!parts_.appended.empty() && encoding != "raw" && encoding != "base64") {
            throw VtpRefusal{"the encoding " + inQuotes(encoding) + " of its appended data is neither raw nor base64"};
        }
        const VtpData data(root, parts_.appended, encoding == "base64");
        takeField(root.child("PolyData").child("FieldData"), data);
        for (const pugi::xml_node piece : root.child("PolyData").children("Piece")) {
            addPiece(piece, data);
        }
        return std::move(file_);
    }

  private:
    void takeField(pugi::xml_node field, const VtpData& data) {
        for (const pugi::xml_node array : field.children("Array")) {
            if (std::string_view(array.attribute("Name").value()) == "SPACE") {
                takeVtkSpace(data.text(array), file_);
            }
        }
    }

    void addPiece(pugi::xml_node piece, const VtpData& data) {
        const std::size_t firstVertex = file_.vertices.size();
        const std::uint64_t points = vtpNatural(piece, "NumberOfPoints");
        if (points != 0) {
            const pugi::xml_node array = childArray(piece.child("Points"), "");
            if (vtpNatural(array, "NumberOfComponents") != 3) {
                throw VtpRefusal{"its points do not have 3 components"};
            }
            const std::vector<double> coordinates = data.reals(array);
            if (coordinates.size() % 3 != 0 || coordinates.size() / 3 != points) {
                throw VtpRefusal{"a piece states " + std::to_string(points) + " points, and has " +
                                 std::to_string(coordinates.size()) + " coordinates"};
            }
            if (!addVtkPoints(coordinates, file_)) {
                throw VtpRefusal{"it has more points than 32 bits count"};
            }
        }
        VtkCells cells(file_, firstVertex);
        constexpr std::array<std::tuple<const char*, const char*, VtkCellKind>, 4> kKinds{
            {{"Verts", "NumberOfVerts", VtkCellKind::Vertices},
             {"Lines", "NumberOfLines", VtkCellKind::Lines},
             {"Strips", "NumberOfStrips", VtkCellKind::Strips},
             {"Polys", "NumberOfPolys", VtkCellKind::Polygons}}};
        for (const auto& [name, count, kind] : kKinds) {
            if (const std::uint64_t stated = vtpNatural(piece, count); stated != 0) {
                addCells(piece.child(name), name, kind, stated, data, cells);
            }
        }
    }

    static void addCells(pugi::xml_node section, const std::string& name, VtkCellKind kind, std::uint64_t stated,
                         const VtpData& data, VtkCells& cells) {
        const std::vector<std::uint64_t> ends = data.naturals(childArray(section, "offsets"));
        if (ends.size() != stated) {
            throw VtpRefusal{"a piece states " + std::to_string(stated) + " " + name + ", and has " +
                             std::to_string(ends.size())};
        }
        const std::vector<std::uint64_t> corners = data.naturals(childArray(section, "connectivity"));
        if (const auto reason = cells.addListed(kind, ends, corners)) {
            throw VtpRefusal{name + ": " + *reason};
        }
    }

    VtpParts parts_;
    pugi::xml_document document_;
    MeshFile file_;
};

} // namespace

Result<MeshFile> readVtp(const MeshSource& source) {
    MeshFile file;
    const std::string_view content = withoutPadding(source.content, file);
    try {
        return VtpReader(content).read(std::move(file));
    } catch (const VtpRefusal& refusal) {
        return cannotRead(source.path, refusal.reason);
    }
}

} // namespace voxtact::io
