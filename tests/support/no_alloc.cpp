#include "tests/support/no_alloc.h"

#include "tools/terminal/heap_count.h"

namespace vinerow::test {

// Under the sanitizers the counter stays at zero, and the tests of the release build speak.
AllocationCounter::AllocationCounter() : at_start_(tools::heap_count()) {}

std::size_t AllocationCounter::count() const {
  return tools::heap_count() - at_start_;
}

}  // namespace vinerow::test
