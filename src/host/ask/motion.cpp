// SPDX-License-Identifier: MIT
#include "host/ask/ask_row.h"

#include <limits>

namespace voxtact {

namespace {

struct SegmentRow {
    std::uint32_t item = 0, pose = 0;
    Verdict touch{};
    MotionEnd end{};
    std::uint32_t triangle = 0;
    double toiLower = 0, toiUpper = 0;
    Vec3 point{};
    Mat4 world_from_object{};
};
constexpr std::array kColumns{
    VOXTACT_COLUMN(SegmentRow, "item", item, "", kItemText),
    VOXTACT_COLUMN(SegmentRow, "pose", pose, "", "number of its first pose"),
    VOXTACT_COLUMN(SegmentRow, "touch", touch, "", "whether it touches on the way, certified", Printed::No,
                   kVerdictNames),
    VOXTACT_COLUMN(SegmentRow, "toi_lower", toiLower, "", "collision-free up to this parameter; 1: all the way"),
    VOXTACT_COLUMN(SegmentRow, "toi_upper", toiUpper, "", "certainly touching at this parameter; NaN: none"),
    VOXTACT_COLUMN(SegmentRow, "end", end, "", kEndText, Printed::No, "decided,grazes,budget"),
    VOXTACT_COLUMN(SegmentRow, "triangle", triangle, "", "triangle of the touch: number in the mesh"),
    VOXTACT_COLUMN(SegmentRow, "point", point, "mm", "witness point of the touch, world"),
    VOXTACT_COLUMN(SegmentRow, "world_from_object", world_from_object, "", "pose at toi_upper, column by column"),
};

constexpr std::array kTables{TableLayout{"segments", kColumns}};

Result<AnswerTables> askMotion(cpu::HostEngine& engine, SettingReader& read, const cpu::Batch& batch) {
    Motion question;
    read("interpolation", question.interpolation)("resolution", question.resolution);
    read("touch_resolution", question.touchResolution)("max_steps", question.maxSteps);
    return askRead(engine, question, read, batch);
}

} // namespace

AnswerTables toTables(MotionAnswer answer) {
    const auto toRow = [](const SegmentMotion& segment) {
        SegmentRow out{.item = segment.item,
                       .pose = segment.pose,
                       .touch = segment.touch      ? Verdict::Yes
                                : segment.possible ? Verdict::Undecided
                                                   : Verdict::No,
                       .end = segment.end,
                       .toiLower = segment.freeUntil,
                       .toiUpper = std::numeric_limits<double>::quiet_NaN()};
        if (segment.touch) {
            out.triangle = segment.touch->triangle;
            out.toiUpper = segment.touch->at;
            out.point = segment.touch->position;
            out.world_from_object = segment.touch->world_from_object;
        }
        return out;
    };
    return {{tableOf("segments", kColumns, answer.segments, toRow), totalsOf(answer.wallMilliseconds)}};
}

extern const AskRow kAskMotion;
constinit const AskRow kAskMotion{{.name = "motion",
                                   .text = "does it touch on the way from pose to pose?",
                                   .help = R"(Each row is the rigid motion between two consecutive poses:
  pose                   number of the first pose, from 0
  touch                  0 no, 1 yes: both proven; 2 undecided
  toi_lower,toi_upper    time of impact, 0 at the first pose, 1 at the next:
                         collision-free up to toi_lower, a touch at toi_upper
  x,y,z,triangle,label   witness point of that touch, mm

The motion is not sampled: even a thin plate that crosses a thin sheet is found.

Examples:
  voxtact motion --volume head.nii.gz --mesh tool.stl --poses path.txt --iso 40
  voxtact motion --volume ct.nrrd --mesh drill.stl --poses path.txt --summary)",
                                   .tables = kTables},
                                  askMotion};

} // namespace voxtact
