// SPDX-License-Identifier: MIT
// Segmentations (SEG) and structure sets (RTSTRUCT) of DICOM: pydicom and numpy are the judges.
#include "../dicom/dicom_writer.h"

#include <cstdio>
#include <sstream>

namespace voxtact::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

struct JudgedLabels {
    std::string name;
    std::array<std::uint32_t, 3> size{};
    std::vector<std::int32_t> labels;
};

std::vector<JudgedLabels> askPydicom(const std::string& kind, const TemporaryFolder& folder) {
    const std::string command =
        "'" VOXTACT_TEST_PYTHON "' '" VOXTACT_TEST_DICOM "' " + kind + " '" + folder.path().string() + "'";
    FILE* const pipe = ::popen(command.c_str(), "r");
    std::string text;
    std::array<char, 4096> piece{};
    for (std::size_t got = 1; pipe != nullptr && got > 0;) {
        got = std::fread(piece.data(), 1, piece.size(), pipe);
        text.append(piece.data(), got);
    }
    EXPECT_EQ(pipe == nullptr ? -1 : ::pclose(pipe), 0)
        << VOXTACT_TEST_PYTHON " cannot import pydicom: install python3-pydicom";
    std::vector<JudgedLabels> all;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        JudgedLabels& one = all.emplace_back();
        words >> one.name >> one.size[0] >> one.size[1] >> one.size[2];
        for (std::int32_t label = 0; words >> label;) {
            one.labels.push_back(label);
        }
    }
    return all;
}

std::vector<std::int32_t> labelsIn(const io::LabelFile& file) {
    std::vector<std::int32_t> labels;
    for (const std::uint16_t index : file.labels.indices) {
        labels.push_back(file.labels.values[index]);
    }
    return labels;
}

std::string namesIn(const io::LabelFile& file) {
    std::string text;
    for (const io::LabelName& name : file.names) {
        text += std::to_string(name.label) + "=" + name.name + ";";
    }
    return text;
}

/// No part of a file is taken for all of it, and no damage breaks the reader.
void expectSound(const std::string& content, const io::VolumeReadOptions& options) {
    const TemporaryFolder folder;
    for (std::size_t length = 0; length < content.size(); ++length) {
        const auto file = io::readLabels(folder.write("f.dcm", content.substr(0, length)), options);
        EXPECT_TRUE(file.ok() || file.error().code != ErrorCode::Internal) << length;
    }
    for (std::size_t at = 128; at < content.size(); ++at) {
        std::string changed = content;
        changed[at] = std::array{'\0', '9', '\xFF'}[at % 3];
        const auto file = io::readLabels(folder.write("f.dcm", changed), options);
        EXPECT_TRUE(file.ok() || file.error().code != ErrorCode::Internal) << at;
    }
}

TEST(DicomSeg, IsReadAsPydicomReadsIt) {
    const TemporaryFolder folder;
    const std::vector<JudgedLabels> judged = askPydicom("seg", folder);
    ASSERT_EQ(judged.size(), 4U);
    for (const JudgedLabels& one : judged) {
        const auto file = io::readLabels(folder / one.name);
        ASSERT_TRUE(isOk(file)) << one.name;
        EXPECT_EQ(file->labels.grid.size, one.size) << one.name;
        EXPECT_EQ(labelsIn(*file), one.labels) << one.name;
        EXPECT_THAT(namesIn(*file), HasSubstr("1=segment 1;"));
        EXPECT_THAT(file->labels.grid.spacing, ElementsAre(0.5, 0.8, 2.5));
        EXPECT_THAT(file->labels.grid.direction, ElementsAre(1, 0, 0, 0, 0, -1, 0, 1, 0));
    }
    EXPECT_THAT(io::readLabels(folder / "d.dcm")->notes,
                Contains("fractions of a half or more are inside of their segment"));
    const TemporaryFolder alone;
    alone.write("x", contentOf(folder / "a.dcm"));
    EXPECT_TRUE(isOk(io::readLabels(alone.path())));
    expectRefused(io::readLabels(folder / "a.dcm", {.frame = 1}), "of which no frame and no series is chosen");
}

/// Frames of 2 x 2 pixels, 1 mm apart: their segment, height and pixels.
struct SegFrame {
    std::uint16_t segment = 1;
    std::string height;
    char pixels = 0;
};

