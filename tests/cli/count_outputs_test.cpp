// SPDX-License-Identifier: MIT
// What voxtact count says in addition to the counts: columns, files, names. By the host, against the library itself.
#include "cli_fixture.h"
#include "support/host_meters.h"
#include "voxtact/cpu.h"
#include "voxtact/io.h"
#include "voxtact/samples.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <map>
#include <sstream>

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;
using testing::StartsWith;

using Fields = std::vector<std::string>;
using Json = nlohmann::json;

/// Three poses: through the head, a little aside, and far away.
constexpr const char* kPoses = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n"
                               "1 0 0 40 0 1 0 10 0 0 1 20 0 0 0 1\n"
                               "1 0 0 0 0 1 0 0 0 0 1 5000 0 0 0 1\n";
constexpr std::size_t kColumns = 8; ///< that every table has
constexpr double kRounding = 1e-6;  ///< of what is written

class DetectOutputsTest : public CliTest {
  protected:
    DetectOutputsTest() {
        writeText(path("poses.txt"), kPoses);
        output({"make", "volume", "builtin:head:18", map()});
    }
    [[nodiscard]] std::string map() const { return path("map.nii.gz"); }
    [[nodiscard]] Arguments detect(const Arguments& more) const {
        Arguments all{"count",   "--volume",        "builtin:head:30", "--mesh", "builtin:scalpel:500",
                      "--poses", path("poses.txt"), "--method",        "cpu"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// Rows of fields without quotes, without the header.
    static std::vector<Fields> rowsOf(const std::string& csv) {
        std::vector<Fields> rows;
        for (const std::string& line : linesOf(csv)) {
            rows.push_back(fieldsOf(line));
        }
        rows.erase(rows.begin());
        return rows;
    }
    /// The same scene answered by the library.
    [[nodiscard]] BatchAnswer answer(Projection projection) const {
        const VolumeData volumeData = *makeBuiltinVolume("head:30");
        const cpu::Volume volume = *cpu::Volume::create(volumeData.view());
        const cpu::Mesh mesh = *cpu::Mesh::create(makeBuiltinMesh("scalpel:500")->view());
        const std::vector<ControlPoint> points{{0, 0}, {255, 1}};
        const cpu::TransferFunction table = *cpu::TransferFunction::create({points, {0, 255}, kDefaultTableSize});
        const std::vector<Mat4> poses = *io::readPoses(path("poses.txt"));
        const LabelData labels = *makeLabels(io::readVolume(map())->view());
        cpu::Detector detector = *cpu::Detector::create(
            {.projection = projection,
             .outputs = {.triangles = true, .contacts = true, .bounds = true, .labels = true, .maxDepth = 20}});
        const cpu::BatchItem item{&mesh, &volume, &table, poses, &labels};
        return *detector.detect({{&item, 1}, {framingCamera(volumeData.grid, 512, 512), 512, 512}});
    }
    static void expectContact(const Fields& row, const BatchAnswer& expected, const Contact& contact) {
        EXPECT_EQ(row[0], std::to_string(expected.pairs[contact.pair].pose));
        EXPECT_EQ(row[1], std::to_string(contact.triangle));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(std::stod(row[2 + axis]), contact.position[axis], kRounding);
            EXPECT_NEAR(std::stod(row[5 + axis]), contact.normal[axis], kRounding);
        }
        EXPECT_NEAR(std::stod(row[8]), contact.depth, kRounding);
        EXPECT_EQ(std::stod(row[9]), contact.value);
        EXPECT_NEAR(std::stod(row[10]), contact.opacity, kRounding);
        EXPECT_EQ(row[11], std::to_string(contact.label));
    }
};

TEST_F(DetectOutputsTest, EveryProjectionSaysWhatTheLibrarySays) {
    for (const Projection projection : projections()) {
        SCOPED_TRACE(toString(projection));
        const BatchAnswer expected = answer(projection);
        const auto rows = rowsOf(
            output(detect({"--projection", toString(projection), "--triangles", path("t.csv"), "--contacts",
                           path("c.csv"), "--max-depth", "20", "--labels", map(), "--label-counts", "--bounds"})));
        ASSERT_THAT(rows, SizeIs(3));
        for (std::size_t pair = 0; pair < 3; ++pair) {
            EXPECT_EQ(rows[pair].at(4), std::to_string(expected.pairs[pair].count));
            EXPECT_EQ(rows[pair].at(7), toString(projection));
            const auto touched = std::count_if(expected.triangles.begin(), expected.triangles.end(),
                                               [&](const TouchedTriangle& entry) { return entry.pair == pair; });
            EXPECT_EQ(rows[pair].at(8), std::to_string(touched));
            EXPECT_EQ(rows[pair].at(9), rows[pair].at(4)) << "a contact for each survivor";
        }
        EXPECT_NE(rows[0].at(4), "0");
        EXPECT_EQ(rows[2].at(4), "0");
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(std::stod(rows[0].at(12 + axis)), expected.bounds[0]->lo[axis], kRounding);
            EXPECT_NEAR(std::stod(rows[0].at(15 + axis)), expected.bounds[0]->hi[axis], kRounding);
        }
        const auto triangles = rowsOf(readText(path("t.csv")));
        ASSERT_EQ(triangles.size(), expected.triangles.size());
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const TouchedTriangle& entry = expected.triangles[i];
            EXPECT_THAT(triangles[i], ElementsAre(std::to_string(entry.pair), std::to_string(entry.triangle),
                                                  std::to_string(entry.count)));
        }
        const auto contacts = rowsOf(readText(path("c.csv")));
        ASSERT_EQ(contacts.size(), expected.contacts.size());
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            expectContact(contacts[i], expected, expected.contacts[i]);
        }
    }
}

