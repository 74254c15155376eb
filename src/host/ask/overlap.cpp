// SPDX-License-Identifier: MIT
#include "host/ask/ask_row.h"

namespace voxtact {

namespace {

constexpr const char* kContainmentNames = "none,some,all,undecided";

constexpr std::array kColumns{
    VOXTACT_COLUMN(PairOverlap, "item", item, "", kItemText),
    VOXTACT_COLUMN(PairOverlap, "pose", pose, "", kPoseText),
    VOXTACT_COLUMN(PairOverlap, "lower", bounds.lower, "mm^3", "lower bound of the opaque volume inside",
                   Printed::Down),
    VOXTACT_COLUMN(PairOverlap, "upper", bounds.upper, "mm^3", "upper bound of it", Printed::Up),
    VOXTACT_COLUMN(PairOverlap, "inside", inside, "", "share of the image's opaque region inside the mesh",
                   Printed::Plain, kContainmentNames),
    VOXTACT_COLUMN(PairOverlap, "solid_lower", solid.lower, "mm^3", "lower bound of the volume of the mesh",
                   Printed::Down),
    VOXTACT_COLUMN(PairOverlap, "solid_upper", solid.upper, "mm^3", "upper bound of the volume of the mesh",
                   Printed::Up),
    VOXTACT_COLUMN(PairOverlap, "end", end, "", kEndText, Printed::No, kStopReasonNames),
};

constexpr std::array kBandColumns{
    VOXTACT_COLUMN(BandOverlap, "pair", pair, "", kPairText),
    VOXTACT_COLUMN(BandOverlap, "item", item, "", kItemText),
    VOXTACT_COLUMN(BandOverlap, "pose", pose, "", kPoseText),
    VOXTACT_COLUMN(BandOverlap, "band", band, "", "index of the band, from 0"),
    VOXTACT_COLUMN(BandOverlap, "from", from, "", "lower limit of the band", Printed::Plain),
    VOXTACT_COLUMN(BandOverlap, "below", below, "", "upper limit of the band, excluded", Printed::Plain),
    VOXTACT_COLUMN(BandOverlap, "lower", bounds.lower, "mm^3", "lower bound of the volume with these values",
                   Printed::Down),
    VOXTACT_COLUMN(BandOverlap, "upper", bounds.upper, "mm^3", "upper bound of it", Printed::Up),
    VOXTACT_COLUMN(BandOverlap, "end", end, "", kEndText, Printed::No, kStopReasonNames),
};

constexpr std::array kLabelColumns{
    VOXTACT_COLUMN(LabelOverlap, "pair", pair, "", kPairText),
    VOXTACT_COLUMN(LabelOverlap, "item", item, "", kItemText),
    VOXTACT_COLUMN(LabelOverlap, "pose", pose, "", kPoseText),
    VOXTACT_COLUMN(LabelOverlap, "label", label, "", "value in the label map", Printed::Plain),
    VOXTACT_COLUMN(LabelOverlap, "lower", bounds.lower, "mm^3", "lower bound of its opaque volume inside",
                   Printed::Down),
    VOXTACT_COLUMN(LabelOverlap, "upper", bounds.upper, "mm^3", "upper bound of it", Printed::Up),
    VOXTACT_COLUMN(LabelOverlap, "inside", inside, "", "share of its opaque part inside the mesh", Printed::Plain,
                   kContainmentNames),
    VOXTACT_COLUMN(LabelOverlap, "end", end, "", kEndText, Printed::No, kStopReasonNames),
};

constexpr std::array kTables{TableLayout{"pairs", kColumns}, TableLayout{"bands", kBandColumns},
                             TableLayout{"labels", kLabelColumns}};

Result<AnswerTables> askOverlap(cpu::HostEngine& engine, SettingReader& read, const cpu::Batch& batch) {
    Overlap question;
    read("tolerance", question.tolerance)("bands", question.bandLimits)("labels", question.labels);
    read("max_steps", question.maxSteps);
    return askRead(engine, question, read, batch);
}

} // namespace

AnswerTables toTables(OverlapAnswer answer) {
    return {{tableOf("pairs", kColumns, std::move(answer.pairs)),
             tableOf("bands", kBandColumns, std::move(answer.bands)),
             tableOf("labels", kLabelColumns, std::move(answer.labels)), totalsOf(answer.wallMilliseconds)}};
}

extern const AskRow kAskOverlap;
constinit const AskRow kAskOverlap{{.name = "overlap",
                                    .text = "how much of the opaque region is inside the mesh?",
                                    .help = R"(Output: pose,mesh,volume,lower,upper,inside,solid_lower,solid_upper
  lower,upper   bounds of the opaque volume inside the closed mesh, mm^3
  inside        none, some or all of the opaque region, or undecided
  solid_...     bounds of the volume of the mesh, mm^3
With --in, the column label precedes lower, and inside refers to that label.
With --bands, each row has the volume with values in one band, opaque or not.

Examples:
  voxtact overlap --volume ct.nrrd --mesh screw.stl --poses poses.txt --iso 300
  voxtact overlap --volume ct.nrrd --mesh screw.stl --bands 130,250,600)",
                                    .tables = kTables,
                                    .measures = true,
                                    .needsSolid = true},
                                   askOverlap};

} // namespace voxtact