DicomSet seg(const std::vector<SegFrame>& frames) {
    std::vector<DicomSet> groups;
    std::string bits((4 * frames.size() + 7) / 8, '\0');
    for (std::size_t i = 0; i < frames.size(); ++i) {
        DicomSet identification;
        identification.number(0x0062000B, frames[i].segment);
        DicomSet position;
        position.text(0x00200032, "DS", "0\\0\\" + frames[i].height);
        DicomSet group;
        group.sequence(0x0062000A, {identification}).sequence(0x00209113, {position});
        groups.push_back(group);
        bits[i / 2] = static_cast<char>(bits[i / 2] | frames[i].pixels << (i % 2 * 4));
    }
    DicomSet measures;
    measures.text(0x00280030, "DS", "1\\1");
    DicomSet orientation;
    orientation.text(0x00200037, "DS", "1\\0\\0\\0\\1\\0");
    DicomSet shared;
    shared.sequence(0x00289110, {measures}).sequence(0x00209116, {orientation});
    std::vector<DicomSet> segments;
    for (std::uint16_t number = 1; number <= 2; ++number) {
        DicomSet segment;
        segment.number(0x00620004, number).text(0x00620005, "LO", number == 1 ? "bone" : "vessel");
        segments.push_back(segment);
    }
    DicomSet set;
    set.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.66.4").text(0x00280008, "IS", std::to_string(frames.size()));
    set.number(0x00280010, 2).number(0x00280011, 2).number(0x00280100, 1).number(0x00280101, 1).number(0x00280102, 0);
    set.number(0x00280103, 0).text(0x00620001, "CS", "BINARY").sequence(0x00620002, segments);
    set.sequence(0x52009229, {shared}).sequence(0x52009230, groups).bytes(0x7FE00010, bits);
    return set;
}

TEST(DicomSeg, RefusesWhatIsNoLabelMap) {
    const TemporaryFolder folder;
    const auto read = [&](const DicomSet& set, const std::string& syntax = kExplicit) {
        return io::readLabels(folder.write("s.dcm", set.file(syntax)));
    };
    const std::vector<SegFrame> good{{1, "0", 1}, {2, "3", 2}, {1, "1", 4}};
    for (const char* syntax : {kExplicit, kImplicit, kDeflated}) {
        const auto file = read(seg(good), syntax);
        ASSERT_TRUE(isOk(file)) << syntax;
        EXPECT_THAT(labelsIn(*file), ElementsAre(1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 2, 0, 0));
        EXPECT_EQ(namesIn(*file), "1=bone;2=vessel;");
        EXPECT_THAT(file->notes, ElementsAre("1 of 4 slices have no frame, and are empty"));
    }
    expectRefused(read(seg({{1, "0", 3}, {2, "1", 1}, {2, "0", 2}})), "its segments 'bone' and 'vessel' overlap");
    expectRefused(read(seg({{1, "0", 1}, {1, "1", 1}, {1, "2.4", 1}})), "the gaps between its slices are uneven");
    expectRefused(read(seg({{1, "0", 1}})), "it has one slice and does not state SpacingBetweenSlices");
    expectRefused(read(seg({{1, "0", 1}, {3, "1", 1}})), "frame 2 is of the segment '3', which it does not describe");
    expectRefused(read(seg({{1, "0", 1}, {1, "1", 1}, {1, "90000000", 1}})), "nearly all of them empty");
    expectRefused(read(seg(good).text(0x00620001, "CS", "LABELMAP")), "is 'LABELMAP', which is neither BINARY nor");
    expectRefused(read(seg(good).text(0x00620001, "CS", "FRACTIONAL")), "PhotometricInterpretation");
    expectSound(seg(good).file(), {});
    expectRefused(read(seg(good).number(0x00280010, 60000).number(0x00280011, 60000)), "its pixels take 2 bytes");
    expectRefused(read(seg(good).text(0x00280008, "IS", "4")), "and states the places of 3");
    expectRefused(read(seg(good).text(0x00280008, "IS", "4000000000")), "its pixels take 2 bytes");
    expectRefused(read(seg(good).remove(0x00620002)), "it names no segments");
    expectRefused(read(seg(good), kBigEndian), "big-endian");
    expectRefused(io::readVolume(folder.write("s.dcm", seg(good).file())), "");
}

Grid imageGrid() {
    Grid grid;
    grid.size = {20, 16, 6};
    grid.spacing = {0.5, 0.8, 2.5};
    grid.origin = {-3, 4, 7};
    grid.direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    return grid;
}

