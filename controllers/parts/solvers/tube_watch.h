#pragma once
/// Tells when the problem of an axis is not feasible without softness, and when it is again: once
/// each.

namespace vinerow::controllers {

class TubeWatch {
 public:
  enum class News { kNone, kLeft, kBack };

  /// @param violation  of soft limits, as a share of the limit
  News update(double violation, double now_s) {
    if (!is_outside_ && violation > kLeft) {
      is_outside_ = true;
      left_at_s_ = now_s;
      return News::kLeft;
    }
    if (is_outside_ && violation < kBack) {
      is_outside_ = false;
      outside_s_ = now_s - left_at_s_;
      return News::kBack;
    }
    return News::kNone;
  }
  bool is_outside() const { return is_outside_; }
  /// Time that the last stay outside took. @pre the last update() said kBack
  double outside_s() const { return outside_s_; }

 private:
  // Soft limits give way by some 1e-7 of themselves where they hold.
  static constexpr double kLeft = 1e-3, kBack = 1e-5;

  bool is_outside_ = false;
  double left_at_s_ = 0.0, outside_s_ = 0.0;
};

}  // namespace vinerow::controllers
