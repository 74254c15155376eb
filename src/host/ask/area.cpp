// SPDX-License-Identifier: MIT
#include "host/ask/ask_row.h"

namespace voxtact {

namespace {

constexpr std::array kColumns{
    VOXTACT_COLUMN(PairArea, "item", item, "", kItemText),
    VOXTACT_COLUMN(PairArea, "pose", pose, "", kPoseText),
    VOXTACT_COLUMN(PairArea, "lower", bounds.lower, "mm^2", "lower bound of the opaque area of the surface",
                   Printed::Down),
    VOXTACT_COLUMN(PairArea, "upper", bounds.upper, "mm^2", "upper bound of it", Printed::Up),
    VOXTACT_COLUMN(PairArea, "end", end, "", kEndText, Printed::No, kStopReasonNames),
};

constexpr std::array kTriangleColumns{
    VOXTACT_COLUMN(TriangleArea, "pair", pair, "", kPairText),
    VOXTACT_COLUMN(TriangleArea, "triangle", triangle, "", "number in the mesh"),
    VOXTACT_COLUMN(TriangleArea, "whole", whole, "mm^2", "area of the whole triangle"),
    VOXTACT_COLUMN(TriangleArea, "lower", bounds.lower, "mm^2", "lower bound of its opaque area"),
    VOXTACT_COLUMN(TriangleArea, "upper", bounds.upper, "mm^2", "upper bound of it"),
};

constexpr std::array kLabelColumns{
    VOXTACT_COLUMN(LabelArea, "pair", pair, "", kPairText),
    VOXTACT_COLUMN(LabelArea, "item", item, "", kItemText),
    VOXTACT_COLUMN(LabelArea, "pose", pose, "", kPoseText),
    VOXTACT_COLUMN(LabelArea, "label", label, "", "value in the label map", Printed::Plain),
    VOXTACT_COLUMN(LabelArea, "lower", bounds.lower, "mm^2", "lower bound", Printed::Down),
    VOXTACT_COLUMN(LabelArea, "upper", bounds.upper, "mm^2", "upper bound", Printed::Up),
    VOXTACT_COLUMN(LabelArea, "end", end, "", kEndText, Printed::No, kStopReasonNames),
};

constexpr std::array kTables{TableLayout{"pairs", kColumns}, TableLayout{"triangles", kTriangleColumns},
                             TableLayout{"labels", kLabelColumns}};

Result<AnswerTables> askArea(cpu::HostEngine& engine, SettingReader& read, const cpu::Batch& batch) {
    Area question;
    read("tolerance", question.tolerance)("labels", question.labels)("triangles", question.triangles);
    read("resolution", question.resolution)("max_steps", question.maxSteps);
    return askRead(engine, question, read, batch);
}

} // namespace

AnswerTables toTables(AreaAnswer answer) {
    return {{tableOf("pairs", kColumns, std::move(answer.pairs)),
             tableOf("triangles", kTriangleColumns, std::move(answer.triangles)),
             tableOf("labels", kLabelColumns, std::move(answer.labels)), totalsOf(answer.wallMilliseconds)}};
}

extern const AskRow kAskArea;
constinit const AskRow kAskArea{{.name = "area",
                                 .text = "how much of the surface is inside?",
                                 .help = R"(Output: pose,mesh,volume,lower,upper; with --in, label precedes lower
  lower,upper   bounds of the opaque area of the surface, mm^2

Examples:
  voxtact area --volume ct.nrrd --mesh cup.stl --poses poses.txt --iso 300
  voxtact area --volume ct.nrrd --mesh cup.stl --iso 300 --triangles area.csv)",
                                 .tables = kTables,
                                 .measures = true},
                                askArea};

} // namespace voxtact
