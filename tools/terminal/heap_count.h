#pragma once
/// Number of heap allocations. A program that links this file counts them from its start.

#include <cstdint>

namespace vinerow::tools {

/// Allocations of this thread so far, those of Eigen and of libraries included; 0 under sanitizers,
/// which replace malloc themselves.
std::uint64_t heap_count();

/// False under sanitizers.
bool counts_heap();

}  // namespace vinerow::tools
