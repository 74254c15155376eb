// SPDX-License-Identifier: MIT
// The tables of docs/files.md: for each field that they name, a file that has it and one that has it otherwise.
#include "dicom/dicom_writer.h"

#include <fstream>
#include <functional>
#include <map>
#include <sstream>

namespace voxtact::test {
namespace {

/// What was made of a file.
struct Outcome {
    bool isRead = false;
    std::string content; ///< all that was read but for the notes
    std::vector<std::string> notes;
};

/// The word of the tables for what the field does, by two files that differ in it.
std::string effectOf(const Outcome& plain, const Outcome& changed) {
    EXPECT_TRUE(plain.isRead) << plain.content;
    if (!changed.isRead) {
        return "refused";
    }
    if (plain.content != changed.content) {
        return "used";
    }
    return plain.notes != changed.notes ? "noted" : "passed over";
}

template <class Value> void write(std::ostream& out, const Value& values) {
    for (const auto& value : values) {
        out << +value << ' ';
    }
}

Outcome outcomeOf(const Result<VolumeData>& volume) {
    if (!volume.ok()) {
        return {false, volume.error().text, {}};
    }
    std::ostringstream text;
    text.precision(17);
    text << toString(volume->type) << ' ';
    write(text, volume->grid.size);
    write(text, volume->grid.spacing);
    write(text, volume->grid.origin);
    write(text, volume->grid.direction);
    for (const std::byte byte : volume->voxels) {
        text << static_cast<int>(byte) << ' ';
    }
    return {true, text.str(), volume->notes};
}

Outcome outcomeOf(const Result<MeshData>& mesh) {
    if (!mesh.ok()) {
        return {false, mesh.error().text, {}};
    }
    std::ostringstream text;
    write(text, mesh->positions);
    write(text, mesh->indices);
    return {true, text.str(), mesh->notes};
}

Outcome outcomeOf(const Result<io::LabelFile>& file) {
    if (!file.ok()) {
        return {false, file.error().text, {}};
    }
    std::ostringstream text;
    text.precision(17);
    const Grid& grid = file->labels.grid;
    write(text, grid.size);
    write(text, grid.spacing);
    write(text, grid.origin);
    write(text, grid.direction);
    for (const std::uint16_t index : file->labels.indices) {
        text << file->labels.values[index] << ' ';
    }
    for (const io::LabelName& name : file->names) {
        text << name.label << name.name << ' ';
    }
    return {true, text.str(), file->notes};
}

std::string with(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

/// The effect of each field of a format.
class Fields {
  public:
    [[nodiscard]] const std::map<std::string, std::string>& effects() const { return effects_; }

    void nifti();
    void nrrd();
    void metaImage();
    void dicom();
    void labels();
    void dicomLabels();
    void meshes();
    void vtk();
    void gltf();
    void text();

  private:
    void add(const std::string& name, const Outcome& plain, const Outcome& changed) {
        effects_[name] = effectOf(plain, changed);
    }
    Outcome volume(const std::string& name, const std::string& content) {
        return outcomeOf(io::readVolume(folder_.write(name, content)));
    }
    Outcome mesh(const std::string& name, const std::string& content) {
        return outcomeOf(io::readMesh(folder_.write(name, content)));
    }

    TemporaryFolder folder_;
    std::map<std::string, std::string> effects_;
};

void Fields::nifti() {
    const auto differ = [&](const std::string& field, const std::function<void(NiftiFile&)>& change,
                            const NiftiFile& plain = {}) {
        NiftiFile changed = plain;
        change(changed);
        add("NIfTI " + field, volume("v.nii", plain.bytes()), volume("v.nii", changed.bytes()));
    };
    NiftiFile qform;
    qform.sformCode = 0;
    qform.qformCode = 1;
    differ("dim", [](NiftiFile& file) { file.sizes = {3, 4, 2}; });
    differ("datatype", [](NiftiFile& file) { file.type = 256; });
    differ("vox_offset", [](NiftiFile& file) {
        file.extension += std::string(16, '\0');
        file.voxels[0] = '\1';
    });
    differ(
        "pixdim", [](NiftiFile& file) { file.spacing[1] = 3; }, qform);
    differ("xyzt_units", [](NiftiFile& file) { file.units = 1; });
    differ("sform_code", [](NiftiFile& file) { file.sformCode = 0; });
    differ("srow", [](NiftiFile& file) { file.sform[3] = 5; });
    differ(
        "qform_code", [](NiftiFile& file) { file.qformCode = 0; }, qform);
    differ(
        "quatern",
        [](NiftiFile& file) {
            file.quaternion = {1, 0, 0};
        },
        qform);
    differ(
        "qoffset", [](NiftiFile& file) { file.qoffset[0] = 7; }, qform);
    differ("scl_slope", [](NiftiFile& file) { file.slope = 2; });
    NiftiFile scaled;
    scaled.slope = 1;
    differ(
        "scl_inter", [](NiftiFile& file) { file.intercept = 2; }, scaled);
    const std::string bytes = NiftiFile().bytes();
    for (const auto& [field, at] : std::map<std::string, std::size_t>{
             {"cal_max", 124}, {"intent_code", 68}, {"toffset", 136}, {"descrip", 148}}) {
        std::string changed = bytes;
        changed[at] = '\7';
        add("NIfTI " + field, volume("v.nii", bytes), volume("v.nii", changed));
    }
}

void Fields::nrrd() {
    const std::string space = "NRRD0004\ntype: uint8\ndimension: 4\nspace: LPS\nsizes: 2 2 2 1\n"
                              "space directions: (1,0,0) (0,1,0) (0,0,1) none\nspace origin: (0,0,0)\n"
                              "encoding: raw\n";
    const std::string plain = "NRRD0004\ntype: short\ndimension: 3\nsizes: 1 2 2\nspacings: 1 1 1\naxis mins: 0 0 0\n"
                              "endian: little\nencoding: raw\n";
    const std::string voxels = "12345678";
    folder_.write("file", "87654321");
    const auto differ = [&](const std::string& field, const std::string& head, const std::string& changed) {
        add("NRRD " + field, volume("v.nrrd", head + "\n" + voxels), volume("v.nrrd", changed + "\n" + voxels));
    };
    differ("type", space, with(space, "uint8", "int8"));
    differ("sizes", space, with(space, "2 2 2", "1 4 2"));
    differ("endian", plain, with(plain, "little", "big"));
    add("NRRD encoding", volume("v.nrrd", space + "\n" + voxels),
        volume("v.nrrd", with(space, "raw", "ascii") + "\n1 2 3 4 5 6 7 8\n"));
    differ("byte skip", with(space, "2 2 2", "1 2 2"), with(space, "2 2 2", "1 2 2") + "byte skip: 4\n");
    add("NRRD line skip", volume("v.nrrd", space + "\n1234\n5678abcd"),
        volume("v.nrrd", space + "line skip: 1\n\n1234\n5678abcd"));
    differ("data file", space, space + "data file: file\n");
    differ("space", space, with(space, "LPS", "RAS"));
    differ("space directions", space, with(space, "(1,0,0)", "(2,0,0)"));
    differ("space origin", space, with(space, "origin: (0", "origin: (4"));
    differ("space units", space, space + "space units: \"cm\" \"cm\" \"cm\"\n");
    differ("spacings", plain, with(plain, "1 1 1", "1 3 1"));
    differ("axis mins", plain, with(plain, "mins: 0", "mins: 4"));
    differ("axis maxs", with(plain, "spacings: 1 1 1\n", ""), with(plain, "spacings: 1 1 1\n", "axis maxs: 1 4 2\n"));
    differ("centerings", plain, plain + "centerings: node node node\n");
    differ("units", plain, plain + "units: \"cm\" \"cm\" \"cm\"\n");
    const std::string listed = with(plain, "dimension: 3\nsizes: 1 2 2\nspacings: 1 1 1\naxis mins: 0 0 0",
                                    "dimension: 4\nsizes: 1 2 2 1\nspacings: nan 1 1 1");
    differ("kinds", listed, listed + "kinds: list domain domain domain\n");
    differ("old min", plain, plain + "old min: 4\n");
    differ("old max", plain, plain + "old max: 4\n");
    differ("measurement frame", space, space + "measurement frame: (0,1,0) (1,0,0) (0,0,1)\n");
    differ("thicknesses", plain, plain + "thicknesses: 1 2 3\n");
    differ("content", plain, plain + "content: a head\n");
}

void Fields::metaImage() {
    const std::string head =
        "NDims = 3\nBinaryData = True\nElementByteOrderMSB = False\nTransformMatrix = 1 0 0 0 1 0 0 0 "
        "1\nOffset = 0 0 0\nElementSpacing = 1 1 1\nDimSize = 1 2 2\nElementType = MET_SHORT\n";
    const std::string file = "ElementDataFile = LOCAL\n";
    const std::string voxels = "12345678";
    folder_.write("file", "\1\2\3\4\5\6\7\x8");
    const auto differ = [&](const std::string& field, const std::string& changed) {
        add("MetaImage " + field, volume("v.mha", head + file + voxels), volume("v.mha", changed + file + voxels));
    };
    differ("DimSize", with(head, "1 2 2", "2 1 2"));
    differ("ElementType", with(head, "MET_SHORT", "MET_USHORT"));
    differ("ElementByteOrderMSB", with(head, "MSB = False", "MSB = True"));
    add("MetaImage BinaryData", volume("v.mha", head + file + voxels),
        volume("v.mha", with(head, "BinaryData = True", "BinaryData = False") + file + "1 2 3 4\n"));
    add("MetaImage CompressedData", volume("v.mha", head + file + voxels),
        volume("v.mha", head + "CompressedData = True\n" + file + compressed("abcdefgh", Wrapping::Zlib)));
    folder_.write("long", "12345678abcdefgh");
    add("MetaImage HeaderSize", volume("v.mhd", head + "ElementDataFile = long\n"),
        volume("v.mhd", head + "HeaderSize = 8\nElementDataFile = long\n"));
    add("MetaImage ElementDataFile", volume("v.mhd", head + file + voxels),
        volume("v.mhd", head + "ElementDataFile = file\n"));
    differ("TransformMatrix", with(head, "1 0 0 0 1 0 0 0 1", "0 1 0 1 0 0 0 0 1"));
    differ("Offset", with(head, "Offset = 0", "Offset = 3"));
    differ("ElementSpacing", with(head, "1 1 1", "1 2 1"));
    const std::string sized = with(head, "ElementSpacing", "ElementSize");
    add("MetaImage ElementSize", volume("v.mha", sized + file + voxels),
        volume("v.mha", with(sized, "1 1 1", "1 2 1") + file + voxels));
    differ("DistanceUnits", head + "DistanceUnits = cm\n");
    differ("ElementNumberOfChannels", head + "ElementNumberOfChannels = 3\n");
    for (const char* field :
         {"ElementToIntensityFunctionSlope", "ElementToIntensityFunctionOffset", "Modality", "Comment"}) {
        differ(field, head + field + " = 2\n");
    }
    differ("AnatomicalOrientation", head + "AnatomicalOrientation = RAI\n");
    differ("CenterOfRotation", head + "CenterOfRotation = 1 2 3\n");
}

void Fields::dicom() {
    using Change = std::function<void(DicomSet&)>;
    const auto read = [](const Change& change, int last = 3) {
        const TemporaryFolder folder;
        for (int i = 0; i < 3; ++i) {
            DicomSet set = ctSlice(i);
            if (i < last) {
                change(set);
            }
            folder.write(std::to_string(i), set.file());
        }
        return outcomeOf(io::readVolume(folder.path()));
    };
    const Outcome plain = read([](DicomSet&) {});
    const auto differ = [&](const std::string& field, const Change& change) {
        add("DICOM " + field, plain, read(change));
    };
    const auto text = [&](const std::string& field, std::uint32_t tag, const char* type, const char* value) {
        differ(field, [=](DicomSet& set) { set.text(tag, type, value); });
    };
    const TemporaryFolder moved;
    for (int i = 0; i < 3; ++i) {
        moved.write(std::to_string(i),
                    ctSlice(i).text(0x00200032, "DS", "0\\0\\" + std::to_string(5 + kGap * i)).file());
    }
    add("DICOM ImagePositionPatient", plain, outcomeOf(io::readVolume(moved.path())));
    text("ImageOrientationPatient", 0x00200037, "DS", "-1\\0\\0\\0\\-1\\0");
    text("PixelSpacing", 0x00280030, "DS", "0.5\\0.5");
    text("RescaleSlope", 0x00281053, "DS", "2");
    text("RescaleIntercept", 0x00281052, "DS", "-1024");
    differ("DoseGridScaling",
           [](DicomSet& set) { set.remove(0x00281052).remove(0x00281053).text(0x3004000E, "DS", "0.5"); });
    differ("BitsStored", [](DicomSet& set) { set.number(0x00280101, 12); });
    const Outcome low = read([](DicomSet& set) { set.number(0x00280101, 8).number(0x00280102, 7); });
    add("DICOM HighBit", low, read([](DicomSet& set) { set.number(0x00280101, 8).number(0x00280102, 15); }));
    differ("PixelRepresentation", [](DicomSet& set) { set.number(0x00280103, 0); });
    const auto dose = [](const char* offsets) {
        const TemporaryFolder folder;
        folder.write("d", ctSlice(0)
                              .text(0x00280008, "IS", "2")
                              .text(0x3004000C, "DS", offsets)
                              .words(0x7FE00010, std::vector<std::uint16_t>(30))
                              .file());
        return outcomeOf(io::readVolume(folder.path()));
    };
    add("DICOM GridFrameOffsetVector", dose("0\\2"), dose("0\\3"));
    // The same bytes of implicit elements, with the pixels of the other byte order.
    const auto syntax = [](const std::string& uid) {
        const TemporaryFolder folder;
        for (int i = 0; i < 3; ++i) {
            folder.write(std::to_string(i), with(ctSlice(i).file(kImplicit), std::string(kImplicit) + '\0', uid));
        }
        return outcomeOf(io::readVolume(folder.path()));
    };
    add("DICOM TransferSyntaxUID", syntax(std::string(kImplicit) + '\0'), syntax(kGeBigPixels));
    text("ImageType", 0x00080008, "CS", "ORIGINAL\\PRIMARY\\M\\MOSAIC");
    differ("SamplesPerPixel", [](DicomSet& set) { set.number(0x00280002, 3); });
    text("PhotometricInterpretation", 0x00280004, "CS", "RGB");
    differ("ModalityLUTSequence", [](DicomSet& set) { set.sequence(0x00283000, {DicomSet().number(0x00283002, 1)}); });
    differ("FloatPixelData",
           [](DicomSet& set) { set.remove(0x7FE00010).words(0x7FE00008, std::vector<std::uint16_t>(30)); });
    for (const auto& [field, tag] :
         std::map<std::string, std::uint32_t>{{"SeriesInstanceUID", 0x0020000E}, {"FrameOfReferenceUID", 0x00200052}}) {
        add("DICOM " + field, plain, read([tag = tag](DicomSet& set) { set.text(tag, "UI", "7.7"); }, 2));
    }
    differ("RealWorldValueMappingSequence",
           [](DicomSet& set) { set.sequence(0x00409096, {DicomSet().text(0x00409225, "DS", "2")}); });
    text("SliceThickness", 0x00180050, "DS", "9");
    text("SpacingBetweenSlices", 0x00180088, "DS", "9");
    text("GantryDetectorTilt", 0x00181120, "DS", "20");
    text("PatientPosition", 0x00185100, "CS", "FFP");
    text("WindowCenter", 0x00281050, "DS", "40");
    differ("PixelPaddingValue", [](DicomSet& set) { set.number(0x00280120, 40); });
}

void Fields::meshes() {
    const std::string stl =
        "solid m\nfacet normal 0 0 1\nouter loop\nvertex 1 0 0\nvertex 2 0 0\nvertex 1 1 0\nendloop\n"
        "endfacet\nendsolid\n";
    const std::string obj = "# m\nv 1 0 0\nv 2 0 0\nv 1 1 0\nf 1 2 3\n";
    const std::string ply = "ply\nformat ascii 1.0\ncomment m\nelement vertex 3\nproperty float x\nproperty float y\n"
                            "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                            "1 0 0\n2 0 0\n1 1 0\n3 0 1 2\n";
    for (const auto& [format, name, text] :
         {std::tuple{"STL ", "m.stl", stl}, std::tuple{"OBJ ", "m.obj", obj}, std::tuple{"PLY ", "m.ply", ply}}) {
        add(std::string(format) + "SPACE=RAS", mesh(name, text), mesh(name, with(text, " m\n", " SPACE=RAS\n")));
        add(std::string(format) + "SPACE=LPS", mesh(name, with(text, " m\n", " SPACE=RAS\n")),
            mesh(name, with(text, " m\n", " SPACE=LPS\n")));
    }
    add("STL facet normal", mesh("m.stl", stl), mesh("m.stl", with(stl, "0 0 1", "0 0 -1")));
    add("OBJ v x y z w", mesh("m.obj", obj), mesh("m.obj", with(obj, "v 2 0 0", "v 2 0 0 2")));
    for (const char* line : {"vn 0 0 1\n", "g arm\n", "usemtl red\n"}) {
        add("OBJ " + std::string(line).substr(0, std::string(line).find(' ')), mesh("m.obj", obj),
            mesh("m.obj", line + obj));
    }
    for (const char* name : {"vertex_indices", "vertex_index"}) {
        const std::string named = with(ply, "vertex_indices", name);
        add(std::string("PLY ") + name, mesh("m.ply", named), mesh("m.ply", with(named, "3 0 1 2", "3 0 2 1")));
    }
    const std::string strips = with(ply, "element face", "element tristrips");
    add("PLY tristrips", mesh("m.ply", strips), mesh("m.ply", with(strips, "3 0 1 2", "3 0 2 1")));
    const std::string normals = with(ply, "float z\n", "float z\nproperty float nx\n");
    add("PLY nx", mesh("m.ply", ply),
        mesh("m.ply",
             with(with(with(normals, "1 0 0\n", "1 0 0 1\n"), "2 0 0\n", "2 0 0 1\n"), "1 1 0\n", "1 1 0 1\n")));
    const auto off = [](const std::string& head, const std::string& behind) {
        return head + "\n3 1 0\n1 0 0" + behind + "\n2 0 0" + behind + "\n1 1 0" + behind + "\n3 0 1 2\n";
    };
    for (const auto& [head, behind] : std::map<std::string, std::string>{
             {"COFF", " 9 9 9"}, {"NOFF", " 0 0 1"}, {"STOFF", " 0 1"}, {"4OFF", " 1"}, {"nOFF", ""}}) {
        add("OFF " + head, mesh("m.off", off("OFF", "")), mesh("m.off", off(head, behind)));
    }
    add("OFF BINARY", mesh("m.off", off("OFF", "")), mesh("m.off", off("OFF BINARY", "")));
}

void Fields::labels() {
    const std::string plain =
        "NRRD0004\ntype: uchar\ndimension: 4\nspace: LPS\nsizes: 2 1 2 2\nkinds: list domain domain "
        "domain\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n"
        "encoding: raw\nSegment0_Name:=a\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
        "Segment0_Color:=1 0 0\nSegment1_Name:=b\nSegment1_LabelValue:=1\nSegment1_Layer:=1\n";
    const auto differ = [&](const std::string& field, const std::string& from, const std::string& to) {
        const auto read = [&](const std::string& header) {
            return outcomeOf(
                io::readLabels(folder_.write("l.seg.nrrd", header + std::string("\n\1\0\0\1\0\0\0\0", 9))));
        };
        add(".seg.nrrd " + field, read(plain), read(with(plain, from, to)));
    };
    differ("Segment0_Name", "Name:=a", "Name:=c");
    differ("Segment0_LabelValue", "LabelValue:=1", "LabelValue:=2");
    differ("Segment0_Layer",
           "Layer:=0\nSegment0_Color:=1 0 0\nSegment1_Name:=b\nSegment1_LabelValue:=1\nSegment1_Layer:=1",
           "Layer:=1\nSegment0_Color:=1 0 0\nSegment1_Name:=b\nSegment1_LabelValue:=1\nSegment1_Layer:=0");
    differ("Segment0_Color", "Color:=1", "Color:=0");
    differ("Segment0_Extent", "Segment0_Color", "Segment0_Extent:=0 0 0 1 0 1\nSegment0_Color");
    differ("Segmentation_ReferenceImageExtentOffset", "Segment0_Color",
           "Segmentation_ReferenceImageExtentOffset:=5 6 7\nSegment0_Color");
    differ("space origin", "origin: (0,0,0)", "origin: (0,4,0)");
    dicomLabels();
}

void Fields::dicomLabels() {
    const auto item = [](std::uint32_t tag, const char* type, const std::string& value) {
        return DicomSet().text(tag, type, value);
    };
    const auto read = [&](const DicomSet& set) {
        Grid grid;
        grid.size = {4, 4, 2};
        return outcomeOf(io::readLabels(folder_.write("l.dcm", set.file()), {.grid = grid}));
    };
    const auto position = [&](const char* at, std::uint16_t segment = 1) {
        return DicomSet()
            .sequence(0x00209113, {item(0x00200032, "DS", at)})
            .sequence(0x0062000A, {DicomSet().number(0x0062000B, segment)});
    };
    const auto shared = [&](const char* gap, const char* thickness, const char* orientation = "1\\0\\0\\0\\1\\0",
                            const char* spacing = "1\\1") {
        return DicomSet()
            .sequence(0x00289110,
                      {item(0x00280030, "DS", spacing).text(0x00180088, "DS", gap).text(0x00180050, "DS", thickness)})
            .sequence(0x00209116, {item(0x00200037, "DS", orientation)});
    };
    DicomSet seg;
    seg.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.66.4").text(0x00280008, "IS", "2").number(0x00280002, 1);
    seg.number(0x00280010, 2).number(0x00280011, 2).number(0x00280100, 8).number(0x00280101, 8).number(0x00280102, 7);
    seg.number(0x00280103, 0).text(0x00280004, "CS", "MONOCHROME2").text(0x00620001, "CS", "FRACTIONAL");
    seg.number(0x0062000E, 200).bytes(0x7FE00010, "\x64\xC8\x32\x01\x64\xC8\x32\x01");
    seg.sequence(0x00620002,
                 {DicomSet().number(0x00620004, 1).text(0x00620005, "LO", "a").text(0x00620008, "CS", "MANUAL")});
    seg.sequence(0x52009229, {shared("1", "1")}).sequence(0x52009230, {position("0\\0\\0"), position("0\\0\\2")});
    const auto differ = [&](const char* field, DicomSet changed) {
        add(std::string("SEG ") + field, read(seg), read(changed));
    };
    differ("SegmentationType", DicomSet(seg).text(0x00620001, "CS", "LABELMAP"));
    differ("MaximumFractionalValue", DicomSet(seg).number(0x0062000E, 90));
    differ("SegmentLabel",
           DicomSet(seg).sequence(0x00620002, {DicomSet().number(0x00620004, 1).text(0x00620005, "LO", "b")}));
    differ("ReferencedSegmentNumber", DicomSet(seg).sequence(0x00620002, {DicomSet().number(0x00620004, 2)}));
    differ("SegmentNumber", DicomSet(seg)
                                .sequence(0x00620002, {DicomSet().number(0x00620004, 3).text(0x00620005, "LO", "a")})
                                .sequence(0x52009230, {position("0\\0\\0", 3), position("0\\0\\2", 3)}));
    differ("ImageOrientationPatient", DicomSet(seg).sequence(0x52009229, {shared("1", "1", "0\\1\\0\\-1\\0\\0")}));
    differ("PixelSpacing", DicomSet(seg).sequence(0x52009229, {shared("1", "1", "1\\0\\0\\0\\1\\0", "1\\2")}));
    differ("SegmentsOverlap", DicomSet(seg).text(0x00620013, "CS", "YES"));
    differ("FrameOfReferenceUID", DicomSet(seg).text(0x00200052, "UI", "7.7"));
    differ("SegmentAlgorithmType",
           DicomSet(seg).sequence(0x00620002, {DicomSet().number(0x00620004, 1).text(0x00620005, "LO", "a")}));
    differ("SpacingBetweenSlices", DicomSet(seg).sequence(0x52009229, {shared("2", "1")}));
    differ("SliceThickness", DicomSet(seg).sequence(0x52009229, {shared("1", "9")}));
    differ("ImagePositionPatient", DicomSet(seg).sequence(0x52009230, {position("0\\0\\0"), position("0\\0\\3")}));
    const auto contours = [&](const char* type, const std::string& points, const char* number, const char* name) {
        return DicomSet()
            .text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.481.3")
            .sequence(0x30060020, {item(0x30060022, "IS", "1").text(0x30060026, "LO", name)})
            .sequence(0x30060039,
                      {item(0x30060084, "IS", number)
                           .text(0x3006002A, "IS", "255\\0\\0")
                           .sequence(0x30060040, {item(0x30060042, "CS", type).text(0x30060050, "DS", points)})});
    };
    const std::string square = "0\\0\\1\\3\\0\\1\\3\\3\\1";
    const DicomSet plain = contours("CLOSED_PLANAR", square, "1", "a");
    const auto change = [&](const char* field, const DicomSet& changed) {
        add(std::string("RTSTRUCT ") + field, read(plain), read(changed));
    };
    change("ROIName", contours("CLOSED_PLANAR", square, "1", "b"));
    change("ReferencedROINumber", contours("CLOSED_PLANAR", square, "2", "a"));
    change("ContourGeometricType", contours("OPEN_PLANAR", square, "1", "a"));
    change("ContourData", contours("CLOSED_PLANAR", "0\\0\\0" + square.substr(5), "1", "a"));
    const auto numbered = [&](const char* number) {
        return DicomSet(contours("CLOSED_PLANAR", square, number, "a"))
            .sequence(0x30060020, {item(0x30060022, "IS", number).text(0x30060026, "LO", "a")});
    };
    change("ROINumber", numbered("5"));
    change("NumberOfContourPoints",
           DicomSet(plain).sequence(0x30060039, {item(0x30060084, "IS", "1")
                                                     .sequence(0x30060040, {item(0x30060042, "CS", "CLOSED_PLANAR")
                                                                                .text(0x30060050, "DS", square)
                                                                                .text(0x30060046, "IS", "4")})}));
    change("ReferencedFrameOfReferenceUID",
           DicomSet(plain).sequence(
               0x30060020, {item(0x30060022, "IS", "1").text(0x30060024, "UI", "7.7").text(0x30060026, "LO", "a")}));
    DicomSet titled = contours("CLOSED_PLANAR", square, "1", "a");
    titled.text(0x30060002, "SH", "a set");
    change("StructureSetLabel", titled);
}

void Fields::vtk() {
    const std::string legacy = "# vtk DataFile Version 3.0\n m\nASCII\nDATASET POLYDATA\nFIELD f 1\nSPACE 1 1 string\n"
                               "none\nPOINTS 4 float\n1 0 0 2 0 0 1 1 0\n2 1 0\nPOLYGONS 1 4\n3 0 1 2\n";
    const auto differ = [&](const char* field, const std::string& from, const std::string& to) {
        add(std::string("VTK ") + field, mesh("m.vtk", legacy), mesh("m.vtk", with(legacy, from, to)));
    };
    differ("SPACE=RAS", " m", " SPACE=RAS");
    add("VTK SPACE=LPS", mesh("m.vtk", with(legacy, " m", "SPACE=RAS")),
        mesh("m.vtk", with(legacy, " m", " SPACE=LPS")));
    differ("SPACE", "none", "RAS");
    differ("POINTS", "1 0 0 2", "3 0 0 2");
    differ("POLYGONS", "3 0 1 2", "3 0 2 1");
    differ("TRIANGLE_STRIPS", "POLYGONS", "TRIANGLE_STRIPS 1 4\n3 1 2 3\nPOLYGONS");
    differ("OFFSETS", "1 4\n3 0 1 2", "2 3\nOFFSETS vtktypeint64\n0 3\nCONNECTIVITY vtktypeint64\n0 1 3");
    differ("LINES", "POLYGONS", "LINES 1 3\n2 0 1\nPOLYGONS");
    differ("VERTICES", "POLYGONS", "VERTICES 1 2\n1 0\nPOLYGONS");
    differ("POINT_DATA", "3 0 1 2\n", "3 0 1 2\nPOINT_DATA 4\nSCALARS s float\nLOOKUP_TABLE default\n1 2 3 4\n");
    differ("DATASET", "POLYDATA", "UNSTRUCTURED_GRID");
    const std::string xml =
        R"(<VTKFile type="PolyData" byte_order="LittleEndian"><PolyData><Piece NumberOfPoints="3" NumberOfPolys="1">)"
        R"(<Points><DataArray type="Float64" NumberOfComponents="3" format="ascii">1 0 0 2 0 0 1 1 0</DataArray></Points>)"
        R"(<Polys><DataArray type="Int32" Name="connectivity" format="binary">DAAAAAAAAAABAAAAAgAAAA==</DataArray>)"
        R"(<DataArray type="Int32" Name="offsets" format="ascii">3</DataArray></Polys></Piece></PolyData></VTKFile>)";
    ASSERT_TRUE(mesh("m.vtp", xml).isRead) << mesh("m.vtp", xml).content;
    const auto change = [&](const char* field, const std::string& from, const std::string& to) {
        add(std::string(".vtp ") + field, mesh("m.vtp", xml), mesh("m.vtp", with(xml, from, to)));
    };
    change("byte_order", "Little", "Big");
    change("header_type", "<VTKFile ", "<VTKFile header_type=\"UInt64\" ");
    change("compressor", "<VTKFile ", "<VTKFile compressor=\"vtkLZ4DataCompressor\" ");
    change("SPACE", "<PolyData>",
           "<PolyData><FieldData><Array type=\"String\" Name=\"SPACE\" format=\"ascii\">"
           "82 65 83 0</Array></FieldData>");
    change("connectivity", "AAAAAAABAAAAAg", "AAAAAAACAAAAAQ");
    change("NumberOfComponents", "NumberOfComponents=\"3\"", "NumberOfComponents=\"2\"");
    const std::string strip = R"(<Strips><DataArray type="Int32" Name="connectivity" format="ascii">0 2 1</DataArray>)"
                              R"(<DataArray type="Int32" Name="offsets" format="ascii">3</DataArray></Strips>)";
    change("Strips", " NumberOfPolys=\"1\"><Points>",
           " NumberOfPolys=\"1\" NumberOfStrips=\"1\">" + strip + "<Points>");
    const std::string line = R"(<Lines><DataArray type="Int32" Name="connectivity" format="ascii">0 2</DataArray>)"
                             R"(<DataArray type="Int32" Name="offsets" format="ascii">2</DataArray></Lines>)";
    change("Lines", " NumberOfPolys=\"1\"><Points>", " NumberOfPolys=\"1\" NumberOfLines=\"1\">" + line + "<Points>");
    change("PointData", "<Points>",
           "<PointData><DataArray type=\"Int8\" Name=\"s\" format=\"ascii\">1 2 3</DataArray>"
           "</PointData><Points>");
}

void Fields::gltf() {
    std::string corners;
    for (const float number : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) {
        append(corners, number);
    }
    folder_.write("b.bin", corners);
    const std::string plain =
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]},{"nodes":[1]}],"nodes":[{"mesh":0},{"mesh":0,
        "scale":[2,2,2]}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"componentType":5126,
        "count":3,"type":"VEC3","bufferView":0}],"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,
        "uri":"b.bin"}]})";
    const auto differ = [&](const std::string& field, const std::string& changed) {
        add("glTF " + field, mesh("m.gltf", plain), mesh("m.gltf", changed));
    };
    const auto node = [&](const std::string& member) {
        return with(plain, R"([{"mesh":0})", R"([{"mesh":0,)" + member + "}");
    };
    differ("matrix", node(R"("matrix":[1,0,0,0,0,1,0,0,0,0,1,0,5,0,0,1])"));
    differ("translation", node(R"("translation":[5,0,0])"));
    differ("rotation", node(R"("rotation":[1,0,0,0])"));
    differ("scale", node(R"("scale":[2,1,1])"));
    differ("scene", with(plain, R"("scene":0)", R"("scene":1)"));
    const std::string two = with(plain, R"("nodes":[0]})", R"("nodes":[0,1]})");
    add("glTF KHR_node_visibility", mesh("m.gltf", two),
        mesh("m.gltf", with(two, R"("scale")", R"("extensions":{"KHR_node_visibility":{"visible":false}},"scale")")));
    differ("EXT_mesh_gpu_instancing", node(R"("extensions":{"EXT_mesh_gpu_instancing":{}})"));
    differ("animations", with(plain, R"("asset")", R"("animations":[{"channels":[],"samplers":[]}],"asset")"));
}

