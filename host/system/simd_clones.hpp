// Marks functions that are compiled for several instruction sets, of which one is chosen when the program starts.
// Sanitizers are not ready when that choice is made.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define NUTIK_SIMD_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define NUTIK_SIMD_CLONES
#endif
