#pragma once
/// Statistics of the metric `estimation` for one estimator: errors, consistency, containment.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/messages/motion.h"
#include "engine/api/result_spec.h"
#include "engine/api/signal.h"
#include "engine/metrics/batch_means.h"
#include "engine/metrics/spread.h"

namespace vinerow::metrics {

/// Squared Mahalanobis distance within which 95 % of the errors of two coordinates are: chi-square
/// of 2 degrees, -2 ln 0.05.
inline constexpr double kInside95 = 5.991464547107979;

class EstimateJudge {
 public:
  /// Signals to read: those of the vehicle's own estimator, or an observer's.
  struct Signals {
    std::string estimate = "estimate";
    std::string ellipsoid = "ellipsoid";
    std::string state = "estimator_state";
  };
  /// Prefixes of the results' names: `error` + "lateral_rms_m", `other` + "nees_mean".
  struct Prefixes {
    std::string error = "estimate_";
    std::string other;
  };

  /// @param nis_sources  names <source> of the values nis_<source> to average
  /// @param margin       relative widening of the bounds of the mean NEES
  EstimateJudge(Signals signals, Prefixes prefixes, const std::vector<std::string>& nis_sources,
                double margin);
  void connect(Ports& ports);

  /// @param direction_rad  yaw of the longitudinal direction
  void step(Time now, const Odometry& truth, double direction_rad);
  /// Adds its results; estimation.h lists their names.
  void write_results(std::map<std::string, double>& all) const;

 private:
  /// Spread about zero and about the mean.
  struct ErrorSpread : Spread {
    double sum = 0.0;
    void add(double value) {
      Spread::add(value);
      sum += value;
    }
    double std() const;
  };
  struct Share {
    std::int64_t hits = 0, count = 0;
    void add(bool hit) {
      hits += hit;
      ++count;
    }
    double value() const {
      return count ? static_cast<double>(hits) / static_cast<double>(count) : kNotMeasured;
    }
  };
  struct Nis {
    std::string name;
    int at = -1;
    double last = 0.0, sum = 0.0;
    std::int64_t count = 0;
  };

  void judge(const Odometry& truth, const Odometry& estimate, double direction_rad);
  void add_error(const Eigen::Vector3d& e_W, double direction_rad, double yaw_error_rad);
  void add_nis(const NamedValues& state);
  double consistent() const;

  Signals signals_;
  Prefixes prefixes_;
  double margin_;
  std::uint64_t seen_ = 0;
  std::optional<bool> reports_between_;  ///< the first estimate came between two ticks
  bool has_last_ = false;
  Time last_time_;  ///< of the last sample of the truth
  Eigen::Vector3d last_p_W_ = Eigen::Vector3d::Zero();
  Eigen::Quaterniond last_q_WB_ = Eigen::Quaterniond::Identity();
  bool is_truth_ = true;
  std::int64_t equal_ = 0;  ///< number of samples so far that equalled the truth
  ErrorSpread lateral_, longitudinal_, vertical_, yaw_;
  BatchMeans nees_;
  Share inside_, contained_;
  std::vector<Nis> nis_;
  SignalReader<Odometry> estimate_;
  SignalReader<PositionEllipsoid> ellipsoid_;
  SignalReader<NamedValues> state_;
};

/// What write_results() adds.
std::vector<ResultSpec> judge_results(const EstimateJudge::Prefixes& prefixes);

/// Quantile of the chi-square distribution, also for fractional degrees of freedom. From 10 degrees
/// of freedom, the bounds of the 95 % interval are accurate to 1.5 %; below that the lower bound is
/// too low. E. B. Wilson, M. M. Hilferty, "The distribution of chi-square", 1931.
/// @param z  standard normal quantile of the wanted probability
double chi_square_quantile(double degrees_of_freedom, double z);

}  // namespace vinerow::metrics
