/// Maps and estimates in frames. Part of FrameComposer.

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "engine/playback/estimate_drawing.h"
#include "engine/playback/frame_composer.h"

namespace vinerow::playback {
namespace {

/// Colours of the estimates of the first vehicle, of its observers and of further vehicles; then
/// they start again.
const Eigen::Vector3f kEstimateColours[] = {{1.0f, 0.08f, 0.08f},
                                            {1.0f, 1.0f, 1.0f},
                                            {0.72f, 0.35f, 1.0f},
                                            {0.25f, 1.0f, 0.35f},
                                            {0.55f, 0.8f, 1.0f}};
const Eigen::Vector3f kMapColour{0.1f, 0.92f, 1.0f};
/// Range of distances from the eye in which a map's edges have a share of the full opacity. In
/// oblique views distant edges would merge otherwise.
struct MapBand {
  double from_m, to_m;
  float share;
};
constexpr MapBand kMapBands[] = {{0.0, 8.0, 1.0f}, {8.0, 16.0, 0.5f}, {16.0, 32.0, 0.2f}};
constexpr MapBand kWholeMap{0.0, 1e9, 1.0f};
constexpr float kMapAlpha = 0.85f;
constexpr float kHiddenMapAlpha = 0.35f;
/// Half the length of an estimate's marker: minimum, and share of the picture in top views.
constexpr double kMarker_m = 0.2;
constexpr double kMarkerShare = 0.013;
/// Height of the trail above the ground, equal to that of the true trail.
constexpr double kTrailHover_m = 0.06;

/// Mean horizontal variance over the whole log.
double mean_variance_m2(const Trace<Odometry>& trace) {
  double sum_m2 = 0.0;
  for (const Odometry& estimate : trace.values) {
    sum_m2 += estimate.position_variance_m2.head<2>().sum();
  }
  return sum_m2 / static_cast<double>(trace.values.size());
}

}  // namespace

void FrameComposer::add_map_edges(render::Frame& frame) const {
  const bool is_map = frame.camera.orthographic;
  const Eigen::Vector3d eye = frame.camera.X_WC.p;
  bool has_any = false;
  for (const auto& [name, vehicle] : trace_.vehicles) {
    const std::vector<Eigen::Vector3d>& points = vehicle.map_edges.points_W;
    has_any = has_any || !points.empty();
    for (const MapBand& band : is_map ? std::span(&kWholeMap, 1) : std::span(kMapBands)) {
      render::Polyline edges;
      edges.colour = kMapColour;
      edges.width_px = 1.2f;
      edges.alpha = kMapAlpha * band.share;
      edges.hidden_alpha = is_map ? kMapAlpha : kHiddenMapAlpha * band.share;
      edges.pairs = true;
      for (std::size_t i = 0; i + 1 < points.size(); i += 2) {
        const double away_m = is_map ? 0.0 : (points[i] - eye).norm();
        if (away_m < band.from_m || away_m >= band.to_m) continue;
        edges.points_W.insert(edges.points_W.end(), {points[i], points[i + 1]});
      }
      if (!edges.points_W.empty()) frame.lines.push_back(std::move(edges));
    }
  }
  if (has_any) frame.legend.push_back({"map", kMapColour});
}

void FrameComposer::add_estimates(const scenario::CameraConfig& camera, Time t,
                                  render::Frame& frame) const {
  struct Shown {
    std::string vehicle, signal;
    EstimateLook look;
  };
  std::vector<Shown> shown;
  for (std::size_t v = 0; v < scenario_.vehicles.size(); ++v) {
    const scenario::VehicleConfig& config = scenario_.vehicles[v];
    EstimateLook look;
    look.down_m = vehicles_[v]->description().height_above_ground_m - kTrailHover_m;
    look.is_map = frame.camera.orthographic;
    look.inside = looks_out_of(camera, config.name);
    look.marker_m = kMarker_m;
    if (look.is_map) {
      look.marker_m = std::max(look.marker_m, kMarkerShare * frame.camera.ortho_height_m);
    }
    // Without an estimator the estimate is the truth.
    if (config.estimator || !config.estimate_is_truth())
      shown.push_back({config.name, "estimate", look});
    for (const scenario::NamedPart& observer : config.observers) {
      shown.push_back({config.name, observer.name, look});
    }
  }
  struct Drawn {
    double variance_m2;
    std::vector<render::Polyline> lines;
  };
  std::vector<Drawn> drawn;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    Shown& one = shown[i];
    one.look.colour = kEstimateColours[i % std::size(kEstimateColours)];
    const VehicleTrace& vehicle = trace_of(one.vehicle);
    const auto found = vehicle.estimates.find(one.signal);
    if (found == vehicle.estimates.end() || vehicle.truth.empty()) continue;
    std::vector<render::Polyline> lines = draw_estimate(
        found->second, t, one.look, [this](double x, double y) { return ground_m(x, y); });
    if (lines.empty()) continue;
    drawn.push_back({mean_variance_m2(found->second), std::move(lines)});
    const Eigen::Vector3d e = odometry_at(found->second, t).X_WB.p - vehicle.truth_at(t).X_WB.p;
    frame.legend.push_back(
        {fmt::format("{}{} {:.2f} m off",
                     scenario_.vehicles.size() > 1 ? one.vehicle + " " : std::string(), one.signal,
                     e.head<2>().norm()),
         one.look.colour});
  }
  // Draw smaller ellipses over larger ones, in the same order in all frames of a log.
  std::stable_sort(drawn.begin(), drawn.end(),
                   [](const Drawn& a, const Drawn& b) { return a.variance_m2 > b.variance_m2; });
  for (Drawn& one : drawn) {
    std::move(one.lines.begin(), one.lines.end(), std::back_inserter(frame.lines));
  }
}

}  // namespace vinerow::playback
