#pragma once
/// Height reference of a vehicle between mapped rows: a range sensor that looks down at the ground,
/// or wheels on the ground.

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "controllers/estimation/row_localisation/range_prediction.h"
#include "controllers/estimation/row_localisation/row_ground.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/api/stepped_parts.h"

namespace vinerow::controllers {

/// Measurement of n.p for the body's origin p in W, n unit.
struct PlaneReading {
  Time measured;
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  double offset_m = 0.0;
  double std_m = 0.05;
};

struct GroundParams {
  std::string down;               ///< range sensor that looks at the ground; empty: none
  std::optional<bool> on_ground;  ///< absent: true if the vehicle does not fly
  double ground_std_m = 0.05;     ///< 1 sigma of a height above the ground between the rows
};

/// `down`, `on_ground` and `ground_std_m`.
const ParameterTable<GroundParams>& ground_table();

class GroundReference {
 public:
  /// @param map  nullptr: the estimator uses no map @param who  for errors: "rover.estimator (x)"
  /// @throws ConfigError if `down` is not a range sensor of the vehicle, if `on_ground` is true for
  /// a flying vehicle, or if either is set and the map has fewer than two rows
  GroundReference(const GroundParams& params, const EstimatorContext& context, const RowMap* map,
                  const std::string& who);

  /// Whether the sensor of this name looks down, and so not at a wall.
  bool looks_down(const std::string& sensor) const { return down_ && down_->name == sensor; }
  void connect(Ports& ports);
  /// Returns new readings one after another, then nullopt. @param q_WB, p_W estimated pose of the
  /// vehicle
  std::optional<PlaneReading> read(Time now, const Eigen::Quaterniond& q_WB,
                                   const Eigen::Vector3d& p_W);

  /// Whether an echo may come from the ground, which is not on a map of walls: whether it is at
  /// least as long as the distance to the nearest ground in the sensor's cone. This happens when a
  /// flying vehicle stands on a slope.
  bool may_be_ground(const Pose& X_WB, const RangeSensorModel& sensor, double half_angle_rad,
                     double range_m) const;

 private:
  std::optional<PlaneReading> read_down(const Eigen::Quaterniond& q_WB,
                                        const Eigen::Vector3d& p_W) const;
  std::optional<PlaneReading> stand(Time now, const Eigen::Vector3d& p_W) const;
  double std_m(const GroundPlane& ground) const;

  std::optional<RowGround> ground_;  // if the map defines it
  double ground_std_m_;
  std::optional<double> height_m_;  // of B's origin above the ground, if the vehicle is on wheels
  Time next_;                       // time of the next height from wheels
  std::optional<RangeSensorModel> down_;
  SignalReader<RangeSample> reader_;
  std::uint64_t seen_ = 0;
};

}  // namespace vinerow::controllers