TEST_F(DetectOutputsTest, ColumnsComeInTheirOrder) {
    const std::string first = "pose,mesh,volume,touch,count,count_exact,method,projection";
    const auto header = [&](const Arguments& more) { return linesOf(output(detect(more))).at(0); };
    const Arguments all{"--label-counts", "--bounds",    "--labels",    map(),     "--contacts",
                        path("c.ply"),    "--triangles", path("t.csv"), "--timing"};
    EXPECT_EQ(header({}), first);
    EXPECT_EQ(header(all),
              first + ",triangles,contacts,depth,labels,min_x,min_y,min_z,max_x,max_y,max_z,gpu_ms,wall_ms");
    EXPECT_EQ(header({"--bounds"}), first + ",min_x,min_y,min_z,max_x,max_y,max_z");
    EXPECT_EQ(header({"--labels", map(), "--label-counts"}), first + ",labels");
    EXPECT_EQ(linesOf(readText(path("t.csv"))).at(0), "pose,triangle,count");
}

TEST_F(DetectOutputsTest, WhatIsNotThereIsEmpty) {
    const Arguments all{"--bounds",   "--labels",    map(),         "--label-counts",
                        "--contacts", path("c.csv"), "--triangles", path("t.csv")};
    EXPECT_THAT(linesOf(output(detect(all))).at(3), testing::EndsWith(",0,0,1,cpu,certified,0,0,,,,,,,,"));
    Arguments json = detect(all);
    json.insert(json.end(), {"--format", "json"});
    const Json row = Json::parse(output(json)).at("rows").at(2);
    EXPECT_EQ(row.at("labels"), Json::array());
    EXPECT_TRUE(row.at("depth").is_null());
    EXPECT_TRUE(row.at("min_x").is_null());
    EXPECT_EQ(row.at("touch"), "no");
    // A run without any contact still makes its files.
    output(detect({"--opacity", "0:0", "--contacts", path("none.ply"), "--triangles", path("none.csv")}),
           {.note = "nothing touches"});
    EXPECT_THAT(readText(path("none.ply")), AllOf(HasSubstr("element vertex 0\n"), testing::EndsWith("end_header\n")));
    EXPECT_EQ(readText(path("none.csv")), "pose,triangle,count\n");
}

TEST_F(DetectOutputsTest, TextSaysYesAndNo) {
    const auto lines = linesOf(output(detect({"--format", "text"})));
    ASSERT_THAT(lines, SizeIs(4));
    EXPECT_THAT(lines[1], HasSubstr("  yes  "));
    EXPECT_THAT(lines[3], HasSubstr("  no "));
}

