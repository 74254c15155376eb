// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/samples.h"
#ifdef VOXTACT_BENCH_IO
#include "voxtact/io.h"
#endif

#include <array>
#include <cstdint>
#include <cstdlib>
#include <iostream>

/// What a bench is asked by the environment: VOXTACT_BENCH_VOLUME names the volume (a file) where voxtact::io is built,
/// VOXTACT_BENCH_RAMP is the ramp "lo hi" in the volume's unit.
namespace voxtact::bench {

/// Ends the program where there is an error.
template <class Type> Type take(Result<Type> result) {
    if (!result.ok()) {
        std::cerr << result.error().text << '\n';
        std::exit(1);
    }
    return std::move(*result);
}

inline std::uint32_t numberFrom(const char* variable, std::uint32_t otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr ? otherwise : static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10));
}

/// The synthetic head where no other is named.
inline VolumeData volumeFromEnvironment() {
#ifdef VOXTACT_BENCH_IO
    if (const char* path = std::getenv("VOXTACT_BENCH_VOLUME"); path != nullptr) {
        return take(io::readVolume(path));
    }
#endif
    return take(makeBuiltinVolume("head:256"));
}

/// 40 to 80 where no other is asked for.
inline std::array<ControlPoint, 2> rampFromEnvironment() {
    double lo = 40;
    double hi = 80;
    if (const char* text = std::getenv("VOXTACT_BENCH_RAMP"); text != nullptr) {
        char* rest = nullptr;
        lo = std::strtod(text, &rest);
        hi = std::strtod(rest, nullptr);
    }
    return {ControlPoint{lo, 0}, ControlPoint{hi, 1}};
}

} // namespace voxtact::bench
