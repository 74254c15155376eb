// SPDX-License-Identifier: MIT
#include "host/ask/ask_row.h"

namespace voxtact {

namespace {

struct DistanceRow {
    std::uint32_t item = 0, pose = 0;
    StopReason end{};
    std::uint32_t witness = 0, triangle = 0;
    Bounds bounds{};
    Vec3 onMesh{}, inVolume{}, perTranslation{}, perRotation{};
};
constexpr std::array kColumns{
    VOXTACT_COLUMN(DistanceRow, "item", item, "", kItemText),
    VOXTACT_COLUMN(DistanceRow, "pose", pose, "", kPoseText),
    VOXTACT_COLUMN(DistanceRow, "lower", bounds.lower, "mm", "lower bound of the distance", Printed::Down),
    VOXTACT_COLUMN(DistanceRow, "upper", bounds.upper, "mm", "upper bound; infinite if unknown", Printed::Up),
    VOXTACT_COLUMN(DistanceRow, "end", end, "", kEndText, Printed::No, kStopReasonNames),
    VOXTACT_COLUMN(DistanceRow, "witness", witness, "", "1: there are closest points"),
    VOXTACT_COLUMN(
        DistanceRow, "triangle", triangle, "",
        "triangle of the closest point: number in the mesh; 4294967295: both points are one inside the mesh"),
    VOXTACT_COLUMN(DistanceRow, "on_mesh", onMesh, "mm", "closest point of the surface, world"),
    VOXTACT_COLUMN(DistanceRow, "in_volume", inVolume, "mm", "closest opaque point, world"),
    VOXTACT_COLUMN(DistanceRow, "per_translation", perTranslation, "mm/mm",
                   "derivative for a translation along x, y, z"),
    VOXTACT_COLUMN(DistanceRow, "per_rotation", perRotation, "mm/rad",
                   "derivative for a rotation about x, y, z through the origin of the mesh"),
};

constexpr std::array kLabelColumns{
    VOXTACT_COLUMN(LabelDistance, "pair", pair, "", kPairText),
    VOXTACT_COLUMN(LabelDistance, "item", item, "", kItemText),
    VOXTACT_COLUMN(LabelDistance, "pose", pose, "", kPoseText),
    VOXTACT_COLUMN(LabelDistance, "label", label, "", "value in the label map", Printed::Plain),
    VOXTACT_COLUMN(LabelDistance, "lower", bounds.lower, "mm", "lower bound", Printed::Down),
    VOXTACT_COLUMN(LabelDistance, "upper", bounds.upper, "mm", "upper bound", Printed::Up),
    VOXTACT_COLUMN(LabelDistance, "end", end, "", kEndText, Printed::No, kStopReasonNames),
};

constexpr std::array kTables{TableLayout{"pairs", kColumns}, TableLayout{"labels", kLabelColumns}};

Result<AnswerTables> askDistance(cpu::HostEngine& engine, SettingReader& read, const cpu::Batch& batch) {
    Distance question;
    read("tolerance", question.tolerance)("max", question.maximum)("labels", question.labels);
    read("any_opacity", question.labelsAtAnyOpacity)("solid", question.solid);
    read("resolution", question.resolution)("max_steps", question.maxSteps);
    return askRead(engine, question, read, batch);
}

} // namespace

AnswerTables toTables(DistanceAnswer answer) {
    const auto toRow = [](const PairDistance& pair) {
        DistanceRow out{.item = pair.item, .pose = pair.pose, .end = pair.end, .bounds = pair.bounds};
        if (pair.closest) {
            out.witness = 1;
            out.triangle = pair.closest->triangle;
            out.onMesh = pair.closest->mesh;
            out.inVolume = pair.closest->volume;
            out.perTranslation = pair.closest->perTranslation;
            out.perRotation = pair.closest->perRotation;
        }
        return out;
    };
    return {{tableOf("pairs", kColumns, answer.pairs, toRow),
             tableOf("labels", kLabelColumns, std::move(answer.labels)), totalsOf(answer.wallMilliseconds)}};
}

extern const AskRow kAskDistance;
constinit const AskRow kAskDistance{{.name = "distance",
                                     .text = "how near is it?",
                                     .help = R"(Output: pose,mesh,volume,lower,upper; with --to, label precedes lower
  lower,upper   bounds of the distance from the surface to the opaque region,
                mm; 0,0: a touch; inf,inf: nothing is opaque;
                upper inf: the distance is at least --max

Examples:
  voxtact distance --volume ct.nrrd --mesh screw.stl --poses poses.txt --iso 300
  voxtact distance --volume t1.nii --mesh probe.stl --labels aal.nii.gz --to 3)",
                                     .tables = kTables,
                                     .measures = true,
                                     .isLeastWorst = true},
                                    askDistance};

} // namespace voxtact
