#pragma once
/// Work on many items by all cores, with results that do not depend on how many there are.

#include <cstddef>
#include <functional>

namespace vinerow {

/// Cuts `count` items into chunks of `chunk` (the last may be shorter) and calls
/// body(index of the chunk, first item, item behind the last) for each, on up to
/// std::thread::hardware_concurrency() threads at once and in any order. Chunks are the same on
/// every machine: keep what each one makes by its index and put it together in that order, and the
/// result is the same bits with one thread or sixty-four.
/// @param chunk  >= 1 (demanded)
/// @throws what the body of the lowest chunk that failed has thrown; later chunks may be left out
void for_chunks(
    std::size_t count, std::size_t chunk,
    const std::function<void(std::size_t index, std::size_t begin, std::size_t end)>& body);

}  // namespace vinerow
