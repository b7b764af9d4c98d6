#pragma once
/// Eight floats side by side. In a function compiled for AVX they are one register, else two: the
/// operations, and so the bits, are the same.

#include <cstdint>
#if defined(__x86_64__)
#include <emmintrin.h>
#endif

#include "engine/physics/vector4.h"

namespace vinerow::physics {

typedef float Float8 __attribute__((vector_size(32)));
typedef std::int32_t Mask8 __attribute__((vector_size(32)));  ///< all bits of an element, or none

// Vectors pass by reference, as those of vector4.h.
VINEROW_ALWAYS_INLINE void load8(const float (&from)[8], Float8& to) {
  __builtin_memcpy(&to, from, sizeof to);
}

/// Bit i: element i is set.
VINEROW_ALWAYS_INLINE unsigned bits_of(const Mask8& mask) {
#if defined(__x86_64__)
  __m128 low, high;
  __builtin_memcpy(&low, &mask, sizeof low);
  __builtin_memcpy(&high, reinterpret_cast<const char*>(&mask) + sizeof low, sizeof high);
  return static_cast<unsigned>(_mm_movemask_ps(low) | (_mm_movemask_ps(high) << 4));
#else
  unsigned bits = 0;
  for (int i = 0; i < 8; ++i) bits |= static_cast<unsigned>(mask[i] & 1) << i;
  return bits;
#endif
}

/// Bit i: number i of eight is not zero.
VINEROW_ALWAYS_INLINE unsigned bits_of_eight(const int* numbers) {
  Mask8 values;
  __builtin_memcpy(&values, numbers, sizeof values);
  return bits_of(values != 0);
}

}  // namespace vinerow::physics
