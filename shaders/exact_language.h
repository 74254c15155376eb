// SPDX-License-Identifier: MIT
// The words of the headers that are one text for GLSL and C++. Each includes this twice, before its functions and after
// them: the second time the words are taken away again, so that nobody else meets them. ROLLED loops stay loops in a
// shader that defines SMALL_PROGRAM, which is to compile soon rather than to run fast.
#ifndef EXACT

#ifdef __cplusplus
#define EXACT inline
#define PRECISE
#define OUT(type) type&
#define INOUT(type) type&
#define ARRAY(type, name, count) type(&name)[count]
#define ROLLED
#else
#define EXACT
#define PRECISE precise
#define OUT(type) out type
#define INOUT(type) inout type
#define ARRAY(type, name, count) inout type name[count]
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
#undef ROLLED

#endif
