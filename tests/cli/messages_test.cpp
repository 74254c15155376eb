// SPDX-License-Identifier: MIT
// What the program says of arguments that are long, not text, or misspelt, and of the time that is left.
#include "cli/output/progress.h"
#include "cli/output/text_for_messages.h"
#include "cli_fixture.h"
#include "core/base/escaped.h"

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class MessagesTest : public CliTest {};

TEST_F(MessagesTest, MisspeltNamesAreGuessed) {
    EXPECT_THAT(refused(2, {"tuch"}), HasSubstr("unknown command 'tuch', did you mean touch?"));
    EXPECT_THAT(refused(2, {"inof"}), HasSubstr("did you mean info?"));
    EXPECT_THAT(refused(2, {"make", "pose"}), HasSubstr("did you mean poses?"));
    EXPECT_THAT(refused(2, {"xyz"}), Not(HasSubstr("did you mean")));
    const Arguments pair{"count", "--volume", "builtin:head:18", "--mesh", "builtin:scalpel:500"};
    const auto guess = [&](const char* option) {
        Arguments all = pair;
        all.insert(all.end(), {option, "1"});
        return refused(2, all);
    };
    EXPECT_THAT(guess("--threshold"), HasSubstr("did you mean --opacity-threshold?"));
    EXPECT_THAT(guess("--methd"), HasSubstr("did you mean --method?"));
    EXPECT_THAT(guess("--label"), HasSubstr("did you mean --labels?"));
    EXPECT_THAT(guess("--pose"), HasSubstr("did you mean --poses?"));
    EXPECT_THAT(guess("--something-else"), Not(HasSubstr("did you mean")));
    EXPECT_THAT(refused(2, {""}), HasSubstr("unknown command ''"));
}

TEST_F(MessagesTest, LongAndBrokenArgumentsAreNotEchoed) {
    const std::string bytes = "\xff\xfe\x1b[31mred\x07";
    const std::string big(100000, 'x');
    for (const Arguments& arguments :
         {Arguments{bytes}, Arguments{"count", bytes}, Arguments{"count", "--method", bytes},
          Arguments{"count", "--volume", bytes, "--mesh", "builtin:scalpel:500"}, Arguments{"info", bytes},
          Arguments{"info", bytes + ".stl"}, Arguments{"count", "--size", bytes},
          Arguments{"count", "--opacity", bytes},
          Arguments{"count", "--volume", "builtin:" + bytes, "--mesh", "builtin:scalpel:500"}}) {
        const Ran ran = run(arguments);
        EXPECT_NE(ran.status, 0);
        for (const char c : ran.err) {
            EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << static_cast<int>(c) << " in " << ran.err;
        }
    }
    for (const Arguments& arguments :
         {Arguments{big}, Arguments{"count", "--method", big}, Arguments{"count", "--" + big}, Arguments{"info", big},
          Arguments{"count", "--size", big}, Arguments{"count", "--volume", "builtin:head:18", "--mesh", big}}) {
        const Ran ran = run(arguments);
        EXPECT_NE(ran.status, 0);
        EXPECT_LT(ran.err.size(), 5000U);
        EXPECT_THAT(ran.err, HasSubstr("..."));
    }
}

TEST(TextForMessages, KeepsTextAndEscapesBytes) {
    EXPECT_EQ(escaped("caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80"), "caf\xC3\xA9 \xE2\x82\xAC \xF0\x9F\x98\x80");
    EXPECT_EQ(escaped("a\nb\x7f"), "a\\x0ab\\x7f");
    EXPECT_EQ(escaped("\xC3"), "\\xc3");
    EXPECT_EQ(escaped("\xC0\xAF"), "\\xc0\\xaf") << "overlong";
    EXPECT_EQ(escaped("\xED\xA0\x80"), "\\xed\\xa0\\x80") << "a surrogate";
    EXPECT_EQ(escaped("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80") << "beyond the last character";
    EXPECT_EQ(escaped("\xC2\x9B"), "\\xc2\\x9b") << "a control character";
    EXPECT_EQ(escaped("\xEF\xBF\xBD\xEF\xBF\xBE\xEF\xBF\xBF"), "\xEF\xBF\xBD\\xef\\xbf\\xbe\\xef\\xbf\\xbf");
    EXPECT_EQ(inHtml("<a&\"b\">\n\xC3\xA9"), "&lt;a&amp;&quot;b&quot;&gt;\n\xC3\xA9");
    EXPECT_EQ(inHtml("\x1b\xff\xC3"), "\uFFFD\uFFFD\uFFFD");
}

TEST(TextForMessages, ShortensInTheMiddleAndBetweenCharacters) {
    const std::string word(120, 'a');
    EXPECT_EQ(app::shortened(word), word);
    EXPECT_EQ(app::shortened(word + "b"), std::string(70, 'a') + "..." + std::string(39, 'a') + "b");
    for (std::size_t length = 100; length < 2000; length += 7) {
        std::string text;
        while (text.size() < length) {
            text += "\xE2\x82\xAC";
        }
        const std::string cut = app::shortened(text);
        EXPECT_EQ(escaped(cut), cut) << "valid: no character is cut";
        EXPECT_LE(cut.size(), 130U);
    }
}

TEST(TextForMessages, NearestNames) {
    const std::vector<std::string> names{"count", "devices", "make"};
    EXPECT_EQ(app::nearestName("cuont", names), "count");
    EXPECT_EQ(app::nearestName("devics", names), "devices");
    EXPECT_EQ(app::nearestName("mkae", names), "make");
    EXPECT_EQ(app::nearestName("bake", names), "make");
    EXPECT_EQ(app::nearestName("quite-another", names), "");
    EXPECT_EQ(app::nearestName("", names), "");
}

TEST(ProgressTest, SaysRoughlyWhatIsLeft) {
    EXPECT_EQ(app::roughly(0.2), "1 s");
    EXPECT_EQ(app::roughly(45.4), "45 s");
    EXPECT_EQ(app::roughly(200), "3 min");
    EXPECT_EQ(app::roughly(4 * 3600 + 20 * 60), "4 h 20 min");
    EXPECT_EQ(app::withCommas(7), "7");
    EXPECT_EQ(app::withCommas(1234), "1,234");
    EXPECT_EQ(app::withCommas(1234567), "1,234,567");
    EXPECT_EQ(app::timeLeft(250, 1000, 60), ", about 3 min left");
    EXPECT_EQ(app::timeLeft(10, 1000, 0.5), "") << "too soon to say";
    EXPECT_EQ(app::timeLeft(0, 1000, 60), "");
    EXPECT_EQ(app::timeLeft(1000, 1000, 60), "");
    EXPECT_EQ(app::timeLeft(10, 0, 60), "") << "nobody knows how many there are";
}

} // namespace
} // namespace voxtact::test
