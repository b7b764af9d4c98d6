#include "tools/report/setup.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "engine/api/map.h"
#include "engine/api/vehicle.h"
#include "engine/api/wind.h"
#include "engine/api/world_model.h"
#include "engine/math/angles.h"
#include "tools/report/html.h"

namespace vinerow::tools::report {
namespace {

/// Number of height samples along and across the rows. Chosen.
constexpr int kPlaces = 25;

/// Gradient (rise over run) of the plane that best fits the ground below the rows.
std::optional<Eigen::Vector2d> gradient(const WorldModel& world) {
  if (!world.terrain) return std::nullopt;
  Eigen::AlignedBox2d box;
  for (const PlantRow& row : world.rows->rows) {
    for (const Eigen::Vector3d& p : row.line_W) box.extend(p.head<2>().eval());
  }
  if (box.isEmpty()) return std::nullopt;
  Eigen::Matrix3d sums = Eigen::Matrix3d::Zero();
  Eigen::Vector3d heights = Eigen::Vector3d::Zero();
  for (int i = 0; i < kPlaces; ++i) {
    for (int j = 0; j < kPlaces; ++j) {
      const Eigen::Vector2d share((i + 0.5) / kPlaces, (j + 0.5) / kPlaces);
      const Eigen::Vector2d p = box.min() + share.cwiseProduct(box.sizes());
      if (!world.terrain->contains(p.x(), p.y())) continue;
      const Eigen::Vector3d row(p.x() - box.center().x(), p.y() - box.center().y(), 1.0);
      sums += row * row.transpose();
      heights += row * world.terrain->height_m(p.x(), p.y());
    }
  }
  if (std::abs(sums.determinant()) < 1e-9) return std::nullopt;
  const Eigen::Vector3d plane = sums.ldlt().solve(heights);
  return Eigen::Vector2d(plane.head<2>());
}

std::string rows_text(const RowMap& map) {
  if (map.rows.empty()) return "";
  double length_m = 0.0, width_m = 0.0;
  for (const PlantRow& row : map.rows) {
    for (std::size_t i = 0; i + 1 < row.line_W.size(); ++i) {
      length_m += (row.line_W[i + 1] - row.line_W[i]).head<2>().norm();
    }
  }
  for (const Alley& alley : map.alleys) width_m += alley.width_m;
  std::string out =
      fmt::format("{} of {:.0f} m", counted(static_cast<long>(map.rows.size()), "row"),
                  length_m / static_cast<double>(map.rows.size()));
  if (!map.alleys.empty()) {
    out += fmt::format(", {:.1f} m apart", width_m / static_cast<double>(map.alleys.size()));
  }
  return out;
}

std::string slope_text(const WorldModel& world) {
  const auto g = gradient(world);
  if (!g) return "";
  std::string out = fmt::format("{:.0f} %", 100.0 * g->norm());
  const auto& line = world.rows->rows.front().line_W;
  const Eigen::Vector2d along = (line.back() - line.front()).head<2>().normalized();
  const Eigen::Vector2d across(-along.y(), along.x());
  if (g->norm() >= 0.005) {
    out += fmt::format(" ({:.0f} % along the rows, {:.0f} % across)",
                       100.0 * std::abs(g->dot(along)), 100.0 * std::abs(g->dot(across)));
  }
  return out;
}

std::string wind_text(const Wind& wind) {
  if (wind.calm()) return "calm";
  const double from_deg = deg_from_rad(wind.from_azimuth_rad);
  return fmt::format("{:.1f} m/s from {:.0f}° at {:g} m{}", wind.mean_speed_mps,
                     std::fmod(from_deg + 360.0, 360.0), wind.reference_height_m,
                     wind.turbulence > 0.0 ? ", turbulent" : "");
}

std::string type_text(std::string type) {
  for (char& c : type) c = c == '_' ? ' ' : c;
  return type;
}

/// "imu, gnss, 4 × ultrasound", in order of first occurrence.
std::string sensors_text(const scenario::VehicleConfig& vehicle) {
  std::vector<std::pair<std::string, int>> types;
  for (const scenario::NamedPart& sensor : vehicle.sensors) {
    const auto known = std::find_if(types.begin(), types.end(), [&](const auto& type) {
      return type.first == sensor.part.type;
    });
    if (known == types.end()) {
      types.emplace_back(sensor.part.type, 1);
    } else {
      ++known->second;
    }
  }
  std::string out;
  for (const auto& [type, count] : types) {
    out += (out.empty() ? "" : ", ") + (count > 1 ? fmt::format("{} × ", count) : "") +
           type_text(type);
  }
  return out.empty() ? "none" : out;
}

std::string parts_text(const scenario::VehicleConfig& vehicle, const RunFolder& run,
                       std::size_t v) {
  std::string out = type_text(vehicle.vehicle.type);
  const double mass_kg = v < run.models.size() ? run.models[v]->description().mass_kg : 0.0;
  if (mass_kg > 0.0) out += fmt::format(", {} kg", number_text(mass_kg));
  if (vehicle.controller) out += ", controller " + type_text(vehicle.controller->type);
  if (vehicle.autopilot) {
    out += ", autopilot " + type_text(vehicle.autopilot->type);
    if (vehicle.estimate_is_truth()) out += ", knows its true state";
  } else {
    out += vehicle.estimator ? ", estimator " + type_text(vehicle.estimator->type)
                             : ", knows its true state";
  }
  for (const scenario::NamedPart& payload : vehicle.payloads) out += ", payload " + payload.name;
  return out;
}

}  // namespace

std::string setup_table(const RunFolder& run) {
  if (!run.scenario || !run.world) return "";
  std::vector<std::vector<std::string>> rows;
  std::string place;
  const auto add = [&](const std::string& what, const std::string& value) {
    if (value.empty()) return;
    place += fmt::format("{}{}{}", place.empty() ? "" : " · ", what.empty() ? "" : what + " ",
                         escaped(value));
  };
  add("", rows_text(*run.world->rows));
  add("slope", slope_text(*run.world));
  add("soil", type_text(run.world->soil.name));
  add("wind", wind_text(run.world->wind));
  rows.push_back({"place", place});
  for (std::size_t v = 0; v < run.scenario->vehicles.size(); ++v) {
    const scenario::VehicleConfig& vehicle = run.scenario->vehicles[v];
    rows.push_back(
        {escaped(vehicle.name),
         fmt::format("{}<br/><span class=\"sensors\">sensors: {}</span>",
                     escaped(parts_text(vehicle, run, v)), escaped(sensors_text(vehicle)))});
  }
  return "<h2 class=\"quiet\">Simulated setup</h2>\n" + table({}, rows, "facts setup");
}

}  // namespace vinerow::tools::report
