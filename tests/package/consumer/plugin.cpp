// SPDX-License-Identifier: MIT
// A library that has voxtact inside.
#include "voxtact/detector.h"

extern "C" bool usable() {
    return voxtact::check({}).usable;
}
