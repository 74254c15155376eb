// SPDX-License-Identifier: MIT
#pragma once

/// VOXTACT_API marks what a shared build exports. Everything else is hidden.
#if defined(_WIN32)
#define VOXTACT_API
#else
#define VOXTACT_API __attribute__((visibility("default")))
#endif
