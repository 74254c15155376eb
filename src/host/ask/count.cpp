// SPDX-License-Identifier: MIT
#include "core/base/infinity.h"
#include "host/ask/ask_row.h"

namespace voxtact {

namespace {

struct CountRow {
    std::uint32_t item, pose;
    Verdict touch;
    Exactness exactness;
    CountingMethod method;
    Projection projection;
    std::uint64_t count;
};
constexpr std::array kColumns{
    VOXTACT_COLUMN(CountRow, "item", item, "", kItemText),
    VOXTACT_COLUMN(CountRow, "pose", pose, "", kPoseText),
    VOXTACT_COLUMN(CountRow, "touch", touch, "", "whether a fragment passes", Printed::No, kVerdictNames),
    VOXTACT_COLUMN(CountRow, "exactness", exactness, "", "meaning of the count", Printed::No,
                   "exact,lower-bound,refused"),
    VOXTACT_COLUMN(CountRow, "method", method, "", "counting method", Printed::No,
                   "query,query-any,atomic,subgroup,compute,cpu"),
    VOXTACT_COLUMN(CountRow, "projection", projection, "", "projection of the fragments", Printed::No,
                   "view,two-view,dominant-axis,certified"),
    VOXTACT_COLUMN(CountRow, "count", count, "", "passing fragments"),
};

constexpr std::array kTriangleColumns{
    VOXTACT_COLUMN(TouchedTriangle, "pair", pair, "", kPairText),
    VOXTACT_COLUMN(TouchedTriangle, "triangle", triangle, "", "number in the mesh"),
    VOXTACT_COLUMN(TouchedTriangle, "count", count, "", "its passing fragments"),
};

constexpr std::array kContactColumns{
    VOXTACT_COLUMN(Contact, "pair", pair, "", kPairText),
    VOXTACT_COLUMN(Contact, "triangle", triangle, "", "number in the mesh"),
    VOXTACT_COLUMN(Contact, "position", position, "mm", "world, on the triangle"),
    VOXTACT_COLUMN(Contact, "normal", normal, "", "unit vector in world space, out of the opaque region; or 0"),
    VOXTACT_COLUMN(Contact, "depth", depth, "mm", "along the normal to where the opacity ends"),
    VOXTACT_COLUMN(Contact, "value", value, "", "value of the image, in its own units"),
    VOXTACT_COLUMN(Contact, "opacity", opacity, "", "opacity of that value"),
    VOXTACT_COLUMN(Contact, "label", label, "", "label of the nearest voxel; 0: none"),
};

constexpr std::array kBoundsColumns{
    VOXTACT_COLUMN(Box, "lower", lo, "mm", "minimum corner of the world box of the passing fragments"),
    VOXTACT_COLUMN(Box, "upper", hi, "mm", "maximum corner; below the minimum without a passing fragment"),
};

constexpr std::array kLabelColumns{
    VOXTACT_COLUMN(LabelCount, "pair", pair, "", kPairText),
    VOXTACT_COLUMN(LabelCount, "label", label, "", "value in the label map"),
    VOXTACT_COLUMN(LabelCount, "count", count, "", "passing fragments at this label, at least 1"),
};

struct CountTotals {
    std::uint64_t contacts_found;
    double gpu_milliseconds, wall_milliseconds;
};
constexpr std::array kTotals{
    VOXTACT_COLUMN(CountTotals, "contacts_found", contacts_found, "",
                   "contacts found; more than listed if the list was cut"),
    VOXTACT_COLUMN(CountTotals, "gpu_milliseconds", gpu_milliseconds, "ms", "duration on the device; 0: not measured"),
    VOXTACT_COLUMN(CountTotals, "wall_milliseconds", wall_milliseconds, "ms", "duration of the call"),
};

CountRow toRow(const PairAnswer& pair) noexcept {
    return {pair.item,      pair.pose,   pair.hit ? Verdict::Yes : pair.possible ? Verdict::Undecided : Verdict::No,
            pair.exactness, pair.method, pair.projection,
            pair.count};
}

/// No box becomes the box that overlaps nothing.
Box toBox(const std::optional<Box>& bounds) noexcept {
    return bounds.value_or(Box{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}});
}

constexpr std::array kTables{TableLayout{"pairs", kColumns}, TableLayout{"triangles", kTriangleColumns},
                             TableLayout{"contacts", kContactColumns}, TableLayout{"bounds", kBoundsColumns},
                             TableLayout{"labels", kLabelColumns}};

Result<AnswerTables> askCount(cpu::HostEngine& engine, SettingReader& read, const cpu::Batch& batch) {
    Count question;
    Outputs& outputs = question.outputs;
    read("projection", question.projection)("boundary", question.boundary);
    read("triangles", outputs.triangles)("contacts", outputs.contacts)("bounds", outputs.bounds);
    read("labels", outputs.labels)("stop_at_first", question.stopAtFirst);
    read("samples_per_voxel", question.samplesPerVoxel)("resolution", question.resolution);
    read("max_depth", outputs.maxDepth)("max_contacts", question.maxContacts);
    return askRead(engine, question, read, batch);
}

} // namespace

AnswerTables toTables(BatchAnswer answer) {
    const CountTotals totals{answer.contactsFound, answer.gpuMilliseconds, answer.wallMilliseconds};
    return {{tableOf("pairs", kColumns, answer.pairs, toRow),
             tableOf("triangles", kTriangleColumns, std::move(answer.triangles)),
             tableOf("contacts", kContactColumns, std::move(answer.contacts)),
             tableOf("bounds", kBoundsColumns, answer.bounds, toBox),
             tableOf("labels", kLabelColumns, std::move(answer.labels)),
             tableOf("totals", kTotals, std::vector<CountTotals>{totals})},
            answer.counters};
}

extern const AskRow kAskCount;
constinit const AskRow kAskCount{{.name = "count",
                                  .text = "how many fragments pass, and where?",
                                  .help = R"(Output: pose,mesh,volume,touch,count,count_exact,method,projection
  touch   0 no, 1 yes, 2 undecided (certified only)
  count   passing fragments; if count_exact is 0, a lower bound
Outputs add columns: triangles; contacts,depth; labels; min_x,...,max_z.

Example:
  voxtact count --volume ct.nrrd --mesh tool.stl --contacts contacts.ply)",
                                  .tables = kTables},
                                 askCount};

} // namespace voxtact
