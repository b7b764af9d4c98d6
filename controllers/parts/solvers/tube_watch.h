#pragma once
/// Detects when the problem of an axis becomes infeasible without soft limits, and when it is
/// feasible again: one event each.

namespace vinerow::controllers {

class TubeWatch {
 public:
  enum class PendingEvent { kNone, kLeft, kBack };

  /// @param violation  of soft limits, as a share of the limit
  PendingEvent update(double violation, double now_s) {
    if (!is_outside_ && violation > kLeft) {
      is_outside_ = true;
      left_at_s_ = now_s;
      return PendingEvent::kLeft;
    }
    if (is_outside_ && violation < kBack) {
      is_outside_ = false;
      outside_s_ = now_s - left_at_s_;
      return PendingEvent::kBack;
    }
    return PendingEvent::kNone;
  }
  bool is_outside() const { return is_outside_; }
  /// Duration of the last stay outside. @pre the last update() returned kBack
  double outside_s() const { return outside_s_; }

 private:
  // Satisfied soft limits are violated by some 1e-7 of themselves.
  static constexpr double kLeft = 1e-3, kBack = 1e-5;

  bool is_outside_ = false;
  double left_at_s_ = 0.0, outside_s_ = 0.0;
};

}  // namespace vinerow::controllers
