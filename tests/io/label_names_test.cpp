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
