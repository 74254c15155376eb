// SPDX-License-Identifier: MIT
// The words of the headers that are one text for GLSL and C++. Each includes this twice, before its functions and after
// them: the second time the words are taken away again, so that nobody else meets them. ROLLED loops, which have few
// rounds, stay loops in a shader that defines SMALL_PROGRAM, which is to compile soon rather than to run fast; in C++
// they are unrolled, so that what they fill stays in registers. An array that is HANDED on from function to function,
// HAND(name), is a global of that name in GLSL: an array that is an argument is copied to the function and back, and
// llvmpipe makes more of the copies than of what the functions do. UNKNOWN_ROUNDS stands before a loop over an array
// whose rounds a shader's compiler can only guess: it would unroll the loop, into more than all else. Shaders need
// GL_EXT_control_flow_attributes.
#ifndef EXACT

#ifdef __cplusplus
#define EXACT inline
#define PRECISE
#define OUT(type) type&
#define INOUT(type) type&
#define ARRAY(type, name, count) type(&name)[count]
#define HANDED(type, name, count) , type(&name)[count]
#define HAND(name) , name
#define UNKNOWN_ROUNDS
#if defined(__clang__)
#define ROLLED _Pragma("clang loop unroll_count(4)")
#elif defined(__GNUC__)
#define ROLLED _Pragma("GCC unroll 4")
#else
#define ROLLED
#endif
#else
#define EXACT
#define PRECISE precise
#define OUT(type) out type
#define INOUT(type) inout type
#define ARRAY(type, name, count) inout type name[count]
#define HANDED(type, name, count)
#define HAND(name)
#define UNKNOWN_ROUNDS [[dont_unroll]]
#ifdef SMALL_PROGRAM
#define ROLLED [[dont_unroll]]
#else
#define ROLLED
#endif
#endif

#else

#undef EXACT
#undef PRECISE
#undef OUT
#undef INOUT
#undef ARRAY
#undef HANDED
#undef HAND
#undef ROLLED
#undef UNKNOWN_ROUNDS

#endif
