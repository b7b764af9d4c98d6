#include "tests/support/no_alloc.h"

#include <cstdlib>

namespace {
thread_local std::size_t allocations = 0;
thread_local std::size_t at_start = 0;
}  // namespace

// Counting at malloc catches Eigen's own allocations too. The sanitizers replace malloc themselves:
// there the counter stays at zero and the tests of the release build speak.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
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

namespace vinerow::test {

AllocationCounter::AllocationCounter() {
  at_start = allocations;
}
AllocationCounter::~AllocationCounter() = default;
std::size_t AllocationCounter::count() const {
  return allocations - at_start;
}

}  // namespace vinerow::test
