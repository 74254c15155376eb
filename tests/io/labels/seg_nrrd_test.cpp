// SPDX-License-Identifier: MIT
// Segmentations of 3D Slicer.
#include "../io_test_support.h"

namespace voxtact::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string segment(int index, const std::string& name, const std::string& label, const std::string& layer) {
    const std::string key = "Segment" + std::to_string(index);
    return key + "_Color:=1 0 0\n" + key + "_ID:=Segment_" + std::to_string(index) + "\n" + key + "_Name:=" + name +
           "\n" + (label.empty() ? "" : key + "_LabelValue:=" + label + "\n") +
           (layer.empty() ? "" : key + "_Layer:=" + layer + "\n");
}

const std::string kOne = "NRRD0004\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\n"
                         "sizes: 2 2 2\nspace directions: (1,0,0) (0,1,0) (0,0,2)\nkinds: domain domain domain\n"
                         "encoding: raw\nspace origin: (3,0,0)\n";
const std::string kTwo = "NRRD0004\ntype: unsigned char\ndimension: 4\nspace: left-posterior-superior\n"
                         "sizes: 2 2 2 2\nspace directions: none (1,0,0) (0,1,0) (0,0,2)\n"
                         "kinds: list domain domain domain\nencoding: raw\nspace origin: (3,0,0)\n";

class SegNrrd : public testing::Test {
  protected:
    Result<io::LabelFile> read(const std::string& header, const std::string& voxels) {
        return io::readLabels(folder_.write("a.seg.nrrd", header + "\n" + voxels));
    }
    static std::vector<std::int32_t> labelsOf(const io::LabelFile& file) {
        std::vector<std::int32_t> labels;
        for (const std::uint16_t index : file.labels.indices) {
            labels.push_back(file.labels.values[index]);
        }
        return labels;
    }
    static std::string namesOf(const io::LabelFile& file) {
        std::string text;
        for (const io::LabelName& name : file.names) {
            text += std::to_string(name.label) + "=" + name.name + ";";
        }
        return text;
    }

  private:
    TemporaryFolder folder_;
};

TEST_F(SegNrrd, SegmentsNameTheLabels) {
    const auto file = read(kOne + segment(0, "left \\\\ kidney", "7", "0") + segment(1, "liver", "2", "0") +
                               "Segmentation_MasterRepresentation:=Binary labelmap\n",
                           std::string("\0\7\2\0\0\0\0\3", 8));
    ASSERT_TRUE(isOk(file));
    EXPECT_THAT(labelsOf(*file), ElementsAre(0, 7, 2, 0, 0, 0, 0, 3));
    EXPECT_EQ(namesOf(*file), "7=left \\ kidney;2=liver;");
    EXPECT_EQ(file->labels.grid.spacing[2], 2);
    EXPECT_TRUE(file->notes.empty());
    EXPECT_TRUE(read(kOne, std::string(8, '\0'))->names.empty());
}

TEST_F(SegNrrd, LayersBecomeOneMap) {
    const std::string segments = segment(0, "a", "1", "0") + segment(1, "b", "1", "1") + segment(2, "c", "2", "1");
    // Of each voxel both layers, side by side.
    const std::string voxels("\1\0\0\1\0\2\0\0\0\0\0\0\1\0\0\1", 16);
    for (const bool isFirst : {true, false}) {
        std::string header = kTwo;
        std::string stored = voxels;
        if (!isFirst) {
            header.replace(header.find("none (1"), 28, "(1,0,0) (0,1,0) (0,0,2) none");
            header.replace(header.find("list domain domain domain"), 25, "domain domain domain list");
            for (std::size_t i = 0; i < 16; ++i) {
                stored[i % 2 * 8 + i / 2] = voxels[i];
            }
        }
        const auto file = read(header + segments, stored);
        ASSERT_TRUE(isOk(file)) << isFirst;
        EXPECT_THAT(labelsOf(*file), ElementsAre(1, 2, 3, 0, 0, 0, 1, 2));
        EXPECT_EQ(namesOf(*file), "1=a;2=b;3=c;");
        EXPECT_THAT(file->labels.grid.size, ElementsAre(2U, 2U, 2U));
        EXPECT_EQ(file->labels.grid.origin[0], 3);
        EXPECT_THAT(file->notes, ElementsAre("its 2 layers are merged into one label map",
                                             "the segments are numbered from 1 to 3, in the order of the file"));
    }
    // Before 4.11: a layer for each segment, without its number.
    const auto old =
        read(kTwo + segment(0, "a", "", "") + segment(1, "b", "", ""), voxels.substr(0, 4) + std::string(12, '\0'));
    ASSERT_TRUE(isOk(old));
    EXPECT_THAT(labelsOf(*old), ElementsAre(1, 2, 0, 0, 0, 0, 0, 0));
}

TEST_F(SegNrrd, RefusesWhatOneMapCannotHold) {
    const std::string both = segment(0, "tumour", "1", "0") + segment(1, "vessel", "1", "1");
    const std::string empty(15, '\0');
    expectRefused(read(kTwo + both, "\1\1" + std::string(14, '\0')), "its segments 'tumour' and 'vessel' overlap");
    expectRefused(read(kTwo + both, "\2" + empty), "its layer 0 has the label 2, which is no segment's");
    expectRefused(read(kTwo + segment(0, "a", "1", "2"), "\1" + empty), "'a' is in the layer 2, the file has 2");
    expectRefused(read(kTwo + segment(0, "a", "1", "0") + segment(1, "b", "1", "0"), "\1" + empty),
                  "its segment 'b' has the layer and the label of another one");
    expectRefused(read(kTwo + segment(0, "a", "x", "0"), "\1" + empty),
                  "'Segment0_LabelValue' is 'x', not a whole number");
    expectRefused(read(kTwo + both, empty), "truncated");
    expectRefused(read(kTwo, "\1" + empty), "its voxels are not single numbers");
    std::string huge = kTwo;
    huge.replace(huge.find("2 2 2 2"), 7, "2 60000 60000 60000");
    expectRefused(read(huge + both, empty), "");
    const std::string whole = kTwo + both + "\n\1" + empty;
    const TemporaryFolder folder;
    for (std::size_t length = 0; length < whole.size(); ++length) {
        EXPECT_FALSE(io::readLabels(folder.write("b.seg.nrrd", whole.substr(0, length))).ok()) << length;
    }
}

} // namespace
} // namespace voxtact::test