TEST_F(DetectOutputsTest, PossibleIsTwo) {
    // Opaque up to the centre of voxel 3, transparent from that of voxel 4 on: half way between them the opacity is
    // the threshold. A triangle there can be neither proven nor excluded, a hundredth of a voxel beside it can.
    writeNifti(path("half.nii"), {});
    std::string voxels;
    for (int i = 0; i < 512; ++i) {
        voxels += static_cast<char>(i % 8 < 4 ? 2 : 0);
    }
    writeText(path("half.nii"), readText(path("half.nii")).substr(0, 352) + voxels);
    writeText(path("t.obj"), "v 0 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n");
    const Arguments arguments{
        "count",    "--volume", path("half.nii"), "--mesh",  path("t.obj"), "--poses", path("at.txt"),
        "--method", "cpu",      "--opacity",      "0:0,2:1", "--tf-domain", "0:2",     "--opacity-threshold",
        "0.5"};
    // NIfTI's x runs to the right, ours to the left: voxel i is at x = -i.
    writeText(path("at.txt"), "1 0 0 -3.49 0 1 0 -3 0 0 1 3 0 0 0 1\n"
                              "1 0 0 -3.5 0 1 0 -3 0 0 1 3 0 0 0 1\n"
                              "1 0 0 -3.51 0 1 0 -3 0 0 1 3 0 0 0 1\n");
    const auto rows = rowsOf(output(arguments));
    EXPECT_EQ(rows.at(0).at(3) + rows.at(1).at(3) + rows.at(2).at(3), "120");
    EXPECT_EQ(rows.at(1).at(4) + rows.at(1).at(5), "00") << "at least none";
    Arguments text = arguments;
    text.insert(text.end(), {"--format", "text"});
    EXPECT_THAT(linesOf(output(text)).at(2), HasSubstr("  undecided  "));
}

TEST_F(DetectOutputsTest, LabelsHaveNames) {
    const LabelData labels = *makeLabels(io::readVolume(map())->view());
    const BatchAnswer expected = answer(Projection::Certified);
    std::vector<LabelCount> found;
    for (const LabelCount& entry : expected.labels) {
        if (entry.pair == 0 && entry.label != 0) {
            found.push_back(entry);
        }
    }
    ASSERT_GT(found.size(), 1U);
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.count > b.count; });
    const auto column = [&](const Arguments& more) {
        Arguments all = detect({"--labels", map(), "--label-counts", "--format", "json"});
        all.insert(all.end(), more.begin(), more.end());
        return Json::parse(output(all)).at("rows").at(0).at("labels");
    };
    Json numbers = Json::array();
    std::string csv;
    for (const LabelCount& entry : found) {
        numbers.push_back({{"label", entry.label}, {"name", std::to_string(entry.label)}, {"count", entry.count}});
        csv += (csv.empty() ? "" : ";") + std::to_string(entry.label) + ":" + std::to_string(entry.count);
    }
    EXPECT_EQ(column({}), numbers) << "without names, numbers";
    EXPECT_EQ(rowsOf(output(detect({"--labels", map(), "--label-counts"}))).at(0).at(kColumns), csv);

    const std::string first = std::to_string(found[0].label);
    writeText(path("map.nii.txt"), first + " Skull 2001\r\n");
    EXPECT_EQ(column({}).at(0).at("name"), "Skull") << "the file beside the map";
    EXPECT_EQ(column({}).at(1).at("name"), std::to_string(found[1].label));
    writeText(path("names.txt"), first + " a;b,\"c\":d\n");
    EXPECT_EQ(column({"--label-names", path("names.txt")}).at(0).at("name"), "a;b,\"c\":d");
    EXPECT_THAT(output(detect({"--labels", map(), "--label-names", path("names.txt"), "--label-counts"})),
                HasSubstr(R"(,"""a;b,""""c"""":d"":)" + std::to_string(found[0].count) + ";"));
    output(detect({"--labels", map(), "--contacts", path("c.csv")}));
    EXPECT_THAT(linesOf(readText(path("c.csv"))).at(0), testing::EndsWith(",label,label_name"));
    EXPECT_THAT(readText(path("c.csv")), HasSubstr("," + first + ",Skull\n"));
}

TEST_F(DetectOutputsTest, BackgroundIsSaidWhereThereIsNothingElse) {
    writeNifti(path("zero.nii"), {});
    const auto rows = rowsOf(output(detect({"--labels", path("zero.nii"), "--label-counts"})));
    EXPECT_EQ(rows.at(0).at(kColumns), "0:" + rows.at(0).at(4));
}

