// SPDX-License-Identifier: MIT
#include "viewer/model/shown/keystrokes.h"

#include <gtest/gtest.h>

namespace voxtact::test {

using view::Keystrokes;

TEST(ViewKeystrokes, AFrameHasTheLettersUpToTheFirstKey) {
    constexpr int kBackspace = 259;
    Keystrokes strokes;
    EXPECT_FALSE(strokes.behind());
    for (const char letter : {'1', '2'}) {
        strokes.addLetter(static_cast<unsigned>(letter));
    }
    strokes.addKey(kBackspace);
    strokes.addKey(kBackspace);
    strokes.addLetter('3');
    const Keystrokes::Frame first = strokes.next();
    EXPECT_EQ(first.letters, (std::vector<unsigned>{'1', '2'}));
    EXPECT_EQ(first.key, kBackspace);
    EXPECT_TRUE(strokes.behind());
    EXPECT_TRUE(strokes.waits(kBackspace));
    const Keystrokes::Frame second = strokes.next();
    EXPECT_TRUE(second.letters.empty());
    EXPECT_EQ(second.key, kBackspace);
    EXPECT_FALSE(strokes.waits(kBackspace));
    const Keystrokes::Frame third = strokes.next();
    EXPECT_EQ(third.letters, (std::vector<unsigned>{'3'}));
    EXPECT_FALSE(third.key);
    EXPECT_FALSE(strokes.behind());
    EXPECT_TRUE(strokes.next().letters.empty());
}

} // namespace voxtact::test
