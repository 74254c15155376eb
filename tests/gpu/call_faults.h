// SPDX-License-Identifier: MIT
#pragma once

#include "interception.h"

#include <volk.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace voxtact::test {

/// Which call fails instead of reaching the device: one at a time in a process.
struct CallFault {
    std::array<const char*, 2> functions{}; ///< by name, with their vk; null: none
    VkResult result = VK_ERROR_OUT_OF_HOST_MEMORY;
    std::uint32_t first = 1;   ///< the number of the first call that fails, from 1
    std::uint32_t failing = 1; ///< so many calls fail
    std::uint32_t calls = 0;   ///< that were made

    [[nodiscard]] bool fired() const noexcept { return calls >= first; }
};

inline CallFault callFault;

/// What a failed create leaves in its output.
inline constexpr std::uint64_t kGarbageHandle = 0xdeadbeef;

namespace detail {

inline bool callFails(const char* function) {
    for (const char* failing : callFault.functions) {
        if (failing != nullptr && std::strcmp(failing, function) == 0) {
            ++callFault.calls;
            return callFault.calls >= callFault.first && callFault.calls - callFault.first < callFault.failing;
        }
    }
    return false;
}

template <class Parameter> void leaveGarbage(Parameter) {}
template <class Handle>
requires(!std::is_const_v<Handle> && sizeof(Handle) == sizeof kGarbageHandle) void leaveGarbage(Handle* output) {
    std::memcpy(output, &kGarbageHandle, sizeof kGarbageHandle);
}

template <auto Member> struct FaultyCall;
template <class... Parameters, VkResult (VKAPI_PTR* VolkDeviceTable::*Member)(Parameters...)>
struct FaultyCall<Member> {
    static inline const char* name = nullptr;
    static inline VkResult(VKAPI_PTR* real)(Parameters...) = nullptr;

    static VkResult VKAPI_PTR call(Parameters... parameters) {
        if (!callFails(name)) {
            return real(parameters...);
        }
        (leaveGarbage(parameters), ...);
        return callFault.result;
    }
};

} // namespace detail

/// Lets `callFault` fail a function: faultyCall<&VolkDeviceTable::vkCreateFence>(loader, table, "vkCreateFence").
template <auto Member> void faultyCall(Interception& loader, const VolkDeviceTable& table, const char* name) {
    detail::FaultyCall<Member>::name = name;
    detail::FaultyCall<Member>::real = table.*Member;
    loader.replace(name, &detail::FaultyCall<Member>::call);
}

} // namespace voxtact::test
