/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VERSION_H
#define VOXTACT_VERSION_H

/// @file
/// Which voxtact this is, for the preprocessor; C and C++. CMake reads it here.

#define VOXTACT_VERSION_MAJOR 0 ///< interfaces may break where it rises, and below 1 where the minor version does
#define VOXTACT_VERSION_MINOR 1 ///< of a major version
#define VOXTACT_VERSION_PATCH 0 ///< of a minor version
/// As one number that can be compared: 1.2.3 is 10203.
#define VOXTACT_VERSION_NUMBER (VOXTACT_VERSION_MAJOR * 10000 + VOXTACT_VERSION_MINOR * 100 + VOXTACT_VERSION_PATCH)

#endif
