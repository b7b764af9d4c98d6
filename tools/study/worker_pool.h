#pragma once
/// Pool of processes that each run one cell at a time. A cell that crashes or exceeds its time or
/// memory budget ends only its process; the next cell gets a new one.

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "engine/scenario/study.h"
#include "tools/study/cell_runner.h"

namespace vinerow::study {

class WorkerPool final : public CellRunner {
 public:
  /// @param command  command of a worker: `vinerow study cell FILE --serve ...` @param count  >= 1
  WorkerPool(std::vector<std::string> command, int count, const scenario::CellBudget& budget);
  /// Ends all workers at once.
  ~WorkerPool() override;
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  bool has_free_slot() const override;
  bool is_busy() const override;
  /// Starts a worker if necessary.
  void give(std::size_t cell, const std::string& identity) override;
  std::vector<EndedCell> wait(double longest_s) override;

 private:
  struct Worker;
  void start(Worker& worker);
  void stop(Worker& worker);
  EndedCell end(Worker& worker, EndedCell::How how, std::string words);
  void read_answer(Worker& worker, std::vector<EndedCell>& ended);
  void check_budget(Worker& worker, std::vector<EndedCell>& ended);

  std::vector<std::string> command_;
  scenario::CellBudget budget_;
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace vinerow::study
