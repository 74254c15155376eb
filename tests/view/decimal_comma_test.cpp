// SPDX-License-Identifier: MIT
#include "viewer/model/document/decimal_comma.h"

#include <gtest/gtest.h>

namespace voxtact::test {

using namespace voxtact::view;

TEST(ViewDecimalComma, IsAPointInANumberAndStaysInAPath) {
    EXPECT_EQ(typedCharacter(',', false), unsigned{'.'});
    EXPECT_EQ(typedCharacter(',', true), unsigned{','});
    EXPECT_EQ(typedCharacter('5', false), unsigned{'5'});
    EXPECT_EQ(pastedText("-1,5", false), "-1.5");
    EXPECT_EQ(pastedText("a,b.nii", true), "a,b.nii");
}

} // namespace voxtact::test
