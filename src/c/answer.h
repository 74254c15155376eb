// SPDX-License-Identifier: MIT
#pragma once

#include "c/errors.h"
#include "voxtact/cpu.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace voxtact::c {

/// A column of a table: where it is in a row.
struct ColumnFacts {
    const char* table;
    const char* name;
    const char* unit;
    const char* text;
    const char* choices;
    vxt_type type;
    std::uint32_t elements;
    std::size_t offset;
};

/// A table of an answer, whose rows are structs.
struct AnswerTable {
    std::span<const ColumnFacts> columns;
    std::shared_ptr<const void> memory; ///< keeps `data`
    const std::byte* data = nullptr;
    std::size_t rows = 0;
    std::size_t stride = 0;
};

} // namespace voxtact::c

struct vxt_answer {
    std::vector<voxtact::c::AnswerTable> tables;
    std::optional<voxtact::CertifiedCounters> counters;
};

namespace voxtact::c {

// The C interface's form of each answer.
[[nodiscard]] vxt_answer toAnswer(const TouchAnswer& answer);
[[nodiscard]] vxt_answer toAnswer(const BatchAnswer& answer);
[[nodiscard]] vxt_answer toAnswer(const DistanceAnswer& answer);
[[nodiscard]] vxt_answer toAnswer(const AreaAnswer& answer);
[[nodiscard]] vxt_answer toAnswer(const OverlapAnswer& answer);
[[nodiscard]] vxt_answer toAnswer(const MotionAnswer& answer);
[[nodiscard]] vxt_answer toAnswer(const PlanAnswer& answer);

} // namespace voxtact::c
