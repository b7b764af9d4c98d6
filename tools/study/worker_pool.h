#pragma once
/// Processes that run cells, one at a time each. A cell that crashes, takes too long or too much
/// memory ends its process and nothing else; the next cell gets a new one.

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "engine/io/study.h"

namespace vinerow::study {

/// How a cell left its worker.
struct EndedCell {
  enum class How {
    kStored,     ///< its result is in its file
    kCrashed,    ///< the process ended
    kOutOfTime,  ///< the budget's
    kOutOfMemory,
    kNotStored  ///< the worker could not store the result, or the study has changed
  };
  std::size_t cell = 0;
  How how = How::kStored;
  std::string words;    ///< why, where it is not kStored
  double wall_s = 0.0;  ///< since it was given
};

class WorkerPool {
 public:
  /// @param command  of a worker: `vinerow study cell FILE --serve ...` @param count  >= 1
  WorkerPool(std::vector<std::string> command, int count, const io::CellBudget& budget);
  /// Ends all workers at once.
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  bool has_idle() const;
  bool is_busy() const;
  /// Starts a worker where none has been started. @pre has_idle() @throws WriteError
  void give(std::size_t cell, const std::string& identity);
  /// Cells that left since the last call; waits for the first, at most so long.
  std::vector<EndedCell> wait(double longest_s);

 private:
  struct Worker;
  void start(Worker& worker);
  void stop(Worker& worker);
  EndedCell end(Worker& worker, EndedCell::How how, std::string words);
  void read_answer(Worker& worker, std::vector<EndedCell>& ended);
  void check_budget(Worker& worker, std::vector<EndedCell>& ended);

  std::vector<std::string> command_;
  io::CellBudget budget_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace vinerow::study
