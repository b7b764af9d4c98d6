#include "controllers/estimation/row_camera/row_marks.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/api/parameter_table.h"
#include "engine/api/surface.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Strips of soil, in profiles across the rows.
constexpr double kStep_m = 0.02, kPitch_m = 0.25;  // of a profile; from one to the next
constexpr double kSearch_m = 0.5;                  // on each side of where the row is expected
constexpr double kFlank = 0.5;  // of the strip's half width, on each side: what it is held against
constexpr float kContrast = 0.5f;  // least difference of the shares of soil
constexpr float kPlateau = 0.1f;   // below the largest one: as good

int steps(double length_m) {
  return static_cast<int>(std::lround(length_m / kStep_m));
}

}  // namespace

const ParameterTable<RowMarksParams>& row_marks_table() {
  using P = RowMarksParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice(
              "marks", &P::source,
              {{"labels", P::Source::kLabels}, {"colours", P::Source::kColours}},
              "labels: feet of trunks and posts in a picture of labels; colours: the bare strip "
              "under the plants in a colour picture")
          .number("nearest_m", "m", &P::nearest_m, between(0.0, 100.0),
                  "marks are used from this distance ahead of the vehicle's origin")
          .number("farthest_m", "m", &P::farthest_m, between(0.1, 100.0),
                  "up to this distance; the ground is taken as flat")
          .integer("foot_px", &P::foot_px, between(1, 100),
                   "a trunk or post has at least so many pixels above its foot; less is taken for "
                   "an error of the labels (marks: labels)")
          .number("strip_half_width_m", "m", &P::strip_half_width_m, between(0.1, 2.0),
                  "half width of the bare strip (marks: colours)")
          .degrees("tilt_std_deg", &P::tilt_std_rad, between(0.0, 20.0),
                   "1 sigma of the angle between the body and the ground ahead");
  return table;
}

RowMarks::RowMarks(const RowMarksParams& params, const Pose& X_BS, double height_m)
    : params_(params), X_BS_(X_BS), height_m_(height_m) {}

void RowMarks::set_camera(const CameraInfo& info) {
  lens_ = Lens(info);
  width_ = lens_.width();
  height_ = lens_.height();
  ground_B_.assign(static_cast<std::size_t>(width_) * height_, std::nullopt);
  marks_.reserve(static_cast<std::size_t>(width_ + 2 * height_));
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto dir_C = lens_.direction(x, y);
      if (!dir_C) continue;
      const Vector3d dir_B = X_BS_.q * Vector3d(dir_C->z(), -dir_C->x(), -dir_C->y());
      if (dir_B.z() >= 0.0) continue;
      const Vector3d p_B = X_BS_.p + (X_BS_.p.z() + height_m_) / -dir_B.z() * dir_B;
      if (p_B.x() < params_.nearest_m || p_B.head<2>().norm() > params_.farthest_m) continue;
      ground_B_[index(x, y)] = p_B.head<2>().cast<float>();
    }
  }
}

bool RowMarks::fits(const Picture& picture) const {
  return width_ > 0 && static_cast<int>(picture.width) == width_ &&
         static_cast<int>(picture.height) == height_ && picture.format == format();
}

void RowMarks::add(const Vector2d& ground_B) {
  const Vector2d sight_B = ground_B - X_BS_.p.head<2>();
  const double range_std_m =
      sight_B.squaredNorm() / (X_BS_.p.z() + height_m_) * params_.tilt_std_rad;
  marks_.push_back({ground_B, range_std_m * sight_B.normalized()});
}

const std::vector<RowMark>& RowMarks::find_feet(const Picture& labels) {
  marks_.clear();
  if (!fits(labels)) return marks_;
  const auto label = [&](int x, int y) { return static_cast<Label>(labels.data[index(x, y)]); };
  const auto stands = [&](int x, int y) {
    return label(x, y) == Label::kWood || label(x, y) == Label::kPost;
  };
  for (int x = 0; x < width_; ++x) {
    int y = height_ - 1;
    while (y > 0 && label(x, y) == Label::kVehicle) --y;
    while (y > 0 && label(x, y) == Label::kGround) --y;
    // Leaves and bunches that hang before the foot hide it.
    if (y + 1 >= height_ || label(x, y + 1) != Label::kGround) continue;
    int tall_px = 0;
    while (tall_px < params_.foot_px && y >= tall_px && stands(x, y - tall_px)) ++tall_px;
    if (tall_px < params_.foot_px) continue;
    const auto& ground_B = ground_B_[index(x, y)];
    if (ground_B) add(ground_B->cast<double>());
  }
  return marks_;
}

