// SPDX-License-Identifier: MIT
#include "cad_files.h"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom_BSplineSurface.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Controller.hxx>
#include <STEPControl_Writer.hxx>
#include <TColStd_Array2OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Ax2.hxx>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace voxtact::test {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Vec3 round(double angle, double radius, double z) {
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// A surface of revolution from (radius, z) to (radius, z), with both ends closed.
CadCase frustum(const std::string& name, const TopoDS_Shape& shape, double bottom, double top, double height) {
    CadCase out{name, shape, {}};
    for (int i = 0; i < 400; ++i) {
        for (int j = 0; j <= 20; ++j) {
            const double part = j / 20.0;
            const double radius = bottom + part * (top - bottom);
            out.samples.push_back(round(i * kTurn / 400, radius, part * height));
            out.samples.push_back(round(i * kTurn / 400, part * bottom, 0));
            out.samples.push_back(round(i * kTurn / 400, part * top, height));
        }
    }
    out.off = [=](const Vec3& at) {
        const double r = std::hypot(at[0], at[1]);
        const double side = std::abs(r - (bottom + at[2] / height * (top - bottom)));
        return std::min({side, std::abs(at[2]), std::abs(at[2] - height)});
    };
    return out;
}

CadCase torus(double ring, double tube) {
    CadCase out{"torus", BRepPrimAPI_MakeTorus(ring, tube).Shape(), {}};
    for (int i = 0; i < 300; ++i) {
        for (int j = 0; j < 60; ++j) {
            const double angle = j * kTurn / 60;
            out.samples.push_back(round(i * kTurn / 300, ring + tube * std::cos(angle), tube * std::sin(angle)));
        }
    }
    out.off = [=](const Vec3& at) { return std::abs(std::hypot(std::hypot(at[0], at[1]) - ring, at[2]) - tube); };
    return out;
}

/// Points of all faces, on a grid of parameters.
CadCase sampled(const std::string& name, const TopoDS_Shape& shape) {
    constexpr int kGrid = 60;
    CadCase out{name, shape, {}};
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
        const TopoDS_Face face = TopoDS::Face(faces.Current());
        const opencascade::handle<Geom_Surface> surface = BRep_Tool::Surface(face);
        double u0 = 0;
        double u1 = 0;
        double v0 = 0;
        double v1 = 0;
        BRepTools::UVBounds(face, u0, u1, v0, v1);
        for (int i = 0; i <= kGrid; ++i) {
            for (int j = 0; j <= kGrid; ++j) {
                const gp_Pnt2d at(u0 + (u1 - u0) * i / kGrid, v0 + (v1 - v0) * j / kGrid);
                if (BRepClass_FaceClassifier(face, at, 1e-9).State() == TopAbs_IN) {
                    const gp_Pnt point = surface->Value(at.X(), at.Y());
                    out.samples.push_back({point.X(), point.Y(), point.Z()});
                }
            }
        }
    }
    return out;
}

TopoDS_Shape patch(bool rational) {
    constexpr int kPoles = 6;
    TColgp_Array2OfPnt poles(1, kPoles, 1, kPoles);
    TColStd_Array2OfReal weights(1, kPoles, 1, kPoles);
    for (int i = 1; i <= kPoles; ++i) {
        for (int j = 1; j <= kPoles; ++j) {
            poles(i, j) =
                gp_Pnt(4 * i + 0.7 * (j % 2), 4 * j - 0.5 * (i % 3), 3 * std::sin(1.3 * i) * std::cos(0.9 * j));
            weights(i, j) = rational ? 1 + 0.5 * ((i + 2 * j) % 3) : 1;
        }
    }
    TColStd_Array1OfReal knots(1, 4);
    TColStd_Array1OfInteger multiplicities(1, 4);
    for (int i = 1; i <= 4; ++i) {
        knots(i) = i - 1 + (i == 3 ? 0.3 : 0);
        multiplicities(i) = i == 1 || i == 4 ? 4 : 1;
    }
    const opencascade::handle<Geom_BSplineSurface> surface =
        new Geom_BSplineSurface(poles, weights, knots, knots, multiplicities, multiplicities, 3, 3);
    return BRepBuilderAPI_MakeFace(surface, 1e-7).Shape();
}

TopoDS_Shape pierced() {
    const TopoDS_Shape along = BRepPrimAPI_MakeCylinder(5, 20).Shape();
    const gp_Ax2 across(gp_Pnt(-10, 1, 10), gp_Dir(1, 0, 0.2));
    return BRepAlgoAPI_Cut(along, BRepPrimAPI_MakeCylinder(across, 2, 30).Shape()).Shape();
}

} // namespace

CadCase sphereCase(double radius) {
    CadCase out{"sphere", BRepPrimAPI_MakeSphere(radius).Shape(), {}};
    for (int i = 0; i < 200; ++i) {
        for (int j = 0; j <= 100; ++j) {
            const double angle = j * std::numbers::pi / 100;
            out.samples.push_back(round(i * kTurn / 200, radius * std::sin(angle), radius * std::cos(angle)));
        }
    }
    out.off = [=](const Vec3& at) { return std::abs(std::hypot(at[0], at[1], at[2]) - radius); };
    return out;
}

std::vector<CadCase> cadCases() {
    std::vector<CadCase> cases;
    cases.push_back(frustum("cylinder", BRepPrimAPI_MakeCylinder(5, 20).Shape(), 5, 5, 20));
    cases.push_back(frustum("cone", BRepPrimAPI_MakeCone(4, 1, 10).Shape(), 4, 1, 10));
    cases.push_back(sphereCase(6));
    cases.push_back(torus(8, 2));
    cases.push_back(sampled("patch", patch(false)));
    cases.push_back(sampled("rational patch", patch(true)));
    const TopoDS_Shape holed = pierced();
    cases.push_back(sampled("pierced", holed));
    cases.push_back(sampled("pierced nurbs", BRepBuilderAPI_NurbsConvert(holed).Shape()));
    return cases;
}

void writeCad(const std::filesystem::path& path, const TopoDS_Shape& shape, bool inches) {
    Message::DefaultMessenger()->ChangePrinters().Clear();
    bool written = false;
    if (path.extension() == ".igs" || path.extension() == ".iges") {
        IGESControl_Writer writer(inches ? "INCH" : "MM", 0);
        written = writer.AddShape(shape) && writer.Write(path.c_str());
    } else {
        STEPControl_Controller::Init(); // else the parameter does not exist; a writer takes it when it is made
        Interface_Static::SetCVal("write.step.unit", inches ? "INCH" : "MM");
        STEPControl_Writer writer;
        written = writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone &&
                  writer.Write(path.c_str()) == IFSelect_RetDone;
    }
    if (!written) {
        throw std::runtime_error("cannot write " + path.string());
    }
}

} // namespace voxtact::test
