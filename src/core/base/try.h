// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

/// VOXTACT_TRY(EXPRESSION): leaves the function with the error of EXPRESSION, a Result, when it holds one. What it
/// holds otherwise stays where it is: `auto mesh = readMesh(path); VOXTACT_TRY(mesh);`, and then `*mesh`.
#define VOXTACT_TRY(...)                                                                                               \
    do {                                                                                                               \
        if (const auto& voxtactTried = (__VA_ARGS__); !voxtactTried.ok()) {                                            \
            return voxtactTried.error();                                                                               \
        }                                                                                                              \
    } while (false)
