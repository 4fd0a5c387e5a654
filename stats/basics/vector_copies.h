#pragma once

// Internal: the compiler makes one copy of a loop for each of these machines and chooses when the
// program is loaded. Contraction is off and nothing is reassociated, so all give the same bits. Not
// under the address sanitizer, which is not ready when the choice is made.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define ASSAY_VECTOR_COPIES [[gnu::target_clones("default", "avx2", "avx512f")]]
#else
#define ASSAY_VECTOR_COPIES
#endif
