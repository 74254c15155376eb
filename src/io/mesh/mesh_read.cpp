// SPDX-License-Identifier: MIT
#include "core/base/guard.h"
#include "core/base/refuse.h"
#include "core/base/text.h"
#include "core/base/try.h"
#include "core/facts/facts.h"
#include "io/errors.h"
#include "io/mesh/mesh_file.h"
#include "io/mesh/polygon.h"

#include <array>
#include <bit>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <span>
#include <sstream>
#include <unordered_map>

namespace voxtact::io {

namespace {

Mat4 objectFromFile(MeshSpace space, double scale) {
    const double flip = space == MeshSpace::RAS ? -scale : scale;
    Mat4 matrix = identity();
    matrix[0] = flip;
    matrix[5] = flip;
    matrix[10] = scale;
    return matrix;
}

/// The space of the user, else of the file, else LPS.
Result<MeshSpace> spaceOf(const std::filesystem::path& path, const MeshReadOptions& options, MeshFile& file) {
    if (file.saysLps && file.saysRas) {
        return cannotRead(path, "it says both SPACE=LPS and SPACE=RAS; mend it");
    }
    const MeshSpace said = file.saysRas ? MeshSpace::RAS : MeshSpace::LPS;
    if ((file.saysLps || file.saysRas) && options.space.value_or(said) != said) {
        return cannotRead(path, std::string("it says SPACE=") + (file.saysRas ? "RAS, and LPS" : "LPS, and RAS") +
                                    " is asked for; leave the space out");
    }
    if (file.saysRas && !options.space) {
        file.notes.emplace_back("the file says SPACE=RAS: x and y are negated");
    }
    return options.space.value_or(said);
}

struct PositionHash {
    std::size_t operator()(const std::array<std::uint64_t, 3>& bits) const noexcept {
        std::uint64_t hash = 0;
        for (const std::uint64_t word : bits) {
            hash = (hash ^ word) * 0x9E3779B97F4A7C15ULL;
            hash ^= hash >> 32;
        }
        return static_cast<std::size_t>(hash);
    }
};

/// All triangles of the file in one mesh; corners with the same bits become one vertex.
class Gatherer {
  public:
    Gatherer(const MeshFile& file, const Mat4& object_from_file, MeshData& mesh)
        : file_(file), object_from_file_(object_from_file), mesh_(mesh) {}

    /// The reason why the file cannot be used.
    std::optional<std::string> gather() {
        std::span<const std::uint32_t> rest = file_.corners;
        for (const std::uint32_t size : file_.faceSizes) {
            if (auto reason = addFace(rest.first(size))) {
                return reason;
            }
            rest = rest.subspan(size);
        }
        return std::nullopt;
    }

  private:
    std::optional<std::string> addFace(std::span<const std::uint32_t> face) {
        constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max();
        if (mesh_.indices.size() + 3 * face.size() > kMost) {
            return "it has more triangles than 32 bits count";
        }
        if (face.size() == 3) {
            return addTriangle(face[0], face[1], face[2]);
        }
        polygon_.clear();
        for (const std::uint32_t corner : face) {
            const Vec3& vertex = file_.vertices[corner];
            if (!std::isfinite(vertex[0]) || !std::isfinite(vertex[1]) || !std::isfinite(vertex[2])) {
                return nowhere();
            }
            polygon_.push_back(vertex);
        }
        if (auto reason = cutPolygon(polygon_, triangles_)) {
            return reason;
        }
        for (const std::array<std::uint32_t, 3>& triangle : triangles_) {
            if (auto reason = addTriangle(face[triangle[0]], face[triangle[1]], face[triangle[2]])) {
                return reason;
            }
        }
        return std::nullopt;
    }

    std::optional<std::string> addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
        for (const std::uint32_t corner : {a, b, c}) {
            if (!addCorner(file_.vertices[corner])) {
                return nowhere();
            }
        }
        return std::nullopt;
    }

    [[nodiscard]] std::string nowhere() const {
        return "triangle " + std::to_string(mesh_.indices.size() / 3) +
               " has a corner that is NaN, infinite, or too far away for a float";
    }

    bool addCorner(const Vec3& corner) {
        const Vec3 point = transformPoint(object_from_file_, corner);
        std::array<std::uint64_t, 3> bits{};
        Vec3 position{};
        for (std::size_t i = 0; i < 3; ++i) {
            if (!std::isfinite(static_cast<float>(point[i]))) {
                return false;
            }
            // Adding zero makes -0 a plain 0, which negated axes would otherwise keep apart.
            position[i] = point[i] + 0.0;
            bits[i] = std::bit_cast<std::uint64_t>(position[i]);
        }
        const auto next = static_cast<std::uint32_t>(mesh_.positions.size() / 3);
        const auto [entry, isNew] = vertices_.try_emplace(bits, next);
        if (isNew) {
            mesh_.positions.insert(mesh_.positions.end(), position.begin(), position.end());
        }
        mesh_.indices.push_back(entry->second);
        return true;
    }