TEST(RtStruct, ContoursAreFilledAsNumpyFillsThem) {
    const TemporaryFolder folder;
    const std::vector<JudgedLabels> judged = askPydicom("rtstruct", folder);
    ASSERT_EQ(judged.size(), 4U);
    for (const JudgedLabels& one : judged) {
        const auto file = io::readLabels(folder / one.name, {.grid = imageGrid()});
        ASSERT_TRUE(isOk(file)) << one.name;
        EXPECT_EQ(file->labels.grid.size, one.size);
        EXPECT_EQ(labelsIn(*file), one.labels) << one.name;
        EXPECT_EQ(namesIn(*file), "3=region 3;9=region 9;");
        EXPECT_TRUE(file->notes.empty());
        expectRefused(io::readLabels(folder / one.name),
                      "it holds contours, which are filled on the grid of their image");
    }
}

DicomSet rtStruct(const std::vector<std::pair<std::string, std::string>>& contours) {
    std::vector<DicomSet> rois;
    std::vector<DicomSet> regions;
    for (std::size_t i = 0; i < contours.size(); ++i) {
        DicomSet roi;
        roi.text(0x30060022, "IS", std::to_string(i + 1)).text(0x30060026, "LO", i == 0 ? "heart" : "lung");
        rois.push_back(roi);
        DicomSet contour;
        contour.text(0x30060042, "CS", contours[i].first).text(0x30060050, "DS", contours[i].second);
        DicomSet region;
        region.sequence(0x30060040, {contour}).text(0x30060084, "IS", std::to_string(i + 1));
        regions.push_back(region);
    }
    DicomSet set;
    set.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.481.3")
        .sequence(0x30060020, rois)
        .sequence(0x30060039, regions);
    return set;
}

TEST(RtStruct, RefusesWhatIsNoLabelMap) {
    const TemporaryFolder folder;
    const auto read = [&](const std::vector<std::pair<std::string, std::string>>& contours) {
        return io::readLabels(folder.write("s.dcm", rtStruct(contours).file()), {.grid = imageGrid()});
    };
    const std::string square = "-3.1\\3.9\\9.5\\-2.4\\3.9\\9.5\\-2.4\\5\\9.5\\-3.1\\5\\9.5";
    const auto file = read({{"CLOSED_PLANAR", square}, {"POINT", "0\\0\\0"}});
    ASSERT_TRUE(isOk(file));
    EXPECT_EQ(std::count(file->labels.indices.begin(), file->labels.indices.end(), 1), 4);
    EXPECT_EQ(namesIn(*file), "1=heart;2=lung;");
    EXPECT_THAT(file->notes, ElementsAre("1 contours of the type POINT left out"));
    expectRefused(read({{"CLOSED_PLANAR", square}, {"CLOSED_PLANAR", square}}),
                  "its segments 'heart' and 'lung' overlap, and a voxel of a label map has one label");
    expectRefused(read({{"OPEN_PLANAR", square}}), "contour 1 of 'heart' is of the type 'OPEN_PLANAR'");
    expectRefused(read({{"CLOSED_PLANAR", square + "\\1"}}), "contour 1 of 'heart' is damaged");
    expectRefused(read({{"CLOSED_PLANAR", "0\\0\\9.5\\1\\0\\9.5\\1\\1\\10.5"}}),
                  "is not within a tenth of the slice distance");
    expectRefused(read({{"CLOSED_PLANAR", "0\\0\\8.5\\1\\0\\8.5\\1\\1\\8.5"}}), "is not within a tenth");
    // So far away that crossings would be no numbers.
    expectRefused(read({{"CLOSED_PLANAR", "1e308\\0\\9.5\\-1e308\\1e308\\9.5\\0\\-1e308\\9.5"}}),
                  "is not within a tenth");
    EXPECT_THAT(read({{"CLOSED_PLANAR", "0\\0\\4.5\\1\\0\\4.5\\1\\1\\4.5"}})->notes,
                ElementsAre("1 contours beyond the first and the last slice left out"));
    expectRefused(io::readLabels(folder.write("s.dcm", rtStruct({{"CLOSED_PLANAR", square}}).remove(0x30060039).file()),
                                 {.grid = imageGrid()}),
                  "it has no contours");
    expectSound(rtStruct({{"CLOSED_PLANAR", square}}).file(), {.grid = imageGrid()});
}

} // namespace
} // namespace voxtact::test
