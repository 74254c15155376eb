// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace voxtact::test {

/// An argument that is refused in one line, in which all of these words are.
inline void expectRefusal(const Error& error, const std::vector<std::string>& words) {
    EXPECT_EQ(error.code, ErrorCode::InvalidArgument);
    EXPECT_EQ(error.text.find('\n'), std::string::npos);
    for (const std::string& word : words) {
        EXPECT_NE(error.text.find(word), std::string::npos) << "'" << word << "' is not in: " << error.text;
    }
}

} // namespace voxtact::test
