#pragma once
/// Terrain, rows, maps and vehicles of a run as plain Python values with arrays.

#include <pybind11/pybind11.h>

#include "engine/api/forward.h"

namespace vinerow::python {

/// vinerow.World of copies.
pybind11::object world_to_python(const WorldModel& world);
/// vinerow.Map of copies.
pybind11::object map_to_python(const RowMap& map);
/// vinerow.Vehicle.
pybind11::object vehicle_to_python(const std::string& name, const VehicleDescription& vehicle);

}  // namespace vinerow::python
