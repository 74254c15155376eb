// SPDX-License-Identifier: MIT
#include "step/read_shape.h"

#include <IGESControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_InterfaceModel.hxx>
#include <STEPControl_Reader.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <filesystem>

namespace voxtact::step {

namespace {

/// Refuses what OpenCASCADE calls a failure: it goes on without that part of the shape.
void check(const XSControl_Reader& reader, Interface_CheckIterator checks) {
    for (checks.Start(); checks.More(); checks.Next()) {
        const opencascade::handle<Interface_Check> one = checks.Value();
        if (one->HasFailed()) {
            // "#12" of STEP, "D7" of IGES
            const bool isNamed = one->HasEntity() && reader.Model()->Number(one->Entity()) > 0;
            const std::string where =
                isNamed ? reader.Model()->StringLabel(one->Entity())->ToCString() + std::string(": ") : "";
            throw Refusal(where + one->CFail(1));
        }
    }
}

TopoDS_Shape transferred(XSControl_Reader& reader, const std::string& path) {
    if (reader.ReadFile(path.c_str()) != IFSelect_RetDone) {
        throw Refusal("OpenCASCADE cannot parse it");
    }
    check(reader, reader.WS()->ModelCheckList());
    const int roots = reader.NbRootsForTransfer();
    const int done = reader.TransferRoots();
    check(reader, reader.WS()->TransferReader()->LastCheckList());
    if (done < roots) {
        throw Refusal(std::to_string(roots - done) + " of its " + std::to_string(roots) + " shapes cannot be read");
    }
    const TopoDS_Shape shape = reader.OneShape();
    if (shape.IsNull()) {
        throw Refusal("it holds no shape");
    }
    return shape;
}

std::string unitNote(const std::string& unit) {
    return "lengths in " + unit + " are converted to mm";
}

CadShape readStep(const std::string& path) {
    STEPControl_Reader reader;
    CadShape out{transferred(reader, path), {}};
    TColStd_SequenceOfAsciiString lengths;
    TColStd_SequenceOfAsciiString angles;
    TColStd_SequenceOfAsciiString solidAngles;
    reader.FileUnits(lengths, angles, solidAngles);
    for (const TCollection_AsciiString& length : lengths) {
        if (!length.IsEqual("millimetre")) {
            out.notes.push_back(unitNote(length.ToCString()));
        }
    }
    if (lengths.IsEmpty()) {
        out.notes.emplace_back("it states no unit of length: mm is assumed");
    }
    return out;
}

CadShape readIges(const std::string& path) {
    constexpr int kMillimetres = 2;
    IGESControl_Reader reader;
    CadShape out{transferred(reader, path), {}};
    const auto model = opencascade::handle<IGESData_IGESModel>::DownCast(reader.Model());
    const IGESData_GlobalSection& header = model->GlobalSection();
    if (header.UnitFlag() != kMillimetres) {
        const opencascade::handle<TCollection_HAsciiString> unit = header.UnitName();
        out.notes.push_back(unitNote(unit.IsNull() ? "unit " + std::to_string(header.UnitFlag()) : unit->ToCString()));
    }
    return out;
}

} // namespace

CadShape readShape(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
    return ending.starts_with(".ig") ? readIges(path) : readStep(path);
}

} // namespace voxtact::step
