#pragma once
/// What the program holds on its heap, as glibc counts it.

#include <malloc.h>

#include <cstddef>

namespace vinerow::test {

/// Bytes in use; 0 where another allocator stands in, as that of a sanitizer.
inline std::size_t heap_bytes() {
  const struct mallinfo2 info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
}

}  // namespace vinerow::test
