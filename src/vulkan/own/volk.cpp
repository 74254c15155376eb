// SPDX-License-Identifier: MIT
// volk's own code, compiled in this one place.
#define VOLK_IMPLEMENTATION
#include <volk.h>
