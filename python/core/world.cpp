#include "python/core/world.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "engine/api/map.h"
#include "engine/api/vehicle.h"
#include "engine/api/world_model.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

py::object world_class(const char* name) {
  return py::module_::import("vinerow.world").attr(name);
}

/// (n, kSize) from vectors of Eigen.
template <class V>
py::array rows_of(const std::vector<V>& points) {
  using Scalar = typename V::Scalar;
  const auto count = static_cast<py::ssize_t>(points.size());
  constexpr auto kSize = static_cast<py::ssize_t>(V::RowsAtCompileTime);
  if (points.empty()) return py::array_t<Scalar>(std::vector<py::ssize_t>{0, kSize});
  return py::array_t<Scalar>({count, kSize}, {py::ssize_t{sizeof(V)}, py::ssize_t{sizeof(Scalar)}},
                             points[0].data());
}

py::object terrain_of(const std::optional<HeightField>& field) {
  if (!field) return py::none();
  return world_class("Terrain")(
      py::array_t<float>({field->rows, field->columns}, field->heights_m.data()), field->cell_m,
      py::make_tuple(field->corner_W.x(), field->corner_W.y()));
}

py::list plant_rows(const RowMap& map) {
  py::list rows;
  for (const PlantRow& row : map.rows) {
    rows.append(world_class("Row")(row.id, rows_of(row.line_W), row.canopy_width_m,
                                   row.canopy_base_m, row.canopy_top_m));
  }
  return rows;
}

py::list alleys(const RowMap& map) {
  py::list list;
  for (const Alley& alley : map.alleys) {
    list.append(world_class("Alley")(alley.id, rows_of(alley.line_W), alley.width_m));
  }
  return list;
}

py::array triangles_of(const TriangleMesh& mesh) {
  const auto count = static_cast<py::ssize_t>(mesh.triangles.size());
  if (count == 0) return py::array_t<std::uint32_t>(std::vector<py::ssize_t>{0, 3});
  return py::array_t<std::uint32_t>({count, py::ssize_t{3}}, mesh.triangles[0].data());
}

}  // namespace

py::object world_to_python(const WorldModel& world) {
  py::list spawn_points;
  for (const SpawnPoint& point : world.spawn_points) {
    spawn_points.append(world_class("SpawnPoint")(
        point.name, py::make_tuple(point.p_W.x(), point.p_W.y()), point.yaw_rad));
  }
  return world_class("World")(world.name, terrain_of(world.terrain), plant_rows(*world.rows),
                              alleys(*world.rows), rows_of(world.rows->boundary_W), spawn_points,
                              world.notes);
}

py::object map_to_python(const RowMap& map) {
  py::list meshes;
  for (const RowMesh& mesh : map.meshes) {
    meshes.append(
        world_class("RowMesh")(mesh.row, rows_of(mesh.mesh_W.vertices), triangles_of(mesh.mesh_W)));
  }
  py::object grid = py::none();
  if (!map.occupancy.empty()) {
    const OccupancyGrid& cells = map.occupancy;
    grid = world_class("Grid")(
        py::array_t<std::uint8_t>({cells.rows, cells.columns}, cells.cells.data())
            .attr("astype")("bool"),
        cells.cell_m, py::make_tuple(cells.corner_W.x(), cells.corner_W.y()));
  }
  return world_class("Map")(plant_rows(map), alleys(map), rows_of(map.boundary_W), meshes, grid,
                            terrain_of(map.terrain));
}

py::object vehicle_to_python(const std::string& name, const VehicleDescription& vehicle) {
  py::list actuators;
  for (const ActuatorSpec& actuator : vehicle.actuators) {
    actuators.append(
        world_class("Actuator")(actuator.name, actuator.unit, actuator.min, actuator.max));
  }
  py::object wheels = py::none();
  if (const auto& wheeled = vehicle.wheeled) {
    wheels = world_class("Wheels")(wheeled->track_m, wheeled->wheel_base_m, wheeled->wheel_radius_m,
                                   wheeled->wheel_speed_limit_radps, wheeled->effective_track_m);
  }
  return world_class("Vehicle")(name, vehicle.type, actuators, vehicle.mass_kg,
                                vehicle.max_speed_mps, vehicle.min_turning_radius_m,
                                rows_of(vehicle.footprint_B), wheels);
}

}  // namespace vinerow::python
