// SPDX-License-Identifier: MIT
#include "host/ask/ask_row.h"

namespace voxtact {

namespace {

struct TouchRow {
    std::uint32_t item, pose;
    Verdict touch;
    std::uint32_t witness, triangle;
    Vec3 point;
};
constexpr std::array kColumns{
    VOXTACT_COLUMN(TouchRow, "item", item, "", kItemText),
    VOXTACT_COLUMN(TouchRow, "pose", pose, "", kPoseText),
    VOXTACT_COLUMN(TouchRow, "touch", touch, "", "whether it touches, certified", Printed::No, kVerdictNames),
    VOXTACT_COLUMN(TouchRow, "witness", witness, "", "1: there is a witness point"),
    VOXTACT_COLUMN(TouchRow, "triangle", triangle, "",
                   "triangle of the witness point: number in the mesh; 4294967295: the point is inside the mesh"),
    VOXTACT_COLUMN(TouchRow, "point", point, "mm",
                   "witness point, world: opaque, within the margin of the triangle, or inside the mesh"),
};

constexpr std::array kTables{TableLayout{"pairs", kColumns}};

Result<AnswerTables> askTouch(cpu::HostEngine& engine, SettingReader& read, const cpu::Batch& batch) {
    Touch question;
    std::optional<double> distance;
    std::optional<double> angle;
    read("margin", question.margin)("uncertainty_distance", distance)("uncertainty_angle", angle);
    read("witness", question.witness)("solid", question.solid);
    read("resolution", question.resolution)("max_steps", question.maxSteps);
    if (distance || angle) {
        question.uncertainty = PoseTolerance{distance.value_or(0), angle.value_or(0)};
    }
    return askRead(engine, question, read, batch);
}

} // namespace

AnswerTables toTables(TouchAnswer answer) {
    const auto toRow = [](const PairTouch& pair) {
        TouchRow out{pair.item, pair.pose, pair.touch, 0, 0, {}};
        if (pair.witness) {
            out.witness = 1;
            out.triangle = pair.witness->triangle;
            out.point = pair.witness->position;
        }
        return out;
    };
    return {{tableOf("pairs", kColumns, answer.pairs, toRow), totalsOf(answer.wallMilliseconds)}};
}

extern const AskRow kAskTouch;
constinit const AskRow kAskTouch{{.name = "touch",
                                  .text = "does it touch?",
                                  .help = R"(Output: pose,mesh,volume,touch,x,y,z,triangle,label
  touch     0 no, 1 yes: both proven; 2 undecided, because of rounding or the
            deflection of STEP and IGES; their yes refers to the triangles
  x,y,z     opaque witness point, on the triangle or within --margin of it;
            only from the host engine, and not with --uncertainty
  triangle  index in the mesh; empty if the witness point is inside the solid
  label     label at the witness point
Without --solid, only the surface counts: a mesh that encloses an opaque region
does not touch it.

Examples:
  voxtact touch --volume head.nii.gz --mesh tool.stl --poses poses.txt --iso 40
  voxtact touch --volume ct.nrrd --mesh screw.stl --iso 300 --margin 2 --summary)",
                                  .tables = kTables},
                                 askTouch};

} // namespace voxtact
