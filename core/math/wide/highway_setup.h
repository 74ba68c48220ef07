// How the project uses Highway: by its headers alone, for integers alone, with a choice of target
// of its own. To be included before any header of Highway.
#pragma once

#include "core/base/sanitized.h"

// The kernels use none of these instructions, so a processor without them still gets its widest
// target.
#define HWY_DISABLE_PCLMUL_AES
#define HWY_DISABLE_BMI2_FMA
#define HWY_DISABLE_F16C
// With sanitizers one target stands for all: they are one source, and take minutes to compile.
#if LKS_SANITIZED
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3)
#else
#define HWY_DISABLED_TARGETS HWY_SSSE3
#endif

// Highway's own asserts would need its library.
#define HWY_IS_DEBUG_BUILD 0

// Elsewhere than on x86 the target is the compiler's.
#if !defined(__x86_64__)
#define HWY_COMPILE_ONLY_STATIC
#endif
