#include "engine/sim/metrics/estimation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/math/angles.h"
#include "engine/math/deviation.h"
#include "engine/sim/metrics/batch_means.h"
#include "engine/sim/metrics/spread.h"

namespace vinerow {
namespace {

constexpr double kInside95 = 5.991464547107979;  // chi-square of 2 degrees: -2 ln 0.05
constexpr double kNormal95 = 1.959963984540054;  // two-sided

/// Spread about zero and about the mean.
struct ErrorSpread : Spread {
  double sum = 0.0;
  void add(double value) {
    Spread::add(value);
    sum += value;
  }
  double std() const {
    if (count == 0) return kNotMeasured;
    const double n = static_cast<double>(count), mean = sum / n;
    return std::sqrt(std::max(0.0, sum_squares / n - mean * mean));
  }
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

class Estimation final : public Metric {
 public:
  Estimation(const ParameterSet& parameters, const MetricContext& context)
      : from_(duration_from_s(parameters.number("from_s"))),
        row_reach_m_(parameters.number("row_reach_m")),
        margin_(parameters.number("nees_margin")) {
    for (const std::string& source : parameters.texts("nis")) nis_.push_back({"nis_" + source});
    if (context.world == nullptr) return;
    for (const PlantRow& row : context.world->rows.rows) {
      std::vector<Eigen::Vector2d> line;
      for (const Eigen::Vector3d& p : row.line_W) line.push_back(p.head<2>());
      if (line.size() >= 2) rows_.emplace_back(std::move(line));
    }
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    estimate_ = ports.read_optional<Odometry>("estimate");
    ellipsoid_ = ports.read_optional<PositionEllipsoid>("ellipsoid");
    state_ = ports.read_optional<NamedValues>("estimator_state");
  }

  void step(Time now) override {
    if (now - Time{} < from_) return;
    const Odometry& truth = truth_.value();
    if (estimate_.has_value() && estimate_.stamp() == now) judge(truth, estimate_.value());
    if (ellipsoid_.has_value() && ellipsoid_.stamp() == now) {
      contained_.add(contains(ellipsoid_.value(), truth.X_WB.p));
    }
    if (!nis_.empty() && state_.has_value()) add_nis();
  }

  std::map<std::string, double> results() const override {
    std::map<std::string, double> all{{"estimate_lateral_std_m", lateral_.std()},
                                      {"estimate_lateral_rms_m", lateral_.rms()},
                                      {"estimate_lateral_max_m", lateral_.max_or_nan()},
                                      {"estimate_longitudinal_std_m", longitudinal_.std()},
                                      {"estimate_longitudinal_rms_m", longitudinal_.rms()},
                                      {"estimate_longitudinal_max_m", longitudinal_.max_or_nan()},
                                      {"estimate_vertical_rms_m", vertical_.rms()},
                                      {"estimate_yaw_rms_deg", deg_from_rad(yaw_.rms())},
                                      {"nees_mean", nees_.mean()},
                                      {"nees_in_95_share", inside_.value()},
                                      {"estimate_consistent", consistent()},
                                      {"ellipsoid_containment_share", contained_.value()}};
    if (is_truth_) {
      for (auto& [name, value] : all) value = kNotMeasured;
    }
    for (const Nis& nis : nis_) {
      all[nis.name + "_mean"] = nis.count ? nis.sum / static_cast<double>(nis.count) : kNotMeasured;
    }
    return all;
  }

 private:
  void judge(const Odometry& truth, const Odometry& estimate) {
    const Eigen::Vector3d e_W = estimate.X_WB.p - truth.X_WB.p;
    const bool states_none = estimate.position_variance_m2.isZero(0.0);
    // Once anything differs, what was equal before was an estimate as well.
    is_truth_ = is_truth_ && states_none && e_W.isZero(0.0) &&
                estimate.X_WB.q.coeffs() == truth.X_WB.q.coeffs();
    if (is_truth_) {
      ++equal_;
      return;
    }
    for (; equal_ > 0; --equal_) add(Eigen::Vector3d::Zero(), 0.0, 0.0);
    add(e_W, direction_rad(truth),
        wrap_angle(yaw_from_quaternion(estimate.X_WB.q) - yaw_from_quaternion(truth.X_WB.q)));
    if (states_none) return;
    const Eigen::Matrix2d P = estimate.position_covariance().topLeftCorner<2, 2>();
    const Eigen::LLT<Eigen::Matrix2d> factor(P);
    // A covariance that is none contains nothing.
    const bool is_covariance = factor.info() == Eigen::Success;
    const double nees = is_covariance ? e_W.head<2>().dot(factor.solve(e_W.head<2>()))
                                      : std::numeric_limits<double>::infinity();
    nees_.add(nees);
    inside_.add(nees <= kInside95);
  }

  void add(const Eigen::Vector3d& e_W, double direction_rad, double yaw_error_rad) {
    const double c = std::cos(direction_rad), s = std::sin(direction_rad);
    longitudinal_.add(c * e_W.x() + s * e_W.y());
    lateral_.add(-s * e_W.x() + c * e_W.y());
    vertical_.add(e_W.z());
    yaw_.add(yaw_error_rad);
  }