    const MeshFile& file_;
    const Mat4& object_from_file_;
    MeshData& mesh_;
    std::vector<Vec3> polygon_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::unordered_map<std::array<std::uint64_t, 3>, std::uint32_t, PositionHash> vertices_;
};

/// Rounded up to three digits.
std::string deflectionNote(double deflection) {
    const double digit = std::pow(10, std::floor(std::log10(deflection)) - 2);
    std::ostringstream text;
    text << std::setprecision(3) << std::ceil(deflection / digit) * digit;
    return "triangles are up to " + text.str() +
           " mm off the curved surface: touch allows for this, other answers do not";
}

Result<MeshData> makeMesh(MeshSource source, const MeshReadOptions& options) {
    if (!(options.scale > 0) || !std::isfinite(options.scale)) {
        return refuse("the scale of a mesh must be positive and finite");
    }
    VOXTACT_TRY(checkFact(factOf("scene", "deflection"), options.deflection));
    source.deflection = options.deflection / options.scale;
    Result<MeshFile> file = readMeshFile(source);
    VOXTACT_TRY(file);
    if (file->faceSizes.empty()) {
        return cannotRead(source.path, "it holds no triangle");
    }
    const Result<MeshSpace> space = spaceOf(source.path, options, *file);
    VOXTACT_TRY(space);
    MeshData mesh;
    mesh.name = source.path.filename().string();
    mesh.notes = std::move(file->notes);
    mesh.deflection = file->deflection * options.scale;
    if (mesh.deflection > kNotedRounding) {
        mesh.notes.push_back(deflectionNote(mesh.deflection));
    }
    if (file->pointsAndLines != 0) {
        mesh.notes.push_back(std::to_string(file->pointsAndLines) + " points or lines left out");
    }
    const Mat4 object_from_file = objectFromFile(*space, options.scale);
    if (const auto reason = Gatherer(*file, object_from_file, mesh).gather()) {
        return cannotRead(source.path, *reason);
    }
    const Result<MeshFacts> facts = checkMesh(mesh.view());
    VOXTACT_TRY(facts);
    if (std::string note = roundingNote(*facts); !note.empty()) {
        mesh.notes.push_back(std::move(note));
    }
    return mesh;
}

} // namespace

void takeSpace(std::string_view comment, MeshFile& file) {
    file.saysLps = file.saysLps || comment.find("SPACE=LPS") != std::string_view::npos;
    file.saysRas = file.saysRas || comment.find("SPACE=RAS") != std::string_view::npos;
}

void addStrip(std::span<const std::uint32_t> strip, MeshFile& file) {
    for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
        const std::size_t odd = i % 2;
        file.corners.insert(file.corners.end(), {strip[i + odd], strip[i + 1 - odd], strip[i + 2]});
        file.faceSizes.push_back(3);
    }
}

bool takePadding(std::string_view rest, MeshFile& file) {
    if (rest.find_first_not_of(kPadding) != std::string_view::npos) {
        return false;
    }
    if (rest.find('\0') != std::string_view::npos) {
        file.notes.push_back(std::to_string(rest.size()) + " bytes of zeros and white space behind the mesh left out");
    }
    return true;
}

std::string_view withoutPadding(std::string_view content, MeshFile& file) {
    const std::size_t last = content.find_last_not_of(kPadding);
    const std::size_t length = last == std::string_view::npos ? 0 : last + 1;
    static_cast<void>(takePadding(content.substr(length), file));
    return content.substr(0, length);
}

Result<MeshFile> readMeshFile(const MeshSource& source) {
    if (source.content.empty()) {
        return cannotRead(source.path, "the file is empty");
    }
    const std::string ending = lowerEnding(source.path);
    if (ending == ".stl") {
        return readStl(source);
    }
    if (ending == ".obj") {
        return readObj(source);
    }
    if (ending == ".ply") {
        return readPly(source);
    }
    if (ending == ".off") {
        return readOff(source);
    }
    if (ending == ".gltf" || ending == ".glb") {
        return readGltf(source);
    }
    if (ending == ".vtk") {
        return readVtk(source);
    }
    if (ending == ".vtp") {
        return readVtp(source);
    }
    if (isCad(source.path)) {
        return readCad(source);
    }
    return cannotRead(source.path,
                      "its ending is none of .stl, .obj, .ply, .off, .vtk, .vtp, .gltf, .glb, .step, .stp, .iges and "
                      ".igs; convert it");
}

std::string roundingNote(const MeshFacts& facts) {
    if (!(facts.rounding > kNotedRounding)) {
        return {};
    }
    return "vertices rounded by up to " + number(facts.rounding) + " to fit single precision, in units of the mesh";
}

Result<MeshData> readMesh(const std::filesystem::path& path, const MeshReadOptions& options) {
    return guard([&]() -> Result<MeshData> {
        const Result<std::string> content = readWholeFile(path);
        VOXTACT_TRY(content);
        const auto other = [&](const std::filesystem::path& relative) {
            return readWholeFile(path.parent_path() / relative);
        };
        return makeMesh({path, *content, other}, options);
    });
}

Result<MeshData> readMesh(std::span<const std::byte> content, const std::filesystem::path& name,
                          const MeshReadOptions& options) {
    return guard([&] {
        const std::string_view text(reinterpret_cast<const char*>(content.data()), content.size());
        return makeMesh({name, text}, options);
    });
}

} // namespace voxtact::io
