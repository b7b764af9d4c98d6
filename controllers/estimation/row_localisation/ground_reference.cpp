#include "controllers/estimation/row_localisation/ground_reference.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "controllers/estimation/row_localisation/range_sensors.h"
#include "engine/api/parameter_table.h"
#include "engine/api/vehicle.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

constexpr Duration kPeriod{200'000'000};  // of heights from wheels, like that of a slow sensor
constexpr double kGrass_m = 0.1;          // height of grass and clods, which echo first
constexpr double kGradeStd = 0.05;        // 1 sigma of the plane's slope away from the rows

/// Height of the body's origin above the ground, for a vehicle that rolls on it.
std::optional<double> rest_height_m(const std::optional<bool>& on_ground,
                                    const VehicleDescription* vehicle, const RowMap* map,
                                    const std::string& who) {
  const bool may =
      vehicle != nullptr && !vehicle->flies() && map != nullptr && map->rows.size() >= 2;
  if (on_ground.value_or(false) && !may) {
    throw ConfigError(fmt::format(
        "{}: on_ground is true, but {}", who,
        vehicle == nullptr ? "the vehicle is unknown"
        : vehicle->flies() ? "the vehicle flies"
                           : "the map has fewer than two rows, so its ground is unknown"));
  }
  if (!may || !on_ground.value_or(true)) return std::nullopt;
  return vehicle->height_above_ground_m;
}

}  // namespace

const ParameterTable<GroundParams>& ground_table() {
  using P = GroundParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("down", &P::down, "name of a range sensor that looks at the ground; '' = none")
          .boolean("on_ground", &P::on_ground,
                   "whether wheels are on the mapped ground, which gives the height; if absent: "
                   "true for vehicles that do not fly")
          .number("ground_std_m", "m", &P::ground_std_m, kPositive,
                  "1 sigma of a height above the ground between the rows");
  return table;
}

GroundReference::GroundReference(const GroundParams& params, const EstimatorContext& context,
                                 const RowMap* map, const std::string& who)
    : ground_std_m_(params.ground_std_m),
      height_m_(rest_height_m(params.on_ground, context.vehicle_description, map, who)) {
  if (map != nullptr && map->rows.size() >= 2) ground_.emplace(*map);
  const std::string& down = params.down;
  if (down.empty()) return;
  down_ = find_range_sensors({down}, context, who, "down").front();
  if (!ground_) {
    throw ConfigError(fmt::format(
        "{}: down is '{}', but the map has fewer than two rows, so its ground is unknown", who,
        down));
  }
}

void GroundReference::connect(Ports& ports) {
  if (down_) reader_ = ports.read<RangeSample>(down_->name);
}

std::optional<PlaneReading> GroundReference::read(Time now, const Eigen::Quaterniond& q_WB,
                                                  const Eigen::Vector3d& p_W) {
  if (down_ && reader_.is_newer_than(seen_)) {
    if (const auto seen = read_down(q_WB, p_W)) return seen;
  }
  if (!height_m_ || now < next_) return std::nullopt;
  next_ = now + kPeriod;
  return stand(now, p_W);
}

std::optional<PlaneReading> GroundReference::stand(Time now, const Eigen::Vector3d& p_W) const {
  const auto ground = ground_->at(p_W);
  if (!ground) return std::nullopt;
  return PlaneReading{now, ground->normal_W, ground->offset_m + *height_m_, std_m(*ground)};
}

bool GroundReference::may_be_ground(const Pose& X_WB, const RangeSensorModel& sensor,
                                    double half_angle_rad, double range_m) const {
  if (!ground_) return false;
  const auto ground = ground_->at(X_WB.p);
  if (!ground) return false;
  const auto nearest_m =
      nearest_in_cone_m(*ground, X_WB * sensor.X_BS.p,
                        X_WB.q * sensor.X_BS.q * Eigen::Vector3d::UnitX(), half_angle_rad);
  return nearest_m && range_m > *nearest_m - kGrass_m - 2.0 * std_m(*ground);
}

double GroundReference::std_m(const GroundPlane& ground) const {
  return std::hypot(ground_std_m_, kGradeStd * ground.away_m);
}

std::optional<PlaneReading> GroundReference::read_down(const Eigen::Quaterniond& q_WB,
                                                       const Eigen::Vector3d& p_W) const {
  const RangeSample& sample = reader_.value();
  if (std::isinf(sample.range_m)) return std::nullopt;  // a missing echo has no information
  // An invalid distance becomes NaN, which the estimator rejects and counts.
  const double range_m =
      sample.range_m >= 0.0 ? sample.range_m : std::numeric_limits<double>::quiet_NaN();
  const auto ground = ground_->at(p_W);
  if (!ground) return std::nullopt;
  const Eigen::Vector3d dir_W = q_WB * down_->X_BS.q * Eigen::Vector3d::UnitX();
  const auto distance_m = plane_distance_m(*ground, dir_W, sample.half_angle_rad, range_m);
  if (!distance_m) return std::nullopt;
  const double lever_m = ground->normal_W.dot(q_WB * down_->X_BS.p);
  const double offset_m = ground->offset_m + *distance_m - lever_m;
  return PlaneReading{reader_.stamp(), ground->normal_W, offset_m, std_m(*ground)};
}

}  // namespace vinerow::controllers
