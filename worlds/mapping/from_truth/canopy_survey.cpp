#include "worlds/mapping/from_truth/canopy_survey.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

namespace vinerow::mapping {
namespace {

constexpr double kBeyondEnds_m = 2.0;
constexpr double kFindStep_m = 0.1;      // gaps shorter than this are not seen
constexpr double kMeasureStep_m = 0.15;  // half the wavelength of the shortest shoots' lumps
constexpr std::size_t kMinSections = 4;

struct Stretch {
  double from_m, to_m;
};

/// Ray measurements of one row.
class Scanner {
 public:
  Scanner(const SceneQuery& scene, const RowCurve& row, const GroundHeight& ground,
          const RowSurroundings& surroundings)
      : scene_(scene), row_(row), ground_(ground), around_(surroundings) {}

  /// Lowest and highest leaves on the line, above the ground; null without leaves.
  std::optional<std::pair<double, double>> heights_m(double s_m) const {
    const Eigen::Vector2d p = row_.point_W(s_m);
    const double ground_m = ground_(p.x(), p.y());
    const Eigen::Vector3d above(p.x(), p.y(), ground_m + around_.height_m);
    const auto down = cast(above, -Eigen::Vector3d::UnitZ(), around_.height_m);
    if (!down) return std::nullopt;
    const auto up = cast({p.x(), p.y(), ground_m}, Eigen::Vector3d::UnitZ(), around_.height_m);
    return std::pair(up.value_or(0.0), around_.height_m - *down);
  }

  /// Distance from the line to the leaves' outer surface, 0 without leaves.
  /// @param side  1: left, -1: right
  double width_m(double s_m, double height_m, double side) const {
    const Eigen::Vector2d p = row_.point_W(s_m), ahead = row_.direction_W(s_m);
    const Eigen::Vector3d out(-side * ahead.y(), side * ahead.x(), 0.0);
    const Eigen::Vector3d on_line(p.x(), p.y(), ground_(p.x(), p.y()) + height_m);
    const auto seen = cast(on_line + around_.side_m * out, -out, 2.0 * around_.side_m);
    return seen ? around_.side_m - *seen : 0.0;
  }

 private:
  std::optional<double> cast(const Eigen::Vector3d& p, const Eigen::Vector3d& dir,
                             double reach_m) const {
    const auto hit = scene_.cast_ray(p, dir, reach_m, mask_of(SurfaceClass::kCanopy));
    return hit ? std::optional(hit->distance_m) : std::nullopt;
  }