const std::vector<RowMark>& RowMarks::find_strips(const Picture& colours, const Vector3d& expected,
                                                  const PolylineIndex& rows) {
  marks_.clear();
  if (!fits(colours)) return marks_;
  profiles_.clear();
  colours_.clear();
  const Eigen::Matrix2d R_BW = Eigen::Rotation2Dd(-expected.z()).toRotationMatrix();
  const auto look = [&](const PolylineIndex::Nearest& at) {
    const Polyline& line = rows.lines()[static_cast<std::size_t>(at.line)];
    const auto from = static_cast<std::size_t>(at.segment);
    const double begin_m = line.s_m()[from], end_m = line.s_m()[from + 1];
    const Vector2d start_B = R_BW * (line.points()[from] - expected.head<2>());
    const Vector2d along_B = R_BW * (line.points()[from + 1] - line.points()[from]).normalized();
    for (double s_m = std::ceil(begin_m / kPitch_m) * kPitch_m; s_m < end_m; s_m += kPitch_m) {
      take_profile(colours, start_B + (s_m - begin_m) * along_B, {-along_B.y(), along_B.x()});
    }
  };
  // By reference: a copy of it would take heap.
  rows.visit_within(expected.head<2>(), params_.farthest_m, std::ref(look));
  const SoilClasses classes = split_soil(colours_);
  if (!classes.differ()) return marks_;
  for (const Profile& profile : profiles_) find_strip(profile, classes);
  return marks_;
}

/// A strip with its flanks, from its middle on, in steps.
int RowMarks::reach_of_strip() const {
  return steps((1.0 + kFlank) * params_.strip_half_width_m);
}

std::optional<std::size_t> RowMarks::pixel_at(const Vector2d& ground_B) const {
  const Vector3d ray_B(ground_B.x() - X_BS_.p.x(), ground_B.y() - X_BS_.p.y(),
                       -height_m_ - X_BS_.p.z());
  const Vector3d ray_S = X_BS_.q.conjugate() * ray_B;
  if (ray_S.x() <= 0.0) return std::nullopt;
  const auto pixel = lens_.project({-ray_S.y(), -ray_S.z(), ray_S.x()});
  if (!pixel) return std::nullopt;
  const double u = std::round(pixel->x()), v = std::round(pixel->y());
  if (!(u >= 0.0 && u < width_ && v >= 0.0 && v < height_)) return std::nullopt;
  const std::size_t at = index(static_cast<int>(u), static_cast<int>(v));
  if (!ground_B_[at]) return std::nullopt;
  return at;
}

/// The part in view of a line across a row.
void RowMarks::take_profile(const Picture& colours, const Vector2d& row_B,
                            const Vector2d& across_B) {
  const int reach = steps(kSearch_m) + reach_of_strip();
  Profile profile{row_B, across_B, -reach, colours_.size(), 0};
  for (int i = -reach; i <= reach; ++i) {
    const auto pixel = pixel_at(row_B + i * kStep_m * across_B);
    if (pixel) {
      colours_.push_back(soil_colour(&colours.data[3 * *pixel]));
    } else if (colours_.size() > profile.begin) {
      break;
    } else {
      profile.first = i + 1;
    }
  }
  profile.count = static_cast<int>(colours_.size() - profile.begin);
  if (profile.count > 0) profiles_.push_back(profile);
}

void RowMarks::find_strip(const Profile& profile, const SoilClasses& classes) {
  const int half = steps(params_.strip_half_width_m);
  const int flank = reach_of_strip() - half, search = steps(kSearch_m);
  sums_.assign(1, 0.0f);
  for (int i = 0; i < profile.count; ++i) {
    const float colour = colours_[profile.begin + static_cast<std::size_t>(i)];
    sums_.push_back(sums_.back() + classes.share(colour));
  }
  const auto soil_between = [&](int from, int to) {
    return sums_[static_cast<std::size_t>(to - profile.first)] -
           sums_[static_cast<std::size_t>(from - profile.first)];
  };
  const auto contrast = [&](int middle) {
    const int left = middle - half, right = middle + half + 1;
    const float flanks = soil_between(left - flank, left) + soil_between(right, right + flank);
    return soil_between(left, right) / static_cast<float>(right - left) -
           flanks / static_cast<float>(2 * flank);
  };
  const int last = profile.first + profile.count - 1;
  const int from = std::max(-search, profile.first + half + flank);
  const int to = std::min(search, last - half - flank);
  int best = from;
  float most = kContrast;
  for (int middle = from; middle <= to; ++middle) {
    const float here = contrast(middle);
    if (here > most) {
      most = here;
      best = middle;
    }
  }
  // At an end, the strip may lie beyond it.
  if (best <= from || best >= to) return;
  // A strip of another width has no peak, but a plateau: its middle.
  double sum = 0.0, count = 0.0;
  for (int middle = from; middle <= to; ++middle) {
    if (contrast(middle) < most - kPlateau) continue;
    sum += middle;
    count += 1.0;
  }
  add(profile.row_B + sum / count * kStep_m * profile.across_B);
}

}  // namespace vinerow::controllers
