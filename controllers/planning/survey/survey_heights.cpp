#include "controllers/planning/survey/survey_heights.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vinerow::controllers {
namespace {

// Chosen: finer than the terrain's detail that matters at survey heights.
constexpr double kSurveyStep_m = 1.0;  // between samples
// Samples of a piece at most: the work of split_piece grows with their square. Chosen.
constexpr double kMaxSamples = 800.0;
// A step count may exceed a whole number by this rounding. Chosen.
constexpr double kCountRounding = 1e-9;
// Share of the allowed error that ramps use; the rest is for the ground between samples. Chosen.
constexpr double kErrorShare = 0.98;
// Sums of squared lengths that differ by less are equal. Chosen, above their rounding.
constexpr double kSameSquares_m2 = 1e-6;

/// Ramps over one piece, samples first to last, both included: appends their end points.
///
/// Samples i at distance s_i with the wanted height w_i. A ramp from i to j > i is allowed if
///
///   |w_i + m (s_k - s_i) - w_k| <= e for all i < k < j,   m = (w_j - w_i) / (s_j - s_i)
///
/// that is if m is in the intersection of the intervals (w_k - w_i -+ e) / (s_k - s_i), which
/// `low` and `high` hold while j advances. Dynamic programming over j minimises the number of ramps
/// N, then the sum Q of their squared lengths, which is smallest if they are even:
///
///   (N, Q)_j = min over allowed i of (N_i + 1, Q_i + (s_j - s_i)^2)
void split_piece(const std::vector<GroundProfile::Sample>& samples,
                 const std::vector<double>& wanted_m, int first, int last, double error_m,
                 std::vector<int>& points) {
  const int count = last - first + 1;
  struct Best {
    int ramps = std::numeric_limits<int>::max();
    double squares_m2 = 0.0;  // sum of the ramps' squared lengths
    int before = -1;
  };
  std::vector<Best> best(count);
  best[0].ramps = 0;
  for (int i = 0; i + 1 < count; ++i) {
    // Slopes of ramps from i that miss none of the samples between by more than allowed.
    double low = -std::numeric_limits<double>::infinity(), high = -low;
    for (int j = i + 1; j < count; ++j) {
      const double run_m = samples[first + j].distance_m - samples[first + i].distance_m;
      const double rise_m = wanted_m[first + j] - wanted_m[first + i];
      const double slope = rise_m / run_m;
      const double squares_m2 = best[i].squares_m2 + run_m * run_m;
      const int ramps = best[i].ramps + 1;
      if (slope >= low && slope <= high &&
          (ramps < best[j].ramps ||
           (ramps == best[j].ramps && squares_m2 < best[j].squares_m2 - kSameSquares_m2))) {
        best[j] = {ramps, squares_m2, i};
      }
      low = std::max(low, (rise_m - error_m) / run_m);
      high = std::min(high, (rise_m + error_m) / run_m);
      if (low > high) break;
    }
  }
  std::vector<int> found;
  for (int j = count - 1; j > 0; j = best[j].before) found.push_back(first + j);
  points.insert(points.end(), found.rbegin(), found.rend());
}

}  // namespace

Result<GroundProfile> GroundProfile::make(const std::vector<Eigen::Vector2d>& line,
                                          const GroundHeight& ground) {
  GroundProfile profile;
  std::vector<bool> known;
  const auto add = [&](const Eigen::Vector2d& p, double distance_m) {
    const std::optional<double> height_m = ground(p);
    known.push_back(height_m.has_value());
    profile.samples_.push_back({distance_m, height_m.value_or(0.0), p});
  };
  double distance_m = 0.0;
  add(line.front(), 0.0);
  profile.at_point_.push_back(0);
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const Eigen::Vector2d displacement = line[i + 1] - line[i];
    const double length_m = displacement.norm(),
                 step_m = std::max(kSurveyStep_m, length_m / kMaxSamples);
    const int count = std::max(1, static_cast<int>(std::ceil(length_m / step_m - kCountRounding)));
    for (int k = 1; k <= count; ++k) {
      const double share = static_cast<double>(k) / count;
      add(line[i] + share * displacement, distance_m + share * length_m);
    }
    distance_m += length_m;
    profile.at_point_.push_back(static_cast<int>(profile.samples_.size()) - 1);
  }
  const int n = static_cast<int>(known.size());
  profile.beyond_ = static_cast<int>(std::count(known.begin(), known.end(), false));
  if (profile.beyond_ == n) return Failure{"there is no ground below any of it"};
  // Samples without ground get the nearer of the known heights before and after.
  std::vector<int> before(n, -1), after(n, -1);
  for (int i = 0; i < n; ++i) before[i] = known[i] ? i : i > 0 ? before[i - 1] : -1;
  for (int i = n - 1; i >= 0; --i) after[i] = known[i] ? i : i + 1 < n ? after[i + 1] : -1;
  for (int i = 0; i < n; ++i) {
    if (known[i]) continue;
    const auto distance_to = [&](int j) {
      return j < 0 ? std::numeric_limits<double>::infinity()
                   : std::abs(profile.samples_[j].distance_m - profile.samples_[i].distance_m);
    };
    const int from = distance_to(before[i]) <= distance_to(after[i]) ? before[i] : after[i];
    profile.samples_[i].ground_m = profile.samples_[from].ground_m;
  }
  return profile;
}

std::vector<double> make_wanted_heights(const GroundProfile& profile, double above_m,
                                        double max_slope) {
  const auto& samples = profile.samples();
  std::vector<double> wanted_m;
  for (const GroundProfile::Sample& sample : samples) wanted_m.push_back(sample.ground_m + above_m);
  const std::size_t n = samples.size();
  // Raise what falls too steeply (forwards), then what rises too steeply (backwards).
  for (std::size_t i = 1; i < n; ++i) {
    const double run_m = samples[i].distance_m - samples[i - 1].distance_m;
    wanted_m[i] = std::max(wanted_m[i], wanted_m[i - 1] - max_slope * run_m);
  }
  for (std::size_t i = n - 1; i-- > 0;) {
    const double run_m = samples[i + 1].distance_m - samples[i].distance_m;
    wanted_m[i] = std::max(wanted_m[i], wanted_m[i + 1] - max_slope * run_m);
  }
  return wanted_m;
}

double start_heights_at(const GroundProfile& profile, double start_m, double max_slope,
                        std::vector<double>& wanted_m) {
  const auto& samples = profile.samples();
  const double sign = start_m < wanted_m.front() ? 1.0 : -1.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double ramp_m = start_m + sign * max_slope * samples[i].distance_m;
    if (sign * (wanted_m[i] - ramp_m) <= 0.0) return samples[i].distance_m;
    wanted_m[i] = ramp_m;
  }
  return std::numeric_limits<double>::infinity();
}

std::vector<int> split_ramps(const GroundProfile& profile, const std::vector<double>& wanted_m,
                             std::size_t point_count, double error_m) {
  std::vector<int> points = {0};
  for (std::size_t i = 0; i + 1 < point_count; ++i) {
    const int first = profile.at_point(i), last = profile.at_point(i + 1);
    if (last > first) {
      split_piece(profile.samples(), wanted_m, first, last, kErrorShare * error_m, points);
    }
  }
  return points;
}

}  // namespace vinerow::controllers
