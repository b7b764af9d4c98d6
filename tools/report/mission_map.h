#pragma once
/// The mission from above: rows, parcel, plans and tracks to scale, north up.

#include <optional>
#include <string>
#include <vector>

#include "tools/report/axis.h"
#include "tools/report/run_folder.h"
#include "tools/report/track.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

/// A rectangle of the ground, m east and north.
struct MapView {
  Range x, y;
};

struct MapStyle {
  std::string label;  ///< what the picture shows, for who cannot see it
  double width = 1000;
  double least_height = 320, most_height = 640;
  bool with_axes = true;  ///< ticks in metres, else the scale bar alone
  bool with_plans = true;
  bool with_ends = true;    ///< where vehicles start and end
  bool with_canopy = true;  ///< rows as wide as their canopy
};

/// What holds rows, parcel, plans and tracks of the vehicles; nothing where there is none of it.
std::optional<MapView> whole_view(const RunFolder& run, const std::vector<VehicleLog>& vehicles);

/// Rows, parcel, and the tracks of those that work in them; nothing where that is about the whole
/// view or nobody works there.
std::optional<MapView> parcel_view(const RunFolder& run, const std::vector<VehicleLog>& vehicles);

/// What holds one vehicle's plans and track.
std::optional<MapView> own_view(const VehicleLog& vehicle);

/// Around the first turn between rows; nothing where there is none.
std::optional<MapView> first_turn_view(const Track& track);

/// The picture as SVG. The view grows on one side to fill it.
std::string mission_map(const RunFolder& run, const std::vector<VehicleLog>& vehicles,
                        const MapView& view, const MapStyle& style);

/// Its legend: every vehicle's colour, plan, rows.
std::string map_legend(const RunFolder& run, const std::vector<VehicleLog>& vehicles,
                       const MapStyle& style);

/// Fewer points within `tolerance` of the line (D. Douglas, T. Peucker, 1973).
std::vector<Eigen::Vector2d> simplified(const std::vector<Eigen::Vector2d>& line, double tolerance);

}  // namespace vinerow::tools::report
