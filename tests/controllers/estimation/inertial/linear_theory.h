#pragma once
/// Exact statistics of the filters between rows where they are linear: without a map.

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "controllers/estimation/row_localisation/distance_filter_law.h"
#include "tests/controllers/estimation/row_localisation/localisation_lab.h"

namespace vinerow::test {

/// Linear theory of a filter without a map, for one axis. It takes only the settings of the filter
/// under test. The gain follows from the noise in these settings, whatever the true noise is:
/// P+ = (I - K H) P. The true covariance S is propagated with that gain and the true noise:
/// S+ = (I - K H) S (I - K H)' + K R_true K' (Gelb, Applied Optimal Estimation, 1974, chapter 7).
class LinearTheory {
 public:
  struct Share {
    double fixes = 1.0, velocity = 1.0;
  };
  explicit LinearTheory(
      Share share, controllers::InertialReading reading = controllers::InertialReading::kVelocity) {
    const LabSetup setup;
    const controllers::PositionKalmanParams params = controllers::kalman_params_of(reading);
    const bool is_velocity = reading == controllers::InertialReading::kVelocity;
    const double dt = 0.01, keep = std::exp(-dt / setup.velocity_time_s);
    const double stated = setup.velocity_std_mps * setup.velocity_std_mps,
                 assumed = is_velocity ? stated : 0.0,
                 met = share.velocity * share.velocity * stated;
    const Eigen::Matrix2d F{{1.0, dt}, {0.0, keep}};
    const double start = setup.start_std_m * setup.start_std_m;
    Eigen::Matrix2d P{{start, 0.0}, {0.0, assumed}}, S{{start, 0.0}, {0.0, met}};
    const int ticks = static_cast<int>(std::lround(setup.duration_s / dt));
    for (int k = 0; k <= ticks; ++k) {
      Eigen::Matrix2d A = Eigen::Matrix2d::Identity();
      if (k > 0) {
        A = F;
        P = F * P * F.transpose();
        P(0, 0) += params.walk_m2_per_s * dt;  // assumed only: there is no such noise
        P(1, 1) += assumed * (1.0 - keep * keep);
        S = F * S * F.transpose();
        S(1, 1) += met * (1.0 - keep * keep);
      }
      const auto correct = [&](double std_m, double factor) {
        const double R = std_m * std_m;
        const Eigen::Vector2d K = P.col(0) / (P(0, 0) + R);
        Eigen::Matrix2d B = Eigen::Matrix2d::Identity();
        B.col(0) -= K;
        P = B * P;
        S = B * S * B.transpose() + factor * factor * R * K * K.transpose();
        A = B * A;
      };
      if (reading == controllers::InertialReading::kPositionFix)
        correct(setup.inertial_std_m.x(), 1.0);
      if (k % setup.fix_every == 0) correct(setup.fix_std_m.x(), share.fixes);
      steps_.push_back(A);
      reported_.push_back(P(0, 0));
      met_.push_back(S);
    }
    // Errors of a filter of velocities last for seconds, those of one that takes a fix a tick not.
    add_up(is_velocity ? 10 : 1);
  }
  double mean_square_m2() const { return mean_square_; }
  /// Of both horizontal axes, which are alike.
  double nees() const { return 2.0 * nees_; }
  /// Standard deviations of the means over one flight: Gaussian errors e_i, e_j of covariance C_ij
  /// have squares of covariance 2 C_ij^2.
  double mean_square_std_m2() const { return mean_square_std_; }
  double nees_std() const { return std::sqrt(2.0) * nees_std_; }

 private:
  /// @param stride  ticks between two samples of the standard deviations
  void add_up(std::size_t stride) {
    constexpr std::size_t kFirst = 300;  // 3 s are left out
    const std::size_t n = met_.size();
    for (std::size_t i = kFirst; i < n; ++i) {
      mean_square_ += met_[i](0, 0) / static_cast<double>(n - kFirst);
      nees_ += met_[i](0, 0) / reported_[i] / static_cast<double>(n - kFirst);
    }
    double squares = 0.0, shares = 0.0, count = 0.0;
    for (std::size_t j = kFirst; j < n; j += stride, count += 1.0) {
      Eigen::Matrix2d C = met_[j];
      for (std::size_t i = j; i < n; ++i) {
        if (i > j) C = steps_[i] * C;
        if ((i - j) % stride != 0) continue;
        const double twice = i == j ? 1.0 : 2.0;
        squares += twice * 2.0 * C(0, 0) * C(0, 0);
        shares += twice * 2.0 * C(0, 0) * C(0, 0) / (reported_[i] * reported_[j]);
      }
    }
    mean_square_std_ = std::sqrt(squares) / count;
    nees_std_ = std::sqrt(shares) / count;
  }

  std::vector<Eigen::Matrix2d> steps_;  ///< error of a tick from that of the tick before
  std::vector<double> reported_;        ///< variance of the position as the filter sees it
  std::vector<Eigen::Matrix2d> met_;
  double mean_square_ = 0.0, nees_ = 0.0, mean_square_std_ = 0.0, nees_std_ = 0.0;
};

}  // namespace vinerow::test