  const SceneQuery& scene_;
  const RowCurve& row_;
  const GroundHeight& ground_;
  RowSurroundings around_;
};

/// End of the canopy between a place with and a place without it.
double find_edge(const Scanner& scanner, double with_m, double without_m) {
  for (int k = 0; k < 10; ++k) {
    const double middle_m = 0.5 * (with_m + without_m);
    (scanner.heights_m(middle_m) ? with_m : without_m) = middle_m;
  }
  return with_m;
}

std::vector<Stretch> find_stretches(const Scanner& scanner, double length_m) {
  std::vector<Stretch> stretches;
  const double from_m = -kBeyondEnds_m, to_m = length_m + kBeyondEnds_m;
  const int steps = static_cast<int>(std::ceil((to_m - from_m) / kFindStep_m));
  bool inside = false;
  double before_m = from_m;
  for (int k = 0; k <= steps + 1; ++k) {
    const double s_m = from_m + k * kFindStep_m;
    const bool now = k <= steps && scanner.heights_m(s_m).has_value();
    if (now && !inside) {
      stretches.push_back({k == 0 ? s_m : find_edge(scanner, s_m, before_m), 0.0});
    }
    if (!now && inside) stretches.back().to_m = find_edge(scanner, before_m, s_m);
    inside = now;
    before_m = s_m;
  }
  std::erase_if(stretches, [](const Stretch& s) { return s.to_m - s.from_m < kMinStretch_m; });
  return stretches;
}

/// Weights of the nodes at each place, for linear interpolation.
Eigen::MatrixXd hat_weights(const std::vector<double>& places, const std::vector<double>& nodes) {
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(places.size()),
                                                  static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::size_t j = 1;
    while (j + 1 < nodes.size() && places[i] > nodes[j]) ++j;
    const double share = (places[i] - nodes[j - 1]) / (nodes[j] - nodes[j - 1]);
    const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(j);
    weights(row, column - 1) = 1.0 - share;
    weights(row, column) = share;
  }
  return weights;
}

/// Least-squares values at the nodes for values at the places: solves A^T A X = A^T Y.
Eigen::MatrixXd fit(const Eigen::MatrixXd& A, const Eigen::MatrixXd& Y) {
  return (A.transpose() * A).ldlt().solve(A.transpose() * Y);
}

SectionChain measure(const Scanner& scanner, const Stretch& stretch,
                     const CanopySurveyOptions& options, RandomStream& random) {
  const std::vector<double> stations =
      draw_stations(stretch.from_m, stretch.to_m, options, kMinSections, random);
  const std::vector<double> levels = level_shares(options.levels);
  const double length_m = stretch.to_m - stretch.from_m;
  const auto count = static_cast<Eigen::Index>(
      std::max(std::ceil(length_m / kMeasureStep_m), 4.0 * static_cast<double>(stations.size())));
  const Eigen::Index heights = 3 * options.levels;

  std::vector<double> places, shares;
  for (Eigen::Index j = 0; j < heights; ++j) {
    shares.push_back((static_cast<double>(j) + 0.5) / static_cast<double>(heights));
  }
  Eigen::MatrixXd extent(count, 2), left(count, heights), right(count, heights);
  std::pair<double, double> last{0.0, 0.0};
  for (Eigen::Index i = 0; i < count; ++i) {
    const double s_m =
        stretch.from_m + length_m * (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    places.push_back(s_m);
    last = scanner.heights_m(s_m).value_or(last);
    const auto [base_m, top_m] = last;
    extent.row(i) << base_m, top_m;
    for (Eigen::Index j = 0; j < heights; ++j) {
      const double height_m = base_m + shares[static_cast<std::size_t>(j)] * (top_m - base_m);
      left(i, j) = scanner.width_m(s_m, height_m, 1.0);
      right(i, j) = scanner.width_m(s_m, height_m, -1.0);
    }
  }
  // Places and heights form a grid, so the fit over both is a fit over each in turn.
  const Eigen::MatrixXd along = hat_weights(places, stations), up = hat_weights(shares, levels);
  const Eigen::MatrixXd extents = fit(along, extent);
  const Eigen::MatrixXd lefts = fit(up, fit(along, left).transpose());
  const Eigen::MatrixXd rights = fit(up, fit(along, right).transpose());

  SectionChain chain;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    CanopyCut cut;
    cut.s_m = stations[i];
    cut.base_m = extents(column, 0);
    cut.top_m = extents(column, 1);
    for (Eigen::Index k = 0; k < options.levels; ++k) {
      cut.left_m.push_back(lefts(k, column));
      cut.right_m.push_back(rights(k, column));
    }
    chain.push_back(std::move(cut));
  }
  keep_open(chain);
  return chain;
}

}  // namespace

std::vector<double> draw_stations(double from_m, double to_m, const CanopySurveyOptions& options,
                                  std::size_t min_count, RandomStream& random) {
  std::vector<double> stations{0.0};
  while (stations.back() < to_m - from_m) {
    stations.push_back(stations.back() +
                       random.uniform(options.spacing_low_m, options.spacing_high_m));
  }
  // One of the last two is nearer to the end than the other.
  if (stations.size() > 2 &&
      stations.back() - (to_m - from_m) > (to_m - from_m) - stations[stations.size() - 2]) {
    stations.pop_back();
  }
  while (stations.size() < min_count) {
    stations.push_back(stations.back() +
                       random.uniform(options.spacing_low_m, options.spacing_high_m));
  }
  const double scale = (to_m - from_m) / stations.back();
  for (double& s_m : stations) s_m = from_m + scale * s_m;
  return stations;
}

std::vector<SectionChain> survey_canopy(const SceneQuery& scene, const RowCurve& row,
                                        const GroundHeight& ground,
                                        const RowSurroundings& surroundings,
                                        const CanopySurveyOptions& options, RandomStream& random) {
  const Scanner scanner(scene, row, ground, surroundings);
  std::vector<SectionChain> chains;
  for (const Stretch& stretch : find_stretches(scanner, row.length_m())) {
    chains.push_back(measure(scanner, stretch, options, random));
  }
  return chains;
}

}  // namespace vinerow::mapping