void Fields::text() {
    const auto names = [&](const std::string& text) {
        const auto read = io::readLabelNames(folder_.write("names.txt", text));
        return read.ok() ? Outcome{true, read->front().name, {}} : Outcome{false, read.error().text, {}};
    };
    add("label names \"name\"", names("1 9 9 9 1 1 1 \"a\"\n"), names("1 9 9 9 1 1 1 \"a b\"\n"));
    add("label names R G B A", names("1 a 9 9 9 0\n"), names("1 a 7 9 9 0\n"));
    const auto opacity = [&](const char* name, const std::string& text) {
        const auto path = folder_.write(name, text);
        const auto read = io::readTransferFunction(path);
        std::ostringstream out;
        for (std::size_t i = 0; read.ok() && i < read->size(); ++i) {
            out << (*read)[i].value << ' ' << (*read)[i].opacity << ' ';
        }
        return Outcome{read.ok(), out.str(), {}};
    };
    const std::string map = R"([{"ColorSpace":"RGB","RGBPoints":[0,0,0,0],"Points":[0,0,0.5,0,9,1,0.5,0]}])";
    const auto paraView = [&](const char* field, const char* from, const char* to) {
        add(std::string("ParaView map ") + field, opacity("m.json", map), opacity("m.json", with(map, from, to)));
    };
    paraView("Points", "9,1,", "9,0.5,");
    paraView("midpoint", "0.5,0,9", "0.4,0,9");
    paraView("sharpness", "0.5,0,9", "0.5,1,9");
    paraView("UseLogScale", "\"RGB\"", "\"RGB\",\"UseLogScale\":1");
    paraView("ColorSpace", "RGB\"", "Lab\"");
    const std::string property = "1\n1\n1\n0\n0\n1\n4 0 0 9 1\n4 0 1 255 1\n4 0 0 0 0\n";
    const auto slicer = [&](const char* field, const char* from, const char* to) {
        add(std::string(".vp ") + field, opacity("p.vp", property), opacity("p.vp", with(property, from, to)));
    };
    slicer("scalar opacity", "9 1", "8 1");
    slicer("gradient opacity", "255 1", "255 0");
    slicer("shade", "1\n1\n1", "1\n0\n1");
    const auto points = [&](const char* name, const std::string& text) {
        const auto read = io::readPoints(folder_.write(name, text));
        std::ostringstream out;
        if (read.ok()) {
            write(out, read->front().position);
        }
        return Outcome{read.ok(), out.str(), {}};
    };
    const std::string list = "# CoordinateSystem = LPS\n# columns = id,x,y,z,label\na,1,2,3,b\n";
    add(".fcsv CoordinateSystem", points("l.fcsv", list), points("l.fcsv", with(list, "LPS", "RAS")));
    add(".fcsv columns", points("l.fcsv", list), points("l.fcsv", with(list, "x,y", "y,x")));
    const std::string markups =
        R"({"markups":[{"type":"Fiducial","coordinateSystem":"LPS","coordinateUnits":"mm","controlPoints":[)"
        R"({"label":"a","position":[1,2,3],"positionStatus":"defined"}]}]})";
    const auto markup = [&](const char* field, const char* from, const char* to) {
        add(std::string(".mrk.json ") + field, points("l.mrk.json", markups),
            points("l.mrk.json", with(markups, from, to)));
    };
    markup("coordinateSystem", "LPS", "RAS");
    markup("coordinateUnits", "\"mm\"", "\"m\"");
    markup("positionStatus", "\"defined\"", "\"missing\"");
    markup("type", "Fiducial", "Line");
    const auto poses = [&](const std::string& text) {
        const auto read = io::readPoses(folder_.write("poses.txt", text));
        std::ostringstream out;
        if (read.ok()) {
            write(out, read->front());
        }
        return Outcome{read.ok(), out.str(), {}};
    };
    const std::string itk = "Transform: AffineTransform_double_3_3\nParameters: 0 1 0 -1 0 0 0 0 1 0 0 0\n"
                            "FixedParameters: 0 0 0\n";
    add("poses Transform", poses(itk), poses(with(itk, "Affine", "Euler3D")));
    add("poses Parameters", poses(itk), poses(with(itk, "0 0 0\n", "5 0 0\n")));
    add("poses FixedParameters", poses(itk), poses(with(itk, "FixedParameters: 0", "FixedParameters: 5")));
}

