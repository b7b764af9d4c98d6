#pragma once
/// Counts heap allocations of this thread while a guard lives, so that a test can say "a step
/// allocates nothing". Link vinerow_no_alloc to use it.

#include <cstddef>
#include <cstdint>

namespace vinerow::test {

class AllocationCounter {
 public:
  AllocationCounter();
  std::size_t count() const;  ///< allocations since construction

 private:
  std::uint64_t at_start_;
};

}  // namespace vinerow::test
