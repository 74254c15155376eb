// SPDX-License-Identifier: MIT
#include "view/model/shown/letters.h"

#include "view/model/files/source_paths.h"
#include "view/state.h"

#include <bit>
#include <cstddef>
#include <string>
#include <utility>

namespace voxtact::view {

namespace {

/// The letter whose first byte is at the beginning, and how many bytes it has: 1 and U+0000 where it is none.
std::pair<char32_t, std::size_t> firstLetter(std::string_view text) {
    const auto first = static_cast<unsigned char>(text.front());
    const auto bytes = static_cast<std::size_t>(std::countl_one(first));
    if (bytes < 2 || bytes > 4 || bytes > text.size()) {
        return {0, 1};
    }
    char32_t letter = first & (0x7FU >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        const auto next = static_cast<unsigned char>(text[i]);
        if ((next & 0xC0U) != 0x80U) {
            return {0, 1};
        }
        letter = letter << 6U | (next & 0x3FU);
    }
    return {letter, bytes};
}

void addOfDocument(const State& state, Letters& letters) {
    Sources sources = state.document.sources;
    for (const SourceMember& member : membersOf(sources)) {
        addLetters(*member.path, letters);
    }
    if (state.labels) {
        for (const auto& [label, name] : state.labels->names) {
            addLetters(name, letters);
        }
    }
}

void addOfQuestion(const Question& question, Letters& letters) {
    addLetters(question.text, letters);
    for (const MissingFile& file : question.files) {
        addLetters(file.path, letters);
    }
}

} // namespace

void addLetters(std::string_view text, Letters& letters) {
    constexpr char32_t kLatin1 = 0xFF;
    while (!text.empty()) {
        const auto [letter, bytes] = firstLetter(text);
        if (letter > kLatin1) {
            letters.insert(letter);
        }
        text.remove_prefix(bytes);
    }
}

Letters lettersOf(const State& state) {
    Letters letters;
    addOfDocument(state, letters);
    for (const std::string& path : state.recent) {
        addLetters(path, letters);
    }
    for (const std::string& note : state.notes) {
        addLetters(note, letters);
    }
    if (state.question) {
        addOfQuestion(*state.question, letters);
    }
    for (const std::string& text : {state.status, state.error, state.field.value_or(""), state.deviceName,
                                    state.loading ? state.loading->step : ""}) {
        addLetters(text, letters);
    }
    return letters;
}

} // namespace voxtact::view
