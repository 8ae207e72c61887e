#pragma once

/// Loops that a compiler turns into vector code: a function marked with TENDRIL_LANES is compiled for several
/// vector units, and the widest one that the machine has is taken when the program starts. Where every
/// operation is elementwise and none is contracted, the bits do not depend on which.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define TENDRIL_LANES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define TENDRIL_LANES
#endif
#define TENDRIL_INLINE inline __attribute__((always_inline))

#if defined(__clang__)
#define TENDRIL_LOOP _Pragma("clang loop vectorize(assume_safety)")
#define TENDRIL_UNROLL _Pragma("unroll")
#else
#define TENDRIL_LOOP _Pragma("GCC ivdep")
#define TENDRIL_UNROLL _Pragma("GCC unroll 4")
#endif
