#pragma once
/// Threads that wait for the next batch of equal jobs.

#include <atomic>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

namespace vinerow::tasks {

/// for_chunks() of engine/core has one team of threads, on all cores, for the whole process. Here
/// each VectorEnv has as many as its user asks for.
class Workers {
 public:
  /// @param threads  the caller's included; >= 1
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// Calls job(i) for 0 <= i < count, each once, in any order, and waits for all of them.
  /// @throws the exception of the lowest i that failed
  void run(int count, const std::function<void(int)>& job);

 private:
  void serve();
  void take_jobs();

  const std::function<void(int)>* job_ = nullptr;
  int count_ = 0;
  std::vector<std::exception_ptr> failures_;
  std::atomic<int> next_ = 0;
  std::atomic<int> busy_ = 0;  ///< threads that have not finished the present batch
  std::atomic<std::uint64_t> batch_ = 0;
  std::atomic<bool> ending_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace vinerow::tasks
