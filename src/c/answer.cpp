// SPDX-License-Identifier: MIT
#include "c/answer.h"

#include "c/answer_rows.h"
#include "c/convert.h"
#include "core/base/infinity.h"
#include "voxtact/voxtact_vulkan.h"

#include <limits>
#include <string_view>

namespace voxtact::c {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

template <class Row> AnswerTable tableOf(std::span<const ColumnFacts> columns, std::vector<Row> rows) {
    const auto kept = std::make_shared<const std::vector<Row>>(std::move(rows));
    return {columns, kept, reinterpret_cast<const std::byte*>(kept->data()), kept->size(), sizeof(Row)};
}

/// A table of the results of `toRow`.
template <class From, class ToRow>
AnswerTable tableOf(std::span<const ColumnFacts> columns, const std::vector<From>& from, const ToRow& toRow) {
    std::vector<decltype(toRow(from.front()))> rows;
    rows.reserve(from.size());
    std::ranges::transform(from, std::back_inserter(rows), toRow);
    return tableOf(columns, std::move(rows));
}

template <class Row> AnswerTable totalsOf(std::span<const ColumnFacts> columns, const Row& row) {
    return tableOf(columns, std::vector<Row>{row});
}

template <std::size_t size> void put(double (&out)[size], const std::array<double, size>& from) noexcept {
    std::ranges::copy(from, out);
}

CountRow toRow(const PairAnswer& pair) noexcept {
    CountRow out{};
    out.item = pair.item;
    out.pose = pair.pose;
    out.touch = static_cast<std::uint32_t>(pair.hit ? Verdict::Yes : pair.possible ? Verdict::Undecided : Verdict::No);
    out.exactness = static_cast<std::uint32_t>(pair.exactness);
    out.method = static_cast<std::uint32_t>(pair.method);
    out.projection = static_cast<std::uint32_t>(pair.projection);
    out.count = pair.count;
    return out;
}

ContactRow toContact(const Contact& contact) noexcept {
    ContactRow out{};
    out.pair = contact.pair;
    out.triangle = contact.triangle;
    put(out.position, contact.position);
    put(out.normal, contact.normal);
    out.depth = contact.depth;
    out.value = contact.value;
    out.opacity = contact.opacity;
    out.label = contact.label;
    return out;
}

/// No box becomes the box that overlaps nothing.
BoundsRow toBounds(const std::optional<Box>& bounds) noexcept {
    BoundsRow out{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    if (bounds) {
        put(out.lower, bounds->lo);
        put(out.upper, bounds->hi);
    }
    return out;
}

DistanceRow toDistance(const PairDistance& pair) noexcept {
    DistanceRow out{};
    out.item = pair.item;
    out.pose = pair.pose;
    out.end = static_cast<std::uint32_t>(pair.end);
    out.lower = pair.bounds.lower;
    out.upper = pair.bounds.upper;
    if (pair.closest) {
        out.witness = 1;
        out.triangle = pair.closest->triangle;
        put(out.on_mesh, pair.closest->mesh);
        put(out.in_volume, pair.closest->volume);
        put(out.per_translation, pair.closest->perTranslation);
        put(out.per_rotation, pair.closest->perRotation);
    }
    return out;
}

template <class Label> LabelRow toLabel(const Label& label) noexcept {
    return {label.pair,  label.item,         label.pose,        static_cast<std::uint32_t>(label.end),
            label.label, label.bounds.lower, label.bounds.upper};
}

SegmentRow toSegment(const SegmentMotion& segment) noexcept {
    SegmentRow out{};
    out.item = segment.item;
    out.pose = segment.pose;
    out.touch = static_cast<std::uint32_t>(segment.touch      ? Verdict::Yes
                                           : segment.possible ? Verdict::Undecided
                                                              : Verdict::No);
    out.end = static_cast<std::uint32_t>(segment.end);
    out.toi_lower = segment.freeUntil;
    out.toi_upper = kNone;
    if (segment.touch) {
        out.triangle = segment.touch->triangle;
        out.toi_upper = segment.touch->at;
        put(out.point, segment.touch->position);
        put(out.world_from_object, segment.touch->world_from_object);
    }
    return out;
}

PathRow toPath(const PlannedPath& path) noexcept {
    PathRow out{};
    out.entry = path.entry;
    out.safe = static_cast<std::uint32_t>(path.safety);
    out.end = static_cast<std::uint32_t>(path.end);
    out.lower = path.clearance.lower;
    out.upper = path.clearance.upper;
    out.length = path.length;
    out.angle = path.angle.value_or(kNone);
    put(out.position, path.position);
    if (path.nearest) {
        out.near = 1;
        out.obstacle = path.nearest->obstacle;
        out.label = path.nearest->label;
        put(out.nearest, path.nearest->position);
        put(out.on_path, path.nearest->onPath);
    }
    return out;
}

} // namespace

vxt_answer toAnswer(const TouchAnswer& answer) {
    return {{tableOf(kTouchColumns, answer.pairs,
                     [](const PairTouch& pair) {
                         TouchRow out{pair.item, pair.pose, static_cast<std::uint32_t>(pair.touch), 0, 0, {}};
                         if (pair.witness) {
                             out.witness = 1;
                             out.triangle = pair.witness->triangle;
                             put(out.point, pair.witness->position);
                         }
                         return out;
                     }),
             totalsOf(kTotals, Totals{answer.wallMilliseconds})},
            {}};
}

vxt_answer toAnswer(const BatchAnswer& answer) {
    return {
        {tableOf(kCountColumns, answer.pairs, toRow),
         tableOf(kTriangleCountColumns, answer.triangles,
                 [](const TouchedTriangle& triangle) {
                     return TriangleCountRow{triangle.pair, triangle.triangle, triangle.count};
                 }),
         tableOf(kContactColumns, answer.contacts, toContact), tableOf(kBoundsColumns, answer.bounds, toBounds),
         tableOf(kLabelCountColumns, answer.labels,
                 [](const LabelCount& label) {
                     return LabelCountRow{label.pair, label.label, label.count};
                 }),
         totalsOf(kCountTotals, CountTotals{answer.contactsFound, answer.gpuMilliseconds, answer.wallMilliseconds})},
        answer.counters};
}

vxt_answer toAnswer(const DistanceAnswer& answer) {
    return {{tableOf(kDistanceColumns, answer.pairs, toDistance),
             tableOf(kLabelDistanceColumns, answer.labels, toLabel<LabelDistance>),
             totalsOf(kTotals, Totals{answer.wallMilliseconds})},
            {}};
}

vxt_answer toAnswer(const AreaAnswer& answer) {
    return {{tableOf(kAreaColumns, answer.pairs,
                     [](const PairArea& pair) {
                         return AreaRow{pair.item, pair.pose, static_cast<std::uint32_t>(pair.end), pair.bounds.lower,
                                        pair.bounds.upper};
                     }),
             tableOf(kTriangleAreaColumns, answer.triangles,
                     [](const TriangleArea& one) {
                         return TriangleAreaRow{one.pair, one.triangle, one.whole, one.bounds.lower, one.bounds.upper};
                     }),
             tableOf(kLabelAreaColumns, answer.labels, toLabel<LabelArea>),
             totalsOf(kTotals, Totals{answer.wallMilliseconds})},
            {}};
}

vxt_answer toAnswer(const OverlapAnswer& answer) {
    const auto number = [](auto choice) { return static_cast<std::uint32_t>(choice); };
    return {{tableOf(kOverlapColumns, answer.pairs,
                     [&](const PairOverlap& pair) {
                         return OverlapRow{pair.item,         pair.pose,         number(pair.inside), number(pair.end),
                                           pair.bounds.lower, pair.bounds.upper, pair.solid.lower,    pair.solid.upper};
                     }),
             tableOf(kBandColumns, answer.bands,
                     [&](const BandOverlap& band) {
                         return BandRow{band.pair,        band.item,         band.pose,        band.band,
                                        number(band.end), band.bounds.lower, band.bounds.upper};
                     }),
             tableOf(kLabelOverlapColumns, answer.labels,
                     [&](const LabelOverlap& one) {
                         return LabelOverlapRow{one.pair,        one.item,  one.pose,         number(one.inside),
                                                number(one.end), one.label, one.bounds.lower, one.bounds.upper};
                     }),
             totalsOf(kTotals, Totals{answer.wallMilliseconds})},
            {}};
}

vxt_answer toAnswer(const MotionAnswer& answer) {
    return {{tableOf(kSegmentColumns, answer.segments, toSegment), totalsOf(kTotals, Totals{answer.wallMilliseconds})},
            {}};
}

vxt_answer toAnswer(const PlanAnswer& answer) {
    return {
        {tableOf(kPathColumns, answer.paths, toPath),
         tableOf(kEntryTriangleColumns, answer.triangles,
                 [](const EntryTriangle& triangle) {
                     return EntryTriangleRow{{triangle.paths[0], triangle.paths[1], triangle.paths[2]},
                                             triangle.safe ? 1U : 0U,
                                             triangle.clearance};
                 }),
         totalsOf(kPlanTotals, PlanTotals{answer.directions, answer.noSurface, answer.onBorder, answer.tooLong,
                                          answer.tooOblique, answer.area, answer.safeArea, answer.wallMilliseconds})},
        {}};
}

namespace {

vxt_column toColumn(const AnswerTable& table, const ColumnFacts& facts) noexcept {
    vxt_column out{};
    out.table = facts.table;
    out.name = facts.name;
    out.unit = facts.unit;
    out.text = facts.text;
    out.choices = facts.choices;
    out.data = table.rows == 0 ? nullptr : table.data + facts.offset;
    out.rows = table.rows;
    out.stride = table.stride;
    out.type = facts.type;
    out.elements = facts.elements;
    out.offset = facts.offset;
    return out;
}

} // namespace
} // namespace voxtact::c

