// SPDX-License-Identifier: MIT
#include "view/model/shown/letters.h"

#include "view/state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace voxtact::test {

using namespace voxtact::view;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

Letters of(std::string_view text) {
    Letters letters;
    addLetters(text, letters);
    return letters;
}

} // namespace

TEST(ViewLetters, AreThoseBeyondLatin1) {
    EXPECT_THAT(of("tool \xC3\xA9.stl"), IsEmpty()); // U+00E9
    EXPECT_THAT(of("\xCF\x89 and \xE8\x84\x91, \xF0\x9F\xA7\xA0"), ElementsAre(0x3C9, 0x8111, 0x1F9E0));
}

TEST(ViewLetters, WhatIsNoUtf8IsLeftOut) {
    EXPECT_THAT(of("\x84\xE8\x84"), IsEmpty());
    EXPECT_THAT(of("\xE8\x84"), IsEmpty());
    EXPECT_THAT(of("\xE8z\x91\xCF\x89"), ElementsAre(0x3C9));
    EXPECT_THAT(of("\xFF\xFE\xF8\x88\x80\x80\x80"), IsEmpty());
}

TEST(ViewLetters, AreOfFilesLabelsAndMessages) {
    State state;
    const auto isShown = [&state](char32_t letter) { return lettersOf(state).contains(letter); };
    EXPECT_THAT(lettersOf(state), IsEmpty());
    state.document.sources.volume = "\xCE\xB1.nii";
    EXPECT_TRUE(isShown(0x3B1));
    state.document.sources.meshes = {{"a.stl"}, {"\xCE\xB2.stl"}};
    EXPECT_TRUE(isShown(0x3B2));
    state.labels = Labels{{}, {{7, "\xCE\xB3"}}};
    EXPECT_TRUE(isShown(0x3B3));
    state.recent = {"\xCE\xB4"};
    EXPECT_TRUE(isShown(0x3B4));
    state.error = "\xCE\xB5";
    EXPECT_TRUE(isShown(0x3B5));
    state.field = "\xCE\xB6";
    EXPECT_TRUE(isShown(0x3B6));
    state.question = Question{};
    state.question->files = {{"mesh", "\xCE\xB7"}};
    EXPECT_TRUE(isShown(0x3B7));
    state.loading = Loading{};
    state.loading->step = "reading \xCE\xB8";
    EXPECT_TRUE(isShown(0x3B8));
}

} // namespace voxtact::test
