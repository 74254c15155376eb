// SPDX-License-Identifier: MIT
// voxtact-step: reads STEP and IGES by OpenCASCADE for the readers of voxtact::io, which run it as a child: a crash of
// OpenCASCADE is an error of that process alone, and nothing else links it.
#include "io/mesh/cad_stream.h"
#include "step/deflection.h"
#include "step/read_shape.h"

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Poly_Triangulation.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include <cstdio>
#include <cstdlib>
#include <span>
#include <sys/resource.h>
#include <unistd.h>

namespace voxtact::step {

namespace {

struct Triangles {
    io::CadHeader header;
    std::string text;
    std::vector<double> positions;
    std::vector<std::uint32_t> indices;
};

void addFace(const TopoDS_Face& face, Triangles& out) {
    TopLoc_Location location;
    const opencascade::handle<Poly_Triangulation> triangles = BRep_Tool::Triangulation(face, location);
    const gp_Trsf place = location.Transformation();
    // Triangles turn as the surface does, which a face may use from behind.
    const bool turned = (face.Orientation() == TopAbs_REVERSED) != place.IsNegative();
    const auto first = static_cast<std::uint32_t>(out.positions.size() / 3);
    for (int i = 1; i <= triangles->NbNodes(); ++i) {
        const gp_Pnt node = triangles->Node(i).Transformed(place);
        out.positions.insert(out.positions.end(), {node.X(), node.Y(), node.Z()});
    }
    for (int i = 1; i <= triangles->NbTriangles(); ++i) {
        int a = 0;
        int b = 0;
        int c = 0;
        triangles->Triangle(i).Get(a, b, c);
        for (const int corner : {a, turned ? c : b, turned ? b : c}) {
            out.indices.push_back(first + static_cast<std::uint32_t>(corner - 1));
        }
    }
}

void triangulate(const TopoDS_Shape& shape, double deflection) {
    IMeshTools_Parameters parameters;
    parameters.Deflection = deflection;
    const BRepMesh_IncrementalMesh mesh(shape, parameters);
    int number = 0;
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
        TopLoc_Location ignored;
        ++number;
        if (BRep_Tool::Triangulation(TopoDS::Face(faces.Current()), ignored).IsNull()) {
            throw Refusal("OpenCASCADE cannot triangulate face " + std::to_string(number));
        }
    }
}

Triangles convert(const std::string& path, double deflection) {
    CadShape read = readShape(path);
    triangulate(read.shape, deflection);
    Triangles out;
    for (TopExp_Explorer faces(read.shape, TopAbs_FACE); faces.More(); faces.Next()) {
        addFace(TopoDS::Face(faces.Current()), out);
    }
    if (out.indices.empty()) {
        throw Refusal("it holds no face");
    }
    for (TopExp_Explorer edges(read.shape, TopAbs_EDGE, TopAbs_FACE); edges.More(); edges.Next()) {
        ++out.header.looseEdges;
    }
    const Deflection reached = deflectionOf(read.shape, deflection);
    out.header.deflection = reached.bound;
    if (reached.unprovenFaces > 0) {
        read.notes.push_back("the deflection of " + std::to_string(reached.unprovenFaces) +
                             " faces is twice the largest of samples, and not proven");
    }
    for (const std::string& note : read.notes) {
        out.text += note + '\n';
    }
    return out;
}

Triangles convertedOrWhyNot(const std::string& path, double deflection) {
    Triangles refused;
    try {
        return convert(path, deflection);
    } catch (const Standard_Failure& failure) {
        refused.text = std::string("OpenCASCADE: ") + failure.DynamicType()->Name() + ' ' + failure.GetMessageString();
    } catch (const std::bad_alloc&) {
        refused.text = "not enough memory";
    } catch (const std::exception& failure) {
        refused.text = failure.what();
    }
    return refused;
}

template <class T> bool write(std::FILE* file, std::span<const T> all) {
    return std::fwrite(all.data(), sizeof(T), all.size(), file) == all.size();
}

/// A damaged file may state any size: it must not take the memory of others.
void limitMemory() {
    const auto bytes = static_cast<rlim_t>(sysconf(_SC_PHYS_PAGES)) * static_cast<rlim_t>(sysconf(_SC_PAGESIZE));
    const rlimit limit{bytes, bytes};
    static_cast<void>(setrlimit(RLIMIT_AS, &limit));
    const rlimit none{0, 0};
    static_cast<void>(setrlimit(RLIMIT_CORE, &none));
}

int run(const std::string& path, double deflection) {
    // OpenCASCADE prints to standard output.
    std::FILE* const file = fdopen(dup(STDOUT_FILENO), "wb");
    if (file == nullptr || dup2(STDERR_FILENO, STDOUT_FILENO) < 0) {
        return EXIT_FAILURE;
    }
    limitMemory();
    Message::DefaultMessenger()->ChangePrinters().Clear();
    Triangles out = convertedOrWhyNot(path, deflection);
    out.header.textBytes = out.text.size();
    out.header.vertices = out.positions.size() / 3;
    out.header.triangles = out.indices.size() / 3;
    const bool written =
        write(file, std::span<const io::CadHeader>(&out.header, 1)) && write(file, std::span<const char>(out.text)) &&
        write(file, std::span<const double>(out.positions)) && write(file, std::span<const std::uint32_t>(out.indices));
    // Ends without destructors: those of OpenCASCADE's global objects may crash after a damaged file.
    std::_Exit(std::fclose(file) == 0 && written ? EXIT_SUCCESS : EXIT_FAILURE);
}

} // namespace

} // namespace voxtact::step

int main(int count, char** arguments) {
    const double deflection = count == 3 ? std::strtod(arguments[2], nullptr) : 0;
    if (!(deflection > 0) || isatty(STDOUT_FILENO) != 0) {
        std::fputs("usage: voxtact-step FILE DEFLECTION >OUT   (voxtact runs it to read STEP and IGES)\n", stderr);
        return 2;
    }
    return voxtact::step::run(arguments[1], deflection);
}
