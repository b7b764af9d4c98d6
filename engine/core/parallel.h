#pragma once
/// Parallel loop over many items, with results that do not depend on the number of cores.

#include <cstddef>
#include <functional>

namespace vinerow {

/// Divides `count` items into chunks of `chunk` (the last may be shorter) and calls body(index of
/// the chunk, first item, end item) for each chunk, on up to std::thread::hardware_concurrency()
/// threads and in any order. Chunks are the same on every machine. If the caller stores each
/// chunk's result by its index and combines them in that order, the result has the same bits with
/// one thread or sixty-four.
/// @param chunk  >= 1 (demanded)
/// @throws the exception of the lowest chunk whose body failed; later chunks may be skipped
void for_chunks(
    std::size_t count, std::size_t chunk,
    const std::function<void(std::size_t index, std::size_t begin, std::size_t end)>& body);

}  // namespace vinerow
