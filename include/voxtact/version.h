/* SPDX-License-Identifier: MIT */
#ifndef VOXTACT_VERSION_H
#define VOXTACT_VERSION_H

/// @file
/// Version of voxtact, for the preprocessor; C and C++. CMake reads it here.

#define VOXTACT_VERSION_MAJOR 0 ///< increases when interfaces break; below 1 the minor version does
#define VOXTACT_VERSION_MINOR 1 ///< minor version
#define VOXTACT_VERSION_PATCH 0 ///< patch version
/// Version as one comparable number: 1.2.3 is 10203.
#define VOXTACT_VERSION_NUMBER (VOXTACT_VERSION_MAJOR * 10000 + VOXTACT_VERSION_MINOR * 100 + VOXTACT_VERSION_PATCH)

#endif
