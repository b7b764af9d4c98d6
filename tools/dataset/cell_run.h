#pragma once
/// Run of a cell that is watched for pictures.

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

#include "engine/sim/run_shelf.h"
#include "tools/dataset/dataset_task.h"
#include "tools/dataset/make_dataset.h"
#include "tools/dataset/picture_record.h"

namespace vinerow::dataset {

/// Counts pictures and asks whether to go on; for several threads.
class Counter {
 public:
  Counter(int most, const std::function<bool(int, int)>& drawn) : most_(most), drawn_(drawn) {}
  bool goes_on() const { return goes_on_; }
  void add() {
    const std::scoped_lock lock(mutex_);
    if (!drawn_(++done_, most_)) goes_on_ = false;
  }

 private:
  int most_;
  const std::function<bool(int, int)>& drawn_;
  std::mutex mutex_;
  int done_ = 0;
  std::atomic<bool> goes_on_ = true;
};

struct CellPictures {
  CellReport report;
  std::vector<PictureRecord> records;
};

/// Runs a cell to its end, or until it has enough pictures, and writes them below `out`. A run that
/// fails keeps the pictures it had, and its report says why. @throws WriteError
CellPictures run_cell(const DatasetTask& task, std::size_t cell, Split split,
                      const std::shared_ptr<RunShelf>& shelf, const std::filesystem::path& out,
                      Counter& counter);

}  // namespace vinerow::dataset
