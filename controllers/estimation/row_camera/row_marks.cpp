#include "controllers/estimation/row_camera/row_marks.h"

#include <algorithm>
#include <cmath>

#include "engine/api/lens.h"
#include "engine/api/parameter_table.h"
#include "engine/api/surface.h"

namespace vinerow::controllers {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr float kSoilRun_m = 0.12f;  // that much soil in a row of pixels is a strip
constexpr int kBins = 64;            // of the histogram of redness, which lies within +-kReddest
constexpr float kReddest = 0.25f;

/// Threshold between two classes of a histogram with the largest variance between them (Otsu 1979).
float split(const std::array<int, kBins>& histogram) {
  double total = 0.0, sum = 0.0;
  for (int i = 0; i < kBins; ++i) {
    total += histogram[i];
    sum += static_cast<double>(i) * histogram[i];
  }
  double below = 0.0, below_sum = 0.0, best = -1.0;
  int best_bin = kBins / 2;
  for (int i = 0; i + 1 < kBins; ++i) {
    below += histogram[i];
    below_sum += static_cast<double>(i) * histogram[i];
    const double above = total - below;
    if (below <= 0.0 || above <= 0.0) continue;
    const double apart = below_sum / below - (sum - below_sum) / above;
    const double variance = below * above * apart * apart;
    if (variance > best) {
      best = variance;
      best_bin = i;
    }
  }
  return kReddest * (2.0f * static_cast<float>(best_bin + 1) / kBins - 1.0f);
}

}  // namespace

const ParameterTable<RowMarksParams>& row_marks_table() {
  using P = RowMarksParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice(
              "marks", &P::source,
              {{"labels", P::Source::kLabels}, {"colours", P::Source::kColours}},
              "labels: feet of trunks and posts in a picture of labels; colours: borders of the "
              "bare strip under the plants in a colour picture")
          .number("nearest_m", "m", &P::nearest_m, between(0.0, 100.0),
                  "marks are used from this distance ahead of the vehicle's origin")
          .number("farthest_m", "m", &P::farthest_m, between(0.1, 100.0),
                  "up to this distance; the ground is taken as flat")
          .integer("foot_px", &P::foot_px, between(1, 100),
                   "a trunk or post has at least so many pixels above its foot; less is taken for "
                   "an error of the labels (marks: labels)")
          .number("strip_half_width_m", "m", &P::strip_half_width_m, between(0.0, 2.0),
                  "half width of the bare strip (marks: colours)")
          .degrees("tilt_std_deg", &P::tilt_std_rad, between(0.0, 20.0),
                   "1 sigma of the angle between the body and the ground ahead");
  return table;
}

RowMarks::RowMarks(const RowMarksParams& params, const Pose& X_BS, double height_m)
    : params_(params), X_BS_(X_BS), height_m_(height_m) {}

void RowMarks::set_camera(const CameraInfo& info) {
  const Lens lens(info);
  width_ = lens.width();
  height_ = lens.height();
  ground_B_.assign(static_cast<std::size_t>(width_) * height_, std::nullopt);
  redness_.resize(ground_B_.size());
  marks_.reserve(static_cast<std::size_t>(width_ + 2 * height_));
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto dir_C = lens.direction(x, y);
      if (!dir_C) continue;
      const Vector3d dir_B = X_BS_.q * Vector3d(dir_C->z(), -dir_C->x(), -dir_C->y());
      if (dir_B.z() >= 0.0) continue;
      const Vector3d p_B = X_BS_.p + (X_BS_.p.z() + height_m_) / -dir_B.z() * dir_B;
      if (p_B.x() < params_.nearest_m || p_B.head<2>().norm() > params_.farthest_m) continue;
      ground_B_[index(x, y)] = p_B.head<2>().cast<float>();
    }
  }
}

const std::vector<RowMark>& RowMarks::find(const Picture& picture) {
  marks_.clear();
  const bool is_labels = params_.source == RowMarksParams::Source::kLabels;
  const bool fits = static_cast<int>(picture.width) == width_ &&
                    static_cast<int>(picture.height) == height_ && picture.format == format();
  if (!fits || width_ == 0) return marks_;
  if (is_labels) {
    find_feet(picture);
  } else {
    find_strips(picture);
  }
  return marks_;
}

void RowMarks::add(const Point& ground_B, double before_row_m) {
  const Vector2d sight_B = ground_B.cast<double>() - X_BS_.p.head<2>();
  const double range_std_m =
      sight_B.squaredNorm() / (X_BS_.p.z() + height_m_) * params_.tilt_std_rad;
  marks_.push_back({ground_B.cast<double>(), before_row_m, range_std_m * sight_B.normalized()});
}

void RowMarks::find_feet(const Picture& labels) {
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
    if (ground_B) add(*ground_B, 0.0);
  }
}

void RowMarks::rate_colours(const Picture& colours) {
  std::array<int, kBins> histogram{};
  for (std::size_t i = 0; i < ground_B_.size(); ++i) {
    if (!ground_B_[i]) continue;
    const int red = colours.data[3 * i], green = colours.data[3 * i + 1];
    redness_[i] = static_cast<float>(red - green) / static_cast<float>(std::max(red + green, 1));
    const float share = 0.5f * (redness_[i] / kReddest + 1.0f);
    const int bin = std::clamp(static_cast<int>(share * kBins), 0, kBins - 1);
    ++histogram[static_cast<std::size_t>(bin)];
  }
  threshold_ = split(histogram);
}

/// From column `first` outwards: where soil begins and goes on. @param side  1 left, -1 right
void RowMarks::look_along(int row, int first, int step, int side) {
  float begin_m = 0.0f;
  int begin = -1;
  for (int x = first; x >= 0 && x < width_; x += step) {
    const auto& ground_B = ground_B_[index(x, row)];
    if (!ground_B) {
      begin = -1;
      continue;
    }
    const float across_m = static_cast<float>(side) * ground_B->y();
    if (redness_[index(x, row)] < threshold_) {
      begin = -1;
      continue;
    }
    if (begin < 0) {
      begin = x;
      begin_m = across_m;
    }
    if (across_m - begin_m < kSoilRun_m) continue;
    add(*ground_B_[index(begin, row)], params_.strip_half_width_m);
    return;
  }
}

void RowMarks::find_strips(const Picture& colours) {
  rate_colours(colours);
  for (int y = 0; y < height_; ++y) {
    // Columns to the left and to the right of the vehicle's own axis.
    int middle = -1;
    for (int x = 0; x < width_ && middle < 0; ++x) {
      if (ground_B_[index(x, y)] && ground_B_[index(x, y)]->y() < 0.0f) middle = x;
    }
    if (middle < 0) continue;
    look_along(y, middle - 1, -1, 1);
    look_along(y, middle, 1, -1);
  }
}

}  // namespace vinerow::controllers
