// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/voxtact.h"

#include <gmock/gmock.h>

#include <string>
#include <tuple>
#include <type_traits>

namespace voxtact::test {

/// A refusal with a text of one line that names what is null.
inline void expectNullRefused(vxt_result result) {
    EXPECT_EQ(result, VXT_ERROR_INVALID_ARGUMENT) << vxt_last_error(nullptr);
    EXPECT_THAT(vxt_last_error(nullptr), testing::HasSubstr("null"));
    EXPECT_EQ(std::string(vxt_last_error(nullptr)).find('\n'), std::string::npos);
}

/// Calls a function with null or 0 for everything.
template <class... Arguments> void expectNullRefused(vxt_result (*function)(Arguments...)) {
    expectNullRefused(function(Arguments{}...));
}

/// Calls each function like expectNullRefused() and, if it makes an object, with a place for it, too: the place is then
/// null.
template <class... Functions> void expectAllNullRefused(Functions... functions) {
    std::size_t number = 0;
    const auto expectOne = [&]<class... Arguments>(vxt_result (*function)(Arguments...)) {
        SCOPED_TRACE("function " + std::to_string(number++));
        expectNullRefused(function);
        std::tuple<Arguments...> arguments{};
        auto& last = std::get<sizeof...(Arguments) - 1>(arguments);
        using Object = std::remove_pointer_t<std::remove_reference_t<decltype(last)>>;
        if constexpr (std::is_pointer_v<Object> && sizeof...(Arguments) > 1) {
            alignas(std::max_align_t) std::byte memory[64];
            auto place = reinterpret_cast<Object>(memory);
            last = &place;
            expectNullRefused(std::apply(function, arguments));
            EXPECT_EQ(place, nullptr);
        }
    };
    (expectOne(functions), ...);
}

/// Each ends nothing.
template <class... Functions> void endNothing(Functions... functions) {
    (functions(nullptr), ...);
}

} // namespace voxtact::test
