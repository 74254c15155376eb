// SPDX-License-Identifier: MIT
#pragma once

#include "voxtact/error.h"

/// VOXTACT_TRY(EXPRESSION): returns the error of EXPRESSION, a Result, if it holds one. A value stays in the Result:
/// `auto mesh = readMesh(path); VOXTACT_TRY(mesh);`, and then `*mesh`.
#define VOXTACT_TRY(...)                                                                                               \
    do {                                                                                                               \
        if (const auto& voxtactTried = (__VA_ARGS__); !voxtactTried.ok()) {                                            \
            return voxtactTried.error();                                                                               \
        }                                                                                                              \
    } while (false)