  /// Of the nearest row, towards where the vehicle looks; its own where no row is near.
  double direction_rad(const Odometry& truth) const {
    const double yaw_rad = yaw_from_quaternion(truth.X_WB.q);
    double nearest_m = row_reach_m_, direction_rad = yaw_rad;
    for (const PolylineDistance& row : rows_) {
      const PolylineDistance::Nearest at = row.nearest(truth.X_WB.p.head<2>());
      if (at.distance_m > nearest_m) continue;
      const Eigen::Vector2d along = row.points()[at.segment + 1] - row.points()[at.segment];
      if (along.isZero(0.0)) continue;
      nearest_m = at.distance_m;
      direction_rad = std::atan2(along.y(), along.x());
      const bool looks_back = std::cos(direction_rad - yaw_rad) < 0.0;
      if (looks_back) direction_rad += kPi;
    }
    return direction_rad;
  }

  static bool contains(const PositionEllipsoid& ellipsoid, const Eigen::Vector3d& p_W) {
    const Eigen::Matrix3d P =
        symmetric_matrix(ellipsoid.shape_diagonal_m2, ellipsoid.shape_beside_m2);
    const Eigen::Vector3d d = p_W - ellipsoid.centre_W;
    if (P(2, 2) == 0.0) return contains<2>(P.topLeftCorner<2, 2>(), d.head<2>());
    return contains<3>(P, d);
  }
  template <int N>
  static bool contains(const Eigen::Matrix<double, N, N>& P, const Eigen::Matrix<double, N, 1>& d) {
    const Eigen::LLT<Eigen::Matrix<double, N, N>> factor(P);
    return factor.info() == Eigen::Success && d.dot(factor.solve(d)) <= 1.0;
  }

  double consistent() const {
    if (nees_.count() > 0 && !std::isfinite(nees_.mean())) return 0.0;
    const double n = nees_.independent_count();
    if (std::isnan(n)) return kNotMeasured;
    const double low = chi_square_quantile(2.0 * n, -kNormal95) / n * (1.0 - margin_);
    const double high = chi_square_quantile(2.0 * n, kNormal95) / n * (1.0 + margin_);
    return nees_.mean() >= low && nees_.mean() <= high ? 1.0 : 0.0;
  }

  struct Nis {
    std::string name;
    int at = -1;
    double last = 0.0, sum = 0.0;
    std::int64_t count = 0;
  };
  void add_nis() {
    const NamedValues& state = state_.value();
    for (Nis& nis : nis_) {
      if (nis.at < 0) {
        const auto found = std::find(state.names.begin(), state.names.end(), nis.name);
        if (found == state.names.end()) continue;
        nis.at = static_cast<int>(found - state.names.begin());
      }
      const double value = state.values[nis.at];
      if (value == nis.last) continue;
      nis.last = value;
      nis.sum += value;
      ++nis.count;
    }
  }

  Duration from_;
  double row_reach_m_;
  double margin_;
  std::vector<PolylineDistance> rows_;
  bool is_truth_ = true;
  std::int64_t equal_ = 0;  ///< samples that equalled the truth so far
  ErrorSpread lateral_, longitudinal_, vertical_, yaw_;
  BatchMeans nees_;
  Share inside_, contained_;
  std::vector<Nis> nis_;
  SignalReader<Odometry> truth_, estimate_;
  SignalReader<PositionEllipsoid> ellipsoid_;
  SignalReader<NamedValues> state_;
};

}  // namespace

double chi_square_quantile(double degrees_of_freedom, double z) {
  const double a = 2.0 / (9.0 * degrees_of_freedom);
  return degrees_of_freedom * std::pow(1.0 - a + z * std::sqrt(a), 3);
}

PartSpec estimation_spec() {
  PartSpec spec;
  spec.name = "estimation";
  spec.description =
      "Error of the estimate across and along the rows, and whether its covariance is right (NEES, "
      "NIS, containment)";
  spec.parameters = {
      number_parameter("from_s", "s", 3.0, 0.0, 1e6, "what comes before is left out"),
      number_parameter("row_reach_m", "m", 5.0, 0.0, 1e3,
                       "so near a row its direction is taken, else the heading"),
      number_parameter("nees_margin", "", 0.2, 0.0, 1.0,
                       "by how much the mean NEES may lie beyond its 95 % bounds: 0.2 forgives "
                       "standard deviations wrong by a tenth"),
      text_list_parameter(
          "nis", {"gnss_position", "gnss_velocity", "barometer", "magnetometer", "range", "wheels"},
          "sources whose NIS is averaged"),
  };
  spec.reads = {"truth", "estimate (optional)", "ellipsoid (optional)",
                "estimator_state (optional)"};
  spec.writes = {"estimate_lateral_std_m",
                 "estimate_lateral_rms_m",
                 "estimate_lateral_max_m",
                 "estimate_longitudinal_std_m",
                 "estimate_longitudinal_rms_m",
                 "estimate_longitudinal_max_m",
                 "estimate_vertical_rms_m",
                 "estimate_yaw_rms_deg",
                 "nees_mean",
                 "nees_in_95_share",
                 "estimate_consistent",
                 "ellipsoid_containment_share",
                 "nis_<source>_mean"};
  return spec;
}

std::unique_ptr<Metric> make_estimation(const ParameterSet& parameters,
                                        const MetricContext& context) {
  return std::make_unique<Estimation>(parameters, context);
}

}  // namespace vinerow