TEST_F(DetectOutputsTest, LabelMapsAndNamesThatAreNone) {
    output({"make", "volume", "builtin:shells:16", path("fractions.nrrd")});
    writeText(path("bad.txt"), "1 a\nx b\n");
    const auto bad = [&](const Arguments& more) {
        Arguments all = detect(more);
        all.insert(all.end(), {"--output", path("out.csv"), "--contacts", path("c.csv")});
        return refused(1, all);
    };
    EXPECT_THAT(bad({"--labels", path("none.nii")}), HasSubstr(path("none.nii")));
    EXPECT_THAT(bad({"--labels", path("fractions.nrrd")}),
                AllOf(HasSubstr(path("fractions.nrrd")), HasSubstr("as a label map")));
    EXPECT_THAT(bad({"--labels", map(), "--label-names", path("bad.txt")}),
                AllOf(HasSubstr(path("bad.txt")), HasSubstr("line 2")));
    EXPECT_THAT(bad({"--labels", map(), "--label-names", path("none.txt")}), HasSubstr(path("none.txt")));
    EXPECT_FALSE(std::filesystem::exists(path("out.csv")) || std::filesystem::exists(path("c.csv")));
    // What merely lies beside the map is no fault of the arguments.
    writeText(path("map.nii.txt"), "notes on this map\n");
    const Ran ran = run(detect({"--labels", map(), "--label-counts"}));
    EXPECT_EQ(ran.status, 0);
    EXPECT_THAT(ran.err, AllOf(StartsWith("voxtact: note: "), HasSubstr("map.nii.txt"), HasSubstr("--label-names")));
}

TEST_F(DetectOutputsTest, SeveralMeshesAndVolumesAreNamedAtTheEnd) {
    const Arguments several{"--mesh", "builtin:ellipsoid:500", "--volume",    "builtin:ct:32", "--labels",
                            map(),    "--triangles",           path("t.csv"), "--contacts",    path("c.csv")};
    const std::string all = output(detect(several));
    for (const char* batch : {"1", "5"}) {
        Arguments cut = detect(several);
        cut.insert(cut.end(), {"--batch", batch, "--triangles", path("cut.csv"), "--contacts", path("cutc.csv")});
        cut.erase(std::find(cut.begin(), cut.end(), path("t.csv")) - 1,
                  std::find(cut.begin(), cut.end(), path("t.csv")) + 1);
        cut.erase(std::find(cut.begin(), cut.end(), path("c.csv")) - 1,
                  std::find(cut.begin(), cut.end(), path("c.csv")) + 1);
        EXPECT_EQ(output(cut), all);
        EXPECT_EQ(readText(path("cut.csv")), readText(path("t.csv")));
        EXPECT_EQ(readText(path("cutc.csv")), readText(path("c.csv")));
    }
    EXPECT_EQ(linesOf(readText(path("t.csv"))).at(0), "pose,triangle,count,mesh,volume");
    EXPECT_EQ(linesOf(readText(path("c.csv"))).at(0),
              "pose,triangle,x,y,z,nx,ny,nz,depth,value,opacity,label,mesh,volume");
    const auto rows = rowsOf(all);
    ASSERT_THAT(rows, SizeIs(12));
    for (const Fields& row : rows) {
        const auto lines = rowsOf(readText(path("c.csv")));
        EXPECT_EQ(row.at(4), std::to_string(std::count_if(lines.begin(), lines.end(), [&](const Fields& contact) {
                      return contact[0] == row[0] && contact[12] == row[1] && contact[13] == row[2];
                  })));
    }
}

/// The vertices of a binary PLY file, as its header says: the numbers of each by the names of its properties.
std::vector<std::map<std::string, double>> verticesOf(const std::string& ply) {
    std::vector<std::pair<std::string, std::string>> properties; // type and name
    std::size_t count = 0;
    std::istringstream header(ply.substr(0, ply.find("end_header\n")));
    for (std::string line; std::getline(header, line);) {
        std::istringstream words(line);
        std::string word;
        std::string type;
        std::string name;
        words >> word >> type >> name;
        if (word == "element") {
            EXPECT_EQ(type, "vertex") << "points only";
            count = std::stoul(name);
        } else if (word == "property") {
            properties.emplace_back(type, name);
        }
    }
    EXPECT_THAT(ply, StartsWith("ply\nformat binary_little_endian 1.0\n"));
    std::size_t at = ply.find("end_header\n") + std::strlen("end_header\n");
    const auto take = [&](auto number) {
        std::memcpy(&number, ply.substr(at, sizeof number).data(), sizeof number);
        at += sizeof number;
        return static_cast<double>(number);
    };
    std::vector<std::map<std::string, double>> vertices(count);
    for (auto& vertex : vertices) {
        for (const auto& [type, name] : properties) {
            vertex[name] = type == "float"   ? take(float{})
                           : type == "uchar" ? take(std::uint8_t{})
                           : type == "int"   ? take(std::int32_t{})
                                             : take(std::uint32_t{});
        }
    }
    EXPECT_EQ(at, ply.size());
    return vertices;
}

