#include "tools/terminal/heap_count.h"

#include <cstddef>

namespace {

thread_local std::uint64_t allocations = 0;

}  // namespace

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VINEROW_COUNTS_HEAP false
#else
#define VINEROW_COUNTS_HEAP true

// Counting at malloc catches what operator new does not: Eigen's own allocations. The C library
// lets a program define these functions, and has its own under these names.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);

void* malloc(std::size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  ++allocations;
  return __libc_realloc(memory, size);
}
}
#endif

namespace vinerow::tools {

std::uint64_t heap_count() {
  return allocations;
}

bool counts_heap() {
  return VINEROW_COUNTS_HEAP;
}

}  // namespace vinerow::tools
