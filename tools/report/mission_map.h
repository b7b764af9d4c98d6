#pragma once
/// Map of the mission: rows, parcel, plans and tracks to scale, north up.

#include <optional>
#include <string>
#include <vector>

#include "tools/report/axis.h"
#include "tools/report/run_folder.h"
#include "tools/report/track.h"
#include "tools/report/vehicle_log.h"

namespace vinerow::tools::report {

/// Rectangle of the ground, m east and north.
struct MapView {
  Range x, y;
};

struct MapStyle {
  std::string label;  ///< description of the picture, for screen readers
  double width = 1000;
  double min_height = 320, max_height = 640;
  bool with_axes = true;  ///< ticks in metres; otherwise only a scale bar
  bool with_plans = true;
  bool with_ends = true;    ///< mark where vehicles start and end
  bool with_canopy = true;  ///< draw rows as wide as their canopy
};

/// View that contains rows, parcel, plans and tracks of the vehicles; nullopt without any of them.
std::optional<MapView> whole_view(const RunFolder& run, const std::vector<VehicleLog>& vehicles);

/// View of rows, parcel and the tracks of vehicles that work there; empty if it is nearly the whole
/// view or no vehicle works there.
std::optional<MapView> parcel_view(const RunFolder& run, const std::vector<VehicleLog>& vehicles);

/// View that contains one vehicle's plans and track.
std::optional<MapView> own_view(const VehicleLog& vehicle);

/// View of the first turn between rows; nullopt without a turn.
std::optional<MapView> first_turn_view(const Track& track);

/// Map as SVG. The view is widened on one axis to fill the picture.
std::string mission_map(const RunFolder& run, const std::vector<VehicleLog>& vehicles,
                        const MapView& view, const MapStyle& style);

/// Legend of the map: every vehicle's colour, plan, rows.
std::string map_legend(const RunFolder& run, const std::vector<VehicleLog>& vehicles,
                       const MapStyle& style);

}  // namespace vinerow::tools::report
