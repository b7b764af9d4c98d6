#include "engine/metrics/estimate_judge.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "engine/math/angles.h"

namespace vinerow::metrics {
namespace {

/// Upper limit of a NEES sample: ten sigma. Chosen: beyond it the filter is lost, and unlimited
/// values would dominate the mean.
constexpr double kMaxNees = 100.0;
constexpr double kNormal95 = 1.959963984540054;  // two-sided

template <int N>
bool is_inside(const Eigen::Matrix<double, N, N>& P, const Eigen::Matrix<double, N, 1>& d) {
  const Eigen::LLT<Eigen::Matrix<double, N, N>> factor(P);
  return factor.info() == Eigen::Success && d.dot(factor.solve(d)) <= 1.0;
}

bool is_inside(const PositionEllipsoid& ellipsoid, const Eigen::Vector3d& p_W) {
  const Eigen::Matrix3d P =
      symmetric_matrix(ellipsoid.shape_diagonal_m2, ellipsoid.shape_beside_m2);
  const Eigen::Vector3d d = p_W - ellipsoid.centre_W;
  if (P(2, 2) == 0.0) return is_inside<2>(P.topLeftCorner<2, 2>(), d.head<2>());
  return is_inside<3>(P, d);
}

}  // namespace

double EstimateJudge::ErrorSpread::std() const {
  if (count == 0) return kNotMeasured;
  const double n = static_cast<double>(count), mean = sum / n;
  return std::sqrt(std::max(0.0, sum_squares / n - mean * mean));
}

EstimateJudge::EstimateJudge(Signals signals, Prefixes prefixes,
                             const std::vector<std::string>& nis_sources, double margin)
    : signals_(std::move(signals)), prefixes_(std::move(prefixes)), margin_(margin) {
  for (const std::string& source : nis_sources) nis_.push_back({"nis_" + source});
}

void EstimateJudge::connect(Ports& ports) {
  estimate_ = ports.read_optional<Odometry>(signals_.estimate);
  ellipsoid_ = ports.read_optional<PositionEllipsoid>(signals_.ellipsoid);
  state_ = ports.read_optional<NamedValues>(signals_.state);
}

void EstimateJudge::step(Time now, const Odometry& truth, double direction_rad) {
  const bool is_new = estimate_.has_value() && estimate_.is_newer_than(seen_);
  const bool is_at_tick = estimate_.has_value() && estimate_.stamp() == now;
  const bool is_between = is_new && has_last_ && !is_at_tick && estimate_.stamp() > last_time_;
  // An estimator of the run begins at a tick, and only its estimates at ticks count. A firmware
  // reports when its own clock says so.
  if (!reports_between_ && (is_at_tick || is_between)) reports_between_ = is_between;
  if (is_at_tick) {
    judge(truth, estimate_.value(), direction_rad);
  } else if (is_between && *reports_between_) {
    // The truth of that instant lies between two samples, near enough to the straight line.
    const double share = (estimate_.stamp() - last_time_).s() / (now - last_time_).s();
    Odometry between;
    between.X_WB.p = (1.0 - share) * last_p_W_ + share * truth.X_WB.p;
    between.X_WB.q = last_q_WB_.slerp(share, truth.X_WB.q);
    judge(between, estimate_.value(), direction_rad);
  }
  has_last_ = true;
  last_time_ = now;
  last_p_W_ = truth.X_WB.p;
  last_q_WB_ = truth.X_WB.q;
  if (ellipsoid_.has_value() && ellipsoid_.stamp() == now) {
    contained_.add(is_inside(ellipsoid_.value(), truth.X_WB.p));
  }
  if (!nis_.empty() && state_.has_value()) add_nis(state_.value());
}

void EstimateJudge::judge(const Odometry& truth, const Odometry& estimate, double direction_rad) {
  const Eigen::Vector3d e_W = estimate.X_WB.p - truth.X_WB.p;
  const bool states_none = estimate.position_variance_m2.isZero(0.0);
  // When the first sample differs, the equal samples before it count as estimates too.
  is_truth_ = is_truth_ && states_none && e_W.isZero(0.0) &&
              estimate.X_WB.q.coeffs() == truth.X_WB.q.coeffs();
  if (is_truth_) {
    ++equal_;
    return;
  }
  for (; equal_ > 0; --equal_) add_error(Eigen::Vector3d::Zero(), 0.0, 0.0);
  add_error(e_W, direction_rad,
            wrap_angle(yaw_from_quaternion(estimate.X_WB.q) - yaw_from_quaternion(truth.X_WB.q)));
  if (states_none) return;
  const Eigen::Matrix2d P = estimate.position_covariance().topLeftCorner<2, 2>();
  const Eigen::LLT<Eigen::Matrix2d> factor(P);
  // An invalid covariance contains no error.
  const bool is_covariance = factor.info() == Eigen::Success;
  const double nees = is_covariance
                          ? std::min(kMaxNees, e_W.head<2>().dot(factor.solve(e_W.head<2>())))
                          : std::numeric_limits<double>::infinity();
  nees_.add(nees);
  inside_.add(nees <= kInside95);
}

void EstimateJudge::add_error(const Eigen::Vector3d& e_W, double direction_rad,
                              double yaw_error_rad) {
  const double c = std::cos(direction_rad), s = std::sin(direction_rad);
  longitudinal_.add(c * e_W.x() + s * e_W.y());
  lateral_.add(-s * e_W.x() + c * e_W.y());
  vertical_.add(e_W.z());
  yaw_.add(yaw_error_rad);
}

void EstimateJudge::add_nis(const NamedValues& state) {
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

double EstimateJudge::consistent() const {
  if (nees_.count() > 0 && !std::isfinite(nees_.mean())) return 0.0;
  const double n = nees_.independent_count();
  if (std::isnan(n)) return kNotMeasured;
  const double low = chi_square_quantile(2.0 * n, -kNormal95) / n * (1.0 - margin_);
  const double high = chi_square_quantile(2.0 * n, kNormal95) / n * (1.0 + margin_);
  return nees_.mean() >= low && nees_.mean() <= high ? 1.0 : 0.0;
}

void EstimateJudge::write_results(std::map<std::string, double>& all) const {
  const auto set_result = [&](const std::string& name, double value) {
    all[name] = is_truth_ ? kNotMeasured : value;
  };
  set_result(prefixes_.error + "lateral_std_m", lateral_.std());
  set_result(prefixes_.error + "lateral_rms_m", lateral_.rms());
  set_result(prefixes_.error + "lateral_max_m", lateral_.max_or_nan());
  set_result(prefixes_.error + "longitudinal_std_m", longitudinal_.std());
  set_result(prefixes_.error + "longitudinal_rms_m", longitudinal_.rms());
  set_result(prefixes_.error + "longitudinal_max_m", longitudinal_.max_or_nan());
  set_result(prefixes_.error + "vertical_rms_m", vertical_.rms());
  set_result(prefixes_.error + "yaw_rms_deg", deg_from_rad(yaw_.rms()));
  set_result(prefixes_.error + "consistent", consistent());
  set_result(prefixes_.other + "nees_mean", nees_.mean());
  set_result(prefixes_.other + "nees_in_95_share", inside_.value());
  set_result(prefixes_.other + "ellipsoid_containment_share", contained_.value());
  for (const Nis& nis : nis_) {
    all[prefixes_.other + nis.name + "_mean"] =
        nis.count ? nis.sum / static_cast<double>(nis.count) : kNotMeasured;
  }
}

std::vector<ResultSpec> judge_results(const EstimateJudge::Prefixes& prefixes) {
  using Range = ResultRange;
  const auto& [error, other] = prefixes;
  return {
      {error + "lateral_std_m", "m", Range::from_zero(), "lateral error standard deviation",
       "Standard deviation, about the mean, of the estimated minus the true position across the "
       "nearest row (within row_reach_m, 5 m; otherwise across the true heading). Samples start at "
       "from_s (3 s); null if the estimate is the truth.",
       "paper C, table 3"},
      {error + "lateral_rms_m", "m", Range::from_zero(), "RMS lateral estimation error",
       "Root mean square of the estimated minus the true position across the nearest row.",
       "paper C, table 3"},
      {error + "lateral_max_m", "m", Range::from_zero(), "max lateral estimation error",
       "Largest absolute error of the estimated position across the nearest row.",
       "paper C, table 3"},
      {error + "longitudinal_std_m", "m", Range::from_zero(),
       "longitudinal error standard deviation",
       "Standard deviation, about the mean, of the estimated minus the true position along the "
       "nearest row.",
       "paper C, table 3"},
      {error + "longitudinal_rms_m", "m", Range::from_zero(), "RMS longitudinal estimation error",
       "Root mean square of the estimated minus the true position along the nearest row.",
       "paper C, table 3"},
      {error + "longitudinal_max_m", "m", Range::from_zero(), "max longitudinal estimation error",
       "Largest absolute error of the estimated position along the nearest row.",
       "paper C, table 3"},
      {error + "vertical_rms_m", "m", Range::from_zero(), "RMS height estimation error",
       "Root mean square of the estimated minus the true height.", "paper C, §3"},
      {error + "yaw_rms_deg", "deg", Range::zero_to(180.0), "RMS heading estimation error",
       "Root mean square of the estimated minus the true yaw.", "paper C, §3"},
      {other + "nees_mean", "1", Range::zero_to(kMaxNees), "mean NEES",
       "Mean normalised estimation error squared e'P⁻¹e of the horizontal position error e with "
       "the stated covariance P, each sample limited to 100. A consistent estimator has 2; null if "
       "it states no covariance.",
       "Bar-Shalom, Li, Kirubarajan 2001, §5.4"},
      {other + "nees_in_95_share", "1", Range::share(), "samples inside 95 % ellipse",
       "Fraction of the samples with the true position inside the estimator's 95 % ellipse (e'P⁻¹e "
       "at most 5.991).",
       "Bar-Shalom, Li, Kirubarajan 2001, §5.4"},
      {error + "consistent", "1", Range::zero_or_one(), "estimator consistent",
       "1 if the mean NEES is within the 95 % chi-square bounds for the effective number of "
       "samples (batch means), widened by nees_margin (0.2), else 0.",
       "Bar-Shalom, Li, Kirubarajan 2001, §5.4"},
      {other + "ellipsoid_containment_share", "1", Range::share(), "samples inside guaranteed set",
       "Fraction of the sets in the signal `ellipsoid` that contain the true position. Sets "
       "without height are checked in the horizontal plane.",
       "paper C, fig. 9"},
      {other + "nis_<source>_mean", "1", Range::from_zero(), "mean NIS of one source",
       "Mean normalised innovation squared of the named measurement source, from the signal "
       "`estimator_state`. A consistent filter has the number of components of the source.",
       "Bar-Shalom, Li, Kirubarajan 2001, §5.4"}};
}

double chi_square_quantile(double degrees_of_freedom, double z) {
  const double a = 2.0 / (9.0 * degrees_of_freedom);
  return degrees_of_freedom * std::pow(1.0 - a + z * std::sqrt(a), 3);
}

}  // namespace vinerow::metrics
