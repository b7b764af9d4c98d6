#pragma once
/// What a piece of work of this process takes.

#include <chrono>

#include "tools/study/cell.h"

namespace vinerow::study {

class CostMeter {
 public:
  /// Begins. Peaks of memory before this are forgotten.
  CostMeter();
  /// Since then.
  CellCost cost() const;

 private:
  std::chrono::steady_clock::time_point start_;
  double cpu_s_ = 0.0;
};

std::string host_name();

}  // namespace vinerow::study
