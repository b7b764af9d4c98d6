#pragma once
/// Meter of the computing cost of work in this process.

#include <chrono>

#include "tools/study/cell.h"

namespace vinerow::study {

class CostMeter {
 public:
  /// Starts the measurement and resets the memory peak.
  CostMeter();
  /// Cost since the start.
  CellCost cost() const;

 private:
  std::chrono::steady_clock::time_point start_;
  double cpu_s_ = 0.0;
};

std::string host_name();

}  // namespace vinerow::study
