// Private: a function marked so is compiled twice, for any x86-64 and for those with AVX and FMA;
// the loader picks. Sums may differ by rounding between machines, never on one.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FPC_TARGET_CLONES __attribute__((target_clones("fma", "default")))
#else
#define FPC_TARGET_CLONES
#endif