using namespace voxtact;
using namespace voxtact::c;

static_assert(sizeof(vxt_device_pair) == sizeof(PairResult) && sizeof(vxt_device_contact) == sizeof(ContactResult));

vxt_result vxt_unpack(const vxt_device_pair* packed, vxt_pair* pair) {
    return call([&] {
        const vxt_device_pair& from = need(packed, "packed");
        const PairAnswer answer = unpack({from.count_low, from.count_high, from.pair, from.item, from.pose, from.how});
        vxt_pair& out = need(pair, "pair");
        out = {};
        out.count = answer.count;
        out.pair = answer.pair;
        out.item = answer.item;
        out.pose = answer.pose;
        out.hit = answer.hit ? 1 : 0;
        out.possible = answer.possible ? 1 : 0;
        out.exactness = number<vxt_exactness>(answer.exactness);
        out.method = number<vxt_method>(answer.method);
        out.projection = number<vxt_projection>(answer.projection);
    });
}

vxt_result vxt_answer_create(vxt_answer** answer) {
    return create(answer, [] { return vxt_answer(); });
}

void vxt_answer_destroy(vxt_answer* answer) {
    delete answer;
}

size_t vxt_answer_columns(const vxt_answer* answer) {
    std::size_t count = 0;
    for (const AnswerTable& table : answer == nullptr ? std::span<const AnswerTable>() : std::span(answer->tables)) {
        count += table.columns.size();
    }
    return count;
}

vxt_result vxt_answer_column(const vxt_answer* answer, size_t index, vxt_column* column) {
    return call([&] {
        std::size_t left = index;
        for (const AnswerTable& table : need(answer, "answer").tables) {
            if (left < table.columns.size()) {
                return writeStruct(column, toColumn(table, table.columns[left]), "column");
            }
            left -= table.columns.size();
        }
        refuse(ErrorCode::NotReady, "the answer has no column " + std::to_string(index));
    });
}

vxt_result vxt_answer_find(const vxt_answer* answer, const char* table, const char* name, vxt_column* column) {
    return call([&] {
        const std::string_view inTable = &need(table, "table");
        const std::string_view wanted = &need(name, "name");
        for (const AnswerTable& one : need(answer, "answer").tables) {
            for (const ColumnFacts& facts : one.columns) {
                if (facts.table == inTable && facts.name == wanted) {
                    return writeStruct(column, toColumn(one, facts), "column");
                }
            }
        }
        refuse(ErrorCode::NotReady,
               "the answer has no column '" + std::string(wanted) + "' in a table '" + std::string(inTable) + "'");
    });
}
