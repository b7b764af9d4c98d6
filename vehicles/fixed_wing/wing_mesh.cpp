#include "vehicles/fixed_wing/wing_mesh.h"

#include <algorithm>
#include <cmath>

#include "vehicles/fixed_wing/fixed_wing_shapes.h"
#include "vehicles/parts/loft_mesh.h"

namespace vinerow::vehicles {
namespace {

using Eigen::Vector3d;

constexpr int kSectionPoints = 18;  // along each surface
/// Gap between wing and elevon, share of the chord; and at its ends, share of the half span.
constexpr double kHingeGap = 0.008, kEndGap = 0.003;

/// Half thickness over chord at a share of the chord, NACA four digits with a closed trailing edge.
double half_thickness(double x) {
  return 5.0 * kWingThickness *
         (0.2969 * std::sqrt(x) - 0.1260 * x - 0.3516 * x * x + 0.2843 * x * x * x -
          0.1036 * x * x * x * x);
}

/// Camber line: positive ahead, a little reflex behind.
double camber(double x) {
  return 0.10 * x * (1.0 - x) * (0.75 - x);
}

/// Points of a section in B from one share of the chord to another: along the upper surface
/// forward, then along the lower one back.
std::vector<Vector3d> section(const WingStation& station, double from, double to, double slimmer) {
  std::vector<Vector3d> points;
  const auto at = [&](double x, double face) {
    const double z = camber(x) + face * slimmer * half_thickness(x);
    return Vector3d(station.leading_B + station.chord_m * Vector3d(-x, 0.0, z));
  };
  // Closer together towards the front of the piece.
  const auto x_at = [&](int k) {
    const double s = static_cast<double>(k) / kSectionPoints;
    return from + (to - from) * (1.0 - std::cos(0.5 * kPi * s));
  };
  for (int k = kSectionPoints; k >= 0; --k) points.push_back(at(x_at(k), 1.0));
  for (int k = from > 0.0 ? 0 : 1; k <= kSectionPoints; ++k) points.push_back(at(x_at(k), -1.0));
  return points;
}

LoftRows sections(const FixedWingParams& p, double side, double inner, double outer, int count,
                  double from, double to) {
  LoftRows rows;
  for (int i = 0; i <= count; ++i) {
    const double share = inner + (outer - inner) * i / count;
    // Rounded over the last two hundredths.
    const double into_tip = std::clamp((share - 0.98) / 0.02, 0.0, 1.0);
    const double slimmer = std::sqrt(1.0 - 0.96 * into_tip * into_tip);
    rows.push_back(section(wing_station(p, share, side), from, to, slimmer));
  }
  return rows;
}

}  // namespace

void append_half_wing(const FixedWingParams& p, double side, MeshBuilder& b) {
  const double from = p.shape.elevon_from, to = p.shape.elevon_to;
  const double hinge = 1.0 - p.shape.elevon_chord - kHingeGap;
  b.place(0, 0, 0).colour(colour_from_srgb(kPaintWhite));
  LoftOptions options;
  options.mirrored = side < 0.0;  // points go forward over the top, rows go out
  append_loft(sections(p, side, 0.0, from, 6, 0.0, 1.0), options, b);
  append_loft(sections(p, side, to, 1.0, 8, 0.0, 1.0), options, b);
  // Bands of paint over the middle piece.
  constexpr int kPieces = 24;
  options.colour = [](std::size_t i, std::size_t) {
    const bool band = (i >= 15 && i < 20) || i == 21;
    return colour_from_srgb(band ? kPaintOrange : kPaintWhite);
  };
  const LoftRows middle = sections(p, side, from, to, kPieces, 0.0, hinge);
  append_loft(middle, options, b);
  // Rear face before the elevon, and the sides of its cut-out.
  b.colour(colour_from_srgb(kPaintGrey));
  LoftRows rear;
  for (const auto& row : middle) rear.push_back({row.back(), row.front()});
  options.colour = nullptr;
  append_loft(rear, options, b);
  const Vector3d out(0.0, side, 0.0);
  append_lid(section(wing_station(p, from, side), hinge, 1.0, 1.0), out, b);
  append_lid(section(wing_station(p, to, side), hinge, 1.0, 1.0), -out, b);
  b.colour(colour_from_srgb(kPaintWhite));
  append_lid(sections(p, side, 1.0, 1.0, 1, 0.0, 1.0).front(), out, b);
}

void append_elevon(const FixedWingParams& p, double side, const Pose& X_BE, MeshBuilder& b) {
  const double from = p.shape.elevon_from + kEndGap, to = p.shape.elevon_to - kEndGap;
  LoftRows rows = sections(p, side, from, to, 8, 1.0 - p.shape.elevon_chord, 1.0);
  const Pose X_EB = X_BE.inverse();
  for (auto& row : rows) {
    for (Vector3d& point : row) point = X_EB.q * point + X_EB.p;
    // A round nose between the surfaces.
    const auto middle = static_cast<std::ptrdiff_t>(row.size() / 2);
    const Vector3d upper = row[static_cast<std::size_t>(middle) - 1];
    const Vector3d lower = row[static_cast<std::size_t>(middle)];
    std::vector<Vector3d> nose;
    for (const double angle_rad : {0.25 * kPi, 0.5 * kPi, 0.75 * kPi}) {
      nose.push_back(0.5 * (upper + lower) + 0.5 * std::cos(angle_rad) * (upper - lower) +
                     0.5 * std::sin(angle_rad) * (upper - lower).norm() * Vector3d::UnitX());
    }
    row.insert(row.begin() + middle, nose.begin(), nose.end());
  }
  b.place(0, 0, 0).colour(colour_from_srgb(kPaintOrange));
  LoftOptions options;
  options.mirrored = side < 0.0;  // points go forward over the top, rows go out
  append_loft(rows, options, b);
  append_lid(rows.front(), {0, -side, 0}, b);
  append_lid(rows.back(), {0, side, 0}, b);
  // Horn and push rod below, a third out.
  b.colour(colour_from_srgb(kPaintDark));
  const double y = side * 0.3 * (to - from) * 0.5 * p.wing.span_m;
  b.rod({-0.008, y, -0.004}, {-0.004, y, -0.022}, 0.0018, 8);
}

void append_fin(const FixedWingParams& p, double side, MeshBuilder& b) {
  const AirframeShape& s = p.shape;
  const WingStation tip = wing_station(p, 1.0, side);
  const Vector3d foot = tip.leading_B + Vector3d(s.fin_root_m - tip.chord_m, side * 0.002, 0.0);
  LoftRows rows;
  LoftOptions options;
  constexpr int kPieces = 12;
  for (int i = 0; i <= kPieces; ++i) {
    const double share = static_cast<double>(i) / kPieces;
    const double z = -0.018 + (s.fin_height_m + 0.018) * share;
    const double round =
        share > 0.9 ? std::sqrt(1.0 - 0.9 * std::pow((share - 0.9) / 0.1, 2)) : 1.0;
    const double chord =
        (s.fin_root_m + (s.fin_tip_m - s.fin_root_m) * share) * (0.7 + 0.3 * round);
    const WingStation fin{foot + Vector3d(-z * std::tan(s.fin_sweep_rad), 0, z), chord};
    std::vector<Vector3d> row = section(fin, 0.0, 1.0, 0.8 * round);
    // Lie the section down: its thickness goes to the side, without camber.
    for (Vector3d& point : row) {
      const double x = (fin.leading_B.x() - point.x()) / chord;
      const double thick = point.z() - fin.leading_B.z() - chord * camber(x);
      point = {point.x(), fin.leading_B.y() + thick, fin.leading_B.z()};
    }
    rows.push_back(std::move(row));
  }
  options.mirrored = true;  // points go forward on the left, rows go up
  options.colour = [](std::size_t i, std::size_t) {
    return colour_from_srgb(i >= 8 ? kPaintOrange : kPaintWhite);
  };
  b.place(0, 0, 0);
  append_loft(rows, options, b);
  b.colour(colour_from_srgb(kPaintWhite));
  append_lid(rows.front(), -Vector3d::UnitZ(), b);
  b.colour(colour_from_srgb(kPaintOrange));
  append_lid(rows.back(), Vector3d::UnitZ(), b);
  // Position light at the foot: red to the left, green to the right.
  b.colour(colour_from_srgb(side > 0.0 ? 0xd32020u : 0x22b14cu));
  b.place(tip.leading_B.x() - 0.01, tip.leading_B.y(), tip.leading_B.z());
  b.box({0.012, 0.006, 0.005}, 0.003);
}

}  // namespace vinerow::vehicles
