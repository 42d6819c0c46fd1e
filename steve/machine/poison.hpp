// Memory that nobody may touch, told to AddressSanitizer; without it these functions do nothing.
#pragma once

#include <cstddef>

// g++ defines a macro, clang++ has a feature.
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define BREVE_ADDRESS_SANITIZER 1
#endif
#endif
#if defined(__SANITIZE_ADDRESS__)
#define BREVE_ADDRESS_SANITIZER 1
#endif

#if defined(BREVE_ADDRESS_SANITIZER)
#include <sanitizer/asan_interface.h>
#endif

namespace breve::steve {

#if defined(BREVE_ADDRESS_SANITIZER)
constexpr bool kPoisonIsSeen = true;
inline void poison(const void* memory, std::size_t bytes) { ASAN_POISON_MEMORY_REGION(memory, bytes); }
inline void unpoison(const void* memory, std::size_t bytes) { ASAN_UNPOISON_MEMORY_REGION(memory, bytes); }
#else
constexpr bool kPoisonIsSeen = false;
inline void poison(const void*, std::size_t) {}
inline void unpoison(const void*, std::size_t) {}
#endif

}  // namespace breve::steve
