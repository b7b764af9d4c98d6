#pragma once
/// Parallel loop over many items, with results that do not depend on the number of cores.

#include <cstddef>
#include <functional>

namespace vinerow {

using ChunkBody = std::function<void(std::size_t index, std::size_t begin, std::size_t end)>;

/// Divides `count` items into chunks of `chunk` (the last may be shorter) and calls body(index of
/// the chunk, first item, end item) for each chunk, on up to std::thread::hardware_concurrency()
/// threads and in any order. Chunks are the same on every machine. If the caller stores each
/// chunk's result by its index and combines them in that order, the result has the same bits with
/// one thread or sixty-four.
///
/// A loop within a chunk of a loop of several threads, or while another thread's loop runs, takes
/// no further threads. The process keeps its threads: after the first loop none allocates memory.
/// @param chunk  >= 1 (demanded)
/// @throws the exception of the lowest chunk whose body failed; later chunks may be skipped
void for_chunks(std::size_t count, std::size_t chunk, const ChunkBody& body);

/// For a thread that works beside others of its kind: while this object lives, loops of this thread
/// use its share of the cores.
class ShareOfCores {
 public:
  /// @param threads  that share the cores, >= 1 (demanded)
  explicit ShareOfCores(std::size_t threads);
  ~ShareOfCores();
  ShareOfCores(const ShareOfCores&) = delete;
  ShareOfCores& operator=(const ShareOfCores&) = delete;

 private:
  std::size_t before_;
};

/// Largest number of threads of a loop that this thread starts.
std::size_t most_threads();

/// Within a chunk: number of its thread, below the number of threads of the loop. For buffers, of
/// which each thread has its own.
std::size_t thread_in_loop();

}  // namespace vinerow
