// SPDX-License-Identifier: MIT
#include "c/answer.h"

#include "c/convert.h"
#include "voxtact/voxtact_vulkan.h"

#include <string_view>

namespace voxtact::c {
namespace {

static_assert(VXT_TYPE_UINT32 == static_cast<int>(ColumnType::Uint32));
static_assert(VXT_TYPE_INT32 == static_cast<int>(ColumnType::Int32));
static_assert(VXT_TYPE_UINT64 == static_cast<int>(ColumnType::Uint64));
static_assert(VXT_TYPE_DOUBLE == static_cast<int>(ColumnType::Double));

vxt_column toColumn(const AnswerTable& table, const Column& facts) noexcept {
    vxt_column out{};
    out.table = table.name;
    out.name = facts.name;
    out.unit = facts.unit;
    out.text = facts.text;
    out.choices = facts.choices;
    out.data = table.rows == 0 ? nullptr : table.data + facts.offset;
    out.rows = table.rows;
    out.stride = table.stride;
    out.type = static_cast<vxt_type>(facts.type);
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
    return create(answer, [] { return AnswerTables(); });
}

void vxt_answer_destroy(vxt_answer* answer) {
    delete answer;
}

size_t vxt_answer_columns(const vxt_answer* answer) {
    std::size_t count = 0;
    for (const AnswerTable& table :
         answer == nullptr ? std::span<const AnswerTable>() : std::span(answer->object.tables)) {
        count += table.columns.size();
    }
    return count;
}

vxt_result vxt_answer_column(const vxt_answer* answer, size_t index, vxt_column* column) {
    return call([&] {
        std::size_t left = index;
        for (const AnswerTable& table : need(answer, "answer").object.tables) {
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
        for (const AnswerTable& one : need(answer, "answer").object.tables) {
            const Column* const facts = one.name == inTable ? one.column(wanted) : nullptr;
            if (facts != nullptr) {
                return writeStruct(column, toColumn(one, *facts), "column");
            }
        }
        refuse(ErrorCode::NotReady,
               "the answer has no column '" + std::string(wanted) + "' in a table '" + std::string(inTable) + "'");
    });
}
