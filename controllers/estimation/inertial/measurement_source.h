#pragma once
/// Statistics of one source of measurements: counts, NIS, and the variance inflation of correlated
/// readings.

#include <algorithm>
#include <cstdint>

#include "controllers/estimation/inertial/error_state_kalman.h"

namespace vinerow::controllers {

class MeasurementSource {
 public:
  /// Whether the reading is newer than the one before. Counts it as rejected if it is not.
  bool is_newer(Time stamp) {
    if (has_last_ && stamp <= last_) {
      reject();
      return false;
    }
    return true;
  }
  /// Factor on the variance of a reading whose error has the correlation time tau: max(1, 2 tau /
  /// T), with T the time since the reading before. n readings then weigh as much as their number of
  /// independent errors.
  double inflation(Time stamp, double correlation_s) const {
    if (!has_last_ || correlation_s <= 0.0) return 1.0;
    return std::max(1.0, 2.0 * correlation_s / (stamp - last_).s());
  }
  void take(Time stamp, const Correction& correction) {
    last_ = stamp;
    has_last_ = true;
    if (!correction.used()) {
      reject();
      return;
    }
    ++used_;
    rejected_in_a_row_ = 0;
    last_used_ = stamp;
    nis_ = correction.nis;
  }
  void reject() {
    ++rejected_;
    ++rejected_in_a_row_;
  }
  /// Restarts the count of rejections and the time since the last use.
  void reset_rejections(Time now) {
    rejected_in_a_row_ = 0;
    last_used_ = now;
  }

  std::int64_t used() const { return used_; }
  std::int64_t rejected() const { return rejected_; }
  std::int64_t rejected_in_a_row() const { return rejected_in_a_row_; }
  Time last_used() const { return last_used_; }
  double nis() const { return nis_; }  ///< of the last reading used; 0 before

 private:
  std::int64_t used_ = 0, rejected_ = 0, rejected_in_a_row_ = 0;
  double nis_ = 0.0;
  bool has_last_ = false;
  Time last_, last_used_;
};

}  // namespace vinerow::controllers