TEST_F(DetectOutputsTest, PlyIsWhatItsHeaderSays) {
    output(detect({"--contacts", path("c.ply"), "--labels", map()}));
    output(detect({"--contacts", path("c.csv"), "--labels", map()}));
    const auto rows = rowsOf(readText(path("c.csv")));
    const std::string ply = readText(path("c.ply"));
    EXPECT_THAT(ply, HasSubstr("comment colour: depth from 0 (dark violet) to 10 mm"));
    const auto vertices = verticesOf(ply);
    ASSERT_EQ(vertices.size(), rows.size());
    struct Column {
        const char* name;
        std::size_t number;
        double tolerance;
    };
    const std::vector<Column> written{{"x", 2, 2e-5},        {"y", 3, 2e-5},   {"z", 4, 2e-5},     {"nx", 5, 2e-6},
                                      {"ny", 6, 2e-6},       {"nz", 7, 2e-6},  {"depth", 8, 2e-6}, {"value", 9, 1e-4},
                                      {"opacity", 10, 2e-6}, {"label", 11, 0}, {"pose", 0, 0},     {"triangle", 1, 0}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (const Column& column : written) {
            EXPECT_NEAR(vertices[i].at(column.name), std::stod(rows[i].at(column.number)), column.tolerance)
                << column.name << " of " << i;
        }
        EXPECT_EQ(vertices[i].at("mesh"), 0);
        EXPECT_EQ(vertices[i].at("volume"), 0);
        for (const char* channel : {"red", "green", "blue"}) {
            EXPECT_TRUE(vertices[i].contains(channel));
        }
    }
}

TEST_F(DetectOutputsTest, ColoursGoFromVioletToYellow) {
    output(detect({"--contacts", path("c.ply"), "--max-depth", "3"}));
    output(detect({"--contacts", path("c.csv"), "--max-depth", "3"}));
    const auto vertices = verticesOf(readText(path("c.ply")));
    const auto rows = rowsOf(readText(path("c.csv")));
    ASSERT_EQ(vertices.size(), rows.size());
    bool deepest = false;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (std::stod(rows[i].at(8)) == 3) {
            EXPECT_EQ(vertices[i].at("red"), 253);
            EXPECT_EQ(vertices[i].at("green"), 231);
            EXPECT_EQ(vertices[i].at("blue"), 37);
            deepest = true;
        } else {
            // Between the colours of its eighth.
            EXPECT_LE(vertices[i].at("green"), 231);
            EXPECT_GE(vertices[i].at("green"), 1);
        }
    }
    EXPECT_TRUE(deepest);
}

TEST_F(DetectOutputsTest, AListThatIsCutSaysSo) {
    const auto whole = rowsOf(output(detect({"--contacts", path("c.csv")})));
    for (const char* batch : {"1", "100"}) {
        const Ran ran = run(detect({"--contacts", path("cut.csv"), "--max-contacts", "7", "--batch", batch}));
        EXPECT_EQ(ran.status, 0);
        const std::uint64_t found = std::stoull(whole[0].at(kColumns)) + std::stoull(whole[1].at(kColumns));
        EXPECT_THAT(ran.err, AllOf(StartsWith("voxtact: note: "),
                                   HasSubstr("7 of " + std::to_string(found) + " contacts are kept")));
        EXPECT_THAT(linesOf(readText(path("cut.csv"))), SizeIs(8));
        for (std::size_t row = 0; row < whole.size(); ++row) {
            EXPECT_EQ(rowsOf(ran.out)[row].at(kColumns), whole[row].at(kColumns)) << "the column has them all";
        }
    }
}

