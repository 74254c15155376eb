// SPDX-License-Identifier: MIT
// The names of the labels of a label map.
#include "io_test_support.h"

namespace voxtact::test {
namespace {

using NumberAndName = std::pair<std::int32_t, std::string>;

std::vector<NumberAndName> pairsOf(const std::vector<io::LabelName>& names) {
    std::vector<NumberAndName> pairs;
    for (const io::LabelName& entry : names) {
        pairs.emplace_back(entry.label, entry.name);
    }
    return pairs;
}

TEST(LabelNames, NumberNameAndWhateverFollows) {
    const TemporaryFolder folder;
    const auto names = io::readLabelNames(
        folder.write("names.txt", "\xEF\xBB\xBF# a comment\r\n\r\n2 Precentral_R 2002\r\n+1\tPrecentral_L\t2001 x y\n"
                                  "-5 left,lobe:\"a\";b # and a comment\n2 Precentral_R\n2147483647 last"));
    ASSERT_TRUE(isOk(names));
    EXPECT_THAT(pairsOf(*names),
                testing::ElementsAre(NumberAndName(2, "Precentral_R"), NumberAndName(1, "Precentral_L"),
                                     NumberAndName(-5, "left,lobe:\"a\";b"), NumberAndName(2147483647, "last")));
}

TEST(LabelNames, AsOtherProgramsWriteThem) {
    const TemporaryFolder folder;
    const auto read = [&](const std::string& text) {
        const auto names = io::readLabelNames(folder.write("names.txt", text));
        EXPECT_TRUE(isOk(names)) << text;
        return names.ok() ? pairsOf(*names) : std::vector<NumberAndName>();
    };
    const auto are = [](auto... pairs) { return testing::ElementsAre(NumberAndName(pairs)...); };
    using Is = NumberAndName;
    // ITK-SNAP's label descriptions.
    EXPECT_THAT(read("# IDX R G B A VIS MSH LABEL\n    0     0    0    0        0  0  0    \"Clear Label\"\n"
                     "    1   255    0    0        1  1  1    \"vein\"\n    2 0 255 0 0.5 1 0 \"left nerve\"\n"),
                are(Is(0, "Clear Label"), Is(1, "vein"), Is(2, "left nerve")));
    // FreeSurfer's, 3D Slicer's and MRIcron's tables; names with blanks.
    EXPECT_THAT(read("4 Left-Ventricle 120 18 134 0\n5 ctx 3 1 2 3 0\n6 Left Thalamus 0 118 14 255\n"),
                are(Is(4, "Left-Ventricle"), Is(5, "ctx 3"), Is(6, "Left Thalamus")));
    EXPECT_THAT(read("1 Left Hippocampus\n2 Left Amygdala\n5 \"Right one\" 7\n"),
                are(Is(1, "Left Hippocampus"), Is(2, "Left Amygdala"), Is(5, "Right one")));
    EXPECT_THAT(read("1\tLeft 3\t2001\n2 \tLeft 4\t2002 x\n"), are(Is(1, "Left 3"), Is(2, "Left 4")));
    // A number that tells names apart is a part of them, another one is a column.
    EXPECT_THAT(read("1 Precentral_L 2001\n2 Precentral_R 2002\n"), are(Is(1, "Precentral_L"), Is(2, "Precentral_R")));
    EXPECT_THAT(read("1 Brodmann area 4\n2 Brodmann area 6\n3 rest\n"),
                are(Is(1, "Brodmann area 4"), Is(2, "Brodmann area 6"), Is(3, "rest")));
    EXPECT_THAT(read("1 1001\n"), are(Is(1, "1001")));
}

TEST(LabelNames, RefusalsNameTheLine) {
    const TemporaryFolder folder;
    struct Case {
        std::string line;
        const char* reason;
    };
    for (const Case& bad :
         {Case{"one Precentral_L", "line 2: 'one' is not a number"},
          Case{"1.5 x", "line 2: '1.5' is not a whole number"}, Case{"1e2 x", "line 2: '1e2' is not a whole number"},
          Case{"2147483648 x", "line 2: '2147483648' is not"}, Case{"nan x", "line 2: 'nan' is not"},
          Case{"+-1 x", "line 2: '+-1' is not a number"}, Case{"3", "line 2: the label 3 has no name"},
          Case{"3 # x", "line 2: the label 3 has no name"},
          Case{"3 255 0 0 1 1 1 vein", "line 2: its second word is the number '255'; a row is 'number name'"},
          Case{"3 255 0 0 1 1 \"vein\"", "line 2: its second word is the number '255'"},
          Case{"3 255 0 0", "line 2: its second word is the number '255'"},
          Case{"3 255 0 0 1 1 1 \"vein", "line 2: the name in quotes is empty or does not end"},
          Case{"3 \"\" x", "line 2: the name in quotes is empty or does not end"},
          Case{"7 y", "line 2: the label 7 has another name already, 'x'"}}) {
        const auto path = folder.write("names.txt", "7 x\n" + bad.line + "\n");
        expectRefused(io::readLabelNames(path), bad.reason, path);
    }
}

TEST(LabelNames, FilesWithoutALabel) {
    const TemporaryFolder folder;
    expectRefused(io::readLabelNames(folder.write("empty.txt", "")), "it names no label", folder / "empty.txt");
    expectRefused(io::readLabelNames(folder.write("comments.txt", "# 1 x\n\n")), "it names no label");
    expectRefused(io::readLabelNames(folder / "none.txt"), "there is no such file", folder / "none.txt");
    expectRefused(io::readLabelNames(folder.path()), "it is a folder");
    expectRefused(io::readLabelNames(folder.write("binary", std::string("\x1f\x8b\0\0", 4))), "is not a number");
}

} // namespace
} // namespace voxtact::test
