// SPDX-License-Identifier: MIT
// What is said of transfer functions under which nothing, or less than was meant, is opaque.
#include "cli/options/opacity_notes.h"
#include "cli_fixture.h"

namespace voxtact::test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::vector<std::string> notes(const std::vector<ControlPoint>& points, const ValueRange& domain,
                               const ValueRange& data) {
    return app::opacityNotes({points, domain, kDefaultTableSize}, data, kDefaultThreshold, "ct.nii", true);
}

const std::vector<ControlPoint> kVessels{{150, 0}, {200, 1}, {250, 0}};

TEST(OpacityNotes, WhatIsSeenNeedsNone) {
    EXPECT_THAT(notes(kVessels, {-1024, 3071}, {-1000, 3000}), IsEmpty());
    // Who makes the table says what is wrong with it.
    EXPECT_THAT(notes({}, {0, 255}, {0, 255}), IsEmpty());
}

TEST(OpacityNotes, PointsBelowTheThreshold) {
    EXPECT_THAT(notes({{0, 0}, {255, 0.05}}, {0, 255}, {0, 255}),
                ElementsAre("no opacity of the transfer function reaches the threshold 0.1: nothing touches"));
}

TEST(OpacityNotes, ACoarseTable) {
    const std::vector<std::string> found = notes(kVessels, {-1000, 32767}, {-1000, 32767});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_THAT(found[0], AllOf(HasSubstr("ct.nii: the table of the transfer function skips opaque values"),
                                HasSubstr("--tf-size or --tf-domain")));
    EXPECT_THAT(app::opacityNotes({kVessels, {-1000, 32767}}, {-1000, 32767}, kDefaultThreshold, "ct.nii", false),
                IsEmpty())
        << "what is certified does not look at the table";
    EXPECT_THAT(notes({{0, 0}, {1, 1}}, {-1000, 32767}, {-100, 100}),
                ElementsAre(HasSubstr("moves an end of the opaque values by")));
    EXPECT_THAT(notes({{0, 0}, {1, 1}}, {-1000, 32767}, {-10000, 10000}), IsEmpty()) << "by less than a hundredth";
}

TEST(OpacityNotes, NoValueOfTheVolume) {
    EXPECT_THAT(notes({{300, 0}, {400, 1}}, {0, 255}, {0, 255}),
                ElementsAre("ct.nii: none of its values, 0 to 255, is opaque under the transfer function: nothing "
                            "touches"));
    EXPECT_THAT(notes({{300, 0}, {400, 1}}, {-1024, 3071}, {7, 7}),
                ElementsAre(HasSubstr("none of its values, 7, is")));
}

class OpacityNotesTest : public CliTest {
  protected:
    void SetUp() override {
        writeText(path("poses.txt"), "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1\n1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1\n");
    }
    [[nodiscard]] std::string said(const Arguments& more) const {
        Arguments all{more.front(),          "--volume", "builtin:head:16", "--mesh",
                      "builtin:scalpel:500", "--poses",  path("poses.txt")};
        all.insert(all.end(), more.begin() + 1, more.end());
        const Ran ran = run(all);
        EXPECT_EQ(ran.status, 0) << ran.err;
        return ran.err;
    }
};

TEST_F(OpacityNotesTest, AreSaidByWhatAnswers) {
    const auto isSaid =
        HasSubstr("builtin:head:16: none of its values, 0 to 243, is opaque under the transfer function");
    const Arguments hounsfield{"--opacity", "300:0,400:1"};
    for (Arguments command : {Arguments{"count"}, Arguments{"touch", "--margin", "5"}, Arguments{"motion"}}) {
        EXPECT_THAT(said(command), Not(isSaid));
        command.insert(command.end(), hounsfield.begin(), hounsfield.end());
        EXPECT_THAT(said(command), isSaid) << command.front();
    }
    const Arguments coarse{"count", "--opacity", "100:0,110:1,120:0", "--tf-domain", "0:25500", "--projection"};
    Arguments view = coarse;
    view.emplace_back("dominant-axis");
    EXPECT_THAT(said(view), HasSubstr("skips opaque values"));
    Arguments certified = coarse;
    certified.emplace_back("certified");
    EXPECT_THAT(said(certified), Not(HasSubstr("skips opaque values")));
    const Ran plan = run({"plan", "--volume", "builtin:head:16", "--target", "20,0,30", "--entries", "42",
                          "--avoid-opacity", "300:0,400:1"});
    EXPECT_EQ(plan.status, 0);
    EXPECT_THAT(plan.err, AllOf(HasSubstr("is opaque under --avoid-opacity"), Not(HasSubstr("under the transfer"))));
}

TEST_F(OpacityNotesTest, AreSaidOnceAndWithWhatTheyExplain) {
    // Two volumes, one transfer function.
    const Ran two = run({"count", "--volume", "builtin:head:16", "--volume", "builtin:sphere:16", "--mesh",
                         "builtin:scalpel:500", "--opacity", "0:0"});
    EXPECT_EQ(two.err,
              "voxtact: note: no opacity of the transfer function reaches the threshold 0.1: nothing touches\n");
    const Arguments plan{"plan", "--volume", "builtin:head:16", "--target", "20,0,30", "--entries", "42"};
    Arguments nowhere = plan;
    nowhere.insert(nowhere.end(), {"--opacity", "300:0,400:1", "--avoid-opacity", "100:0,160:1"});
    EXPECT_THAT(refused(2, nowhere),
                AllOf(HasSubstr("meets the surface of entries"), HasSubstr("; builtin:head:16: none of")));
    Arguments report = plan;
    report.insert(report.end(),
                  {"--avoid-opacity", "300:0,400:1", "--output", path("o.csv"), "--report", path("p.html")});
    output(report, {.note = "is opaque under --avoid-opacity"});
    EXPECT_THAT(readText(path("p.html")), HasSubstr("is opaque under --avoid-opacity"));
}

} // namespace
} // namespace voxtact::test