TEST_F(DetectOutputsTest, AllFilesOrNone) {
    writeText(path("t.csv"), "as it was");
    writeText(path("c.ply"), "as it was");
    const std::size_t files = filesInFolder();
    const Arguments both = detect({"--triangles", path("t.csv"), "--contacts", path("c.ply")});
    const auto with = [&](const Arguments& more) {
        Arguments all = both;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    EXPECT_THAT(refused(1, with({"--output", "/dev/full"})), HasSubstr("/dev/full"));
    EXPECT_EQ(run(both, {.output = "/dev/full"}).status, 1);
    EXPECT_EQ(run(both, {.closedPipe = true}).status, 1);
    EXPECT_THAT(refused(1, with({"--output", path("no/such.csv")})), HasSubstr("does not exist"));
    EXPECT_THAT(refused(1, with({"--volume", path("no.nii")})), HasSubstr("no.nii"));
    EXPECT_THAT(refused(1, detect({"--contacts", path("c.ply"), "--triangles", "/dev/full", "--output", path("out")})),
                HasSubstr("/dev/full"));
    EXPECT_EQ(readText(path("t.csv")), "as it was");
    EXPECT_EQ(readText(path("c.ply")), "as it was");
    EXPECT_EQ(filesInFolder(), files);
    output(both);
    EXPECT_THAT(readText(path("t.csv")), StartsWith("pose,triangle,count\n0,"));
    EXPECT_THAT(readText(path("c.ply")), StartsWith("ply\n"));
    EXPECT_EQ(filesInFolder(), files);
}

class DetectOutputsOnDeviceTest : public CliDeviceTest {
  protected:
    [[nodiscard]] Arguments outputs(const std::string& method, const Arguments& more = {}) const {
        Arguments all =
            detect({"--method", method, "--poses", path("poses.txt"), "--mesh", "builtin:ellipsoid:500", "--projection",
                    "view", "--filter", "exact", "--bounds", "--label-counts", "--labels", path("map.nii"),
                    "--triangles", path(method + ".csv"), "--contacts", path(method + "-c.csv")});
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    /// Without the method's name.
    static std::vector<Fields> rowsOf(const std::string& csv) {
        std::vector<Fields> rows;
        for (const std::string& line : linesOf(csv)) {
            rows.push_back(fieldsOf(line));
            rows.back().at(6).clear();
        }
        return rows;
    }
};

TEST_F(DetectOutputsOnDeviceTest, ComputeSaysWhatTheHostSays) {
    writeText(path("poses.txt"), kPoses);
    output({"make", "volume", "builtin:head:18", path("map.nii")});
    const auto host = rowsOf(output(outputs("cpu")));
    EXPECT_THAT(host, SizeIs(7));
    for (const char* batch : {"1", "4", "1024"}) {
        const auto device = rowsOf(output(outputs("compute", {"--batch", batch, "--validate"})));
        ASSERT_THAT(device, SizeIs(7));
        for (std::size_t row = 0; row < host.size(); ++row) {
            // Counts and labels are the same bit for bit; depths and bounds come from floats on the device.
            EXPECT_EQ(Fields(device[row].begin(), device[row].begin() + 10),
                      Fields(host[row].begin(), host[row].begin() + 10));
            ASSERT_GT(host[row].size(), 11U);
            EXPECT_EQ(device[row].at(11), host[row].at(11));
        }
        EXPECT_EQ(readText(path("compute.csv")), readText(path("cpu.csv")));
        EXPECT_EQ(linesOf(readText(path("compute-c.csv"))).size(), linesOf(readText(path("cpu-c.csv"))).size());
    }
}

TEST_F(DetectOutputsOnDeviceTest, EveryMethodHasThem) {
    writeText(path("poses.txt"), kPoses);
    output({"make", "volume", "builtin:head:18", path("map.nii")});
    const auto query = rowsOf(output(outputs("query", {"--validate"})));
    for (const char* method : {"atomic", "query-any"}) {
        const auto other = rowsOf(output(outputs(method, {"--validate", "--batch", "2"})));
        EXPECT_EQ(readText(path(std::string(method) + ".csv")), readText(path("query.csv")));
        EXPECT_EQ(readText(path(std::string(method) + "-c.csv")), readText(path("query-c.csv")));
        for (std::size_t row = 1; row < query.size(); ++row) {
            EXPECT_EQ(Fields(other[row].begin() + 8, other[row].end()),
                      Fields(query[row].begin() + 8, query[row].end()));
        }
    }
}

TEST_F(DetectOutputsOnDeviceTest, MoreContactsThanADeviceHasRoomFor) {
    EXPECT_THAT(refused(2, detect({"--contacts", path("c.csv"), "--max-contacts", "4294967295"})),
                AllOf(HasSubstr("--max-contacts: "), HasSubstr("maxStorageBufferRange")));
}

} // namespace
} // namespace voxtact::test
