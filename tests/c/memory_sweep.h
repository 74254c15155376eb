// SPDX-License-Identifier: MIT
#pragma once

#include "failing_memory.h"
#include "voxtact/voxtact.h"

#include <gmock/gmock.h>

#include <cstdint>
#include <functional>
#include <iostream>

namespace voxtact::test {

using Call = std::function<vxt_result()>;

/// `call` again and again, each time with a later allocation that fails, until none is left to fail. `expectAnswer`
/// looks at what a call gave that succeeded. Returns how many failed.
inline std::size_t sweep(const Call& call, const std::function<void()>& expectAnswer, bool all) {
    // Some allocations are of the library's own making do: it goes on without.
    for (std::int64_t number = 0;; ++number) {
        FailingMemory memory(number, all);
        const vxt_result result = call();
        memory.end();
        if (memory.failures() == 0) {
            EXPECT_EQ(result, VXT_OK) << vxt_last_error(nullptr);
            expectAnswer();
            return static_cast<std::size_t>(number);
        }
        EXPECT_TRUE(result == VXT_ERROR_OUT_OF_MEMORY || result == VXT_OK) << "allocation " << number << ": " << result;
        if (result == VXT_OK) {
            expectAnswer();
        } else {
            EXPECT_THAT(vxt_last_error(nullptr), testing::HasSubstr("memory"));
        }
        if (testing::Test::HasFailure()) {
            return static_cast<std::size_t>(number);
        }
    }
}

inline void expectTight(const char* what, const Call& call, const std::function<void()>& expectAnswer) {
    const std::size_t one = sweep(call, expectAnswer, false);
    const std::size_t all = sweep(call, expectAnswer, true);
    std::cout << what << ": " << one << " and " << all << " allocations failed\n";
    EXPECT_GT(one, 0U);
    EXPECT_GT(all, 0U);
}

/// For a call that makes an object. `expectAnswer` looks at one.
template <class Handle>
void expectTightCreation(
    const char* what, void (*destroy)(Handle*), auto create,
    const std::function<void(const Handle&)>& expectAnswer = [](const Handle&) {}) {
    Handle* handle = nullptr;
    const auto end = [&] {
        destroy(handle);
        handle = nullptr;
    };
    expectTight(
        what,
        [&] {
            end();
            const vxt_result result = create(&handle);
            EXPECT_EQ(handle != nullptr, result == VXT_OK);
            return result;
        },
        [&] {
            ASSERT_NE(handle, nullptr);
            expectAnswer(*handle);
        });
    end();
}

} // namespace voxtact::test
