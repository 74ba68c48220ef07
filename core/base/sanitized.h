// Whether this is compiled for a sanitizer, which makes everything many times as long:
// LKS_SANITIZED is 1 with AddressSanitizer or ThreadSanitizer, 0 without.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define LKS_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define LKS_SANITIZED 1
#endif
#endif

#if !defined(LKS_SANITIZED)
#define LKS_SANITIZED 0
#endif
