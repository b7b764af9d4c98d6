#pragma once
/// Four doubles side by side. In a function compiled for AVX they are one register, else two: the
/// operations, and so the bits, are the same.

#include <cstdint>
#if defined(__x86_64__)
#include <emmintrin.h>
#endif

/// Compiled into its caller, with the caller's instructions.
#define VINEROW_ALWAYS_INLINE inline __attribute__((always_inline))

namespace vinerow::physics {

typedef double Double4 __attribute__((vector_size(32)));
typedef std::int64_t Mask4 __attribute__((vector_size(32)));  ///< all bits of an element, or none

// Vectors pass by reference: how they are returned depends on the instructions.
VINEROW_ALWAYS_INLINE void load4(const float (&from)[4], Double4& to) {
  to = Double4{from[0], from[1], from[2], from[3]};
}

VINEROW_ALWAYS_INLINE void store4(const Double4& from, double (&to)[4]) {
  __builtin_memcpy(to, &from, sizeof from);
}

/// Bit i: element i is set.
VINEROW_ALWAYS_INLINE unsigned bits_of(const Mask4& mask) {
#if defined(__x86_64__)
  __m128d low, high;
  __builtin_memcpy(&low, &mask, sizeof low);
  __builtin_memcpy(&high, reinterpret_cast<const char*>(&mask) + sizeof low, sizeof high);
  return static_cast<unsigned>(_mm_movemask_pd(low) | (_mm_movemask_pd(high) << 2));
#else
  unsigned bits = 0;
  for (int i = 0; i < 4; ++i) bits |= static_cast<unsigned>(mask[i] & 1) << i;
  return bits;
#endif
}

}  // namespace vinerow::physics