/// "format field" to the first words of its effect.
std::map<std::string, std::string> tablesOf(const std::string& manual) {
    std::map<std::string, std::string> effects;
    std::istringstream lines(manual);
    for (std::string line; std::getline(lines, line);) {
        const std::size_t first = line.find(" | `");
        const std::size_t second = line.find("` | ");
        if (!line.starts_with("| ") || first == std::string::npos || second == std::string::npos) {
            continue;
        }
        const std::string effect = line.substr(second + 4);
        for (std::size_t at = first + 3; at < second; at = line.find('`', line.find('`', at + 1) + 1)) {
            const std::string field = line.substr(at + 1, line.find('`', at + 1) - at - 1);
            for (const char* word : {"used", "noted", "refused", "passed over"}) {
                if (effect.starts_with(word)) {
                    effects[line.substr(2, first - 2) + " " + field] = word;
                }
            }
        }
    }
    return effects;
}

TEST(Fields, DoWhatTheManualSays) {
    const std::map<std::string, std::string> said = tablesOf(contentOf(VOXTACT_TEST_FIELDS));
    ASSERT_GT(said.size(), 90U);
    Fields fields;
    fields.nifti();
    fields.nrrd();
    fields.metaImage();
    fields.dicom();
    fields.labels();
    fields.meshes();
    fields.vtk();
    fields.gltf();
    fields.text();
    for (const auto& [field, effect] : said) {
        const auto seen = fields.effects().find(field);
        ASSERT_NE(seen, fields.effects().end()) << field << ": no case";
        EXPECT_EQ(seen->second, effect) << field;
    }
    for (const auto& [field, effect] : fields.effects()) {
        EXPECT_TRUE(said.contains(field)) << field << ": not in the manual (" << effect << ")";
    }
}

} // namespace
} // namespace voxtact::test
