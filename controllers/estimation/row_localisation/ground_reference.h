#pragma once
/// What ties a vehicle to the ground between mapped rows: a range sensor that looks down at it, or
/// wheels that stand on it.

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

/// n.p of the body's origin p in W, n unit.
struct PlaneReading {
  Time measured;
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();
  double offset_m = 0.0;
  double std_m = 0.05;
};

struct GroundParams {
  std::string down;               ///< range sensor that looks at the ground; empty: none
  std::optional<bool> on_ground;  ///< absent: whether the vehicle does not fly
  double ground_std_m = 0.05;     ///< 1 sigma of a height above the ground between the rows
};

/// `down`, `on_ground` and `ground_std_m`.
const ParameterTable<GroundParams>& ground_table();

class GroundReference {
 public:
  /// @param map  nullptr: the estimator uses none  @param who  for errors: "rover.estimator (x)"
  /// @throws ConfigError where `down` is no sensor of the vehicle, `on_ground` is said of what
  /// flies, or no two rows tell the ground
  GroundReference(const GroundParams& params, const EstimatorContext& context, const RowMap* map,
                  const std::string& who);

  /// Whether a sensor of this name is the one that looks down, and so at no wall.
  bool looks_down(const std::string& sensor) const { return down_ && down_->name == sensor; }
  void connect(Ports& ports);
  /// One after another what is new; then nothing. @param q_WB, p_W  the vehicle as far as it is
  /// known
  std::optional<PlaneReading> read(Time now, const Eigen::Quaterniond& q_WB,
                                   const Eigen::Vector3d& p_W);

  /// Whether an echo may come from the ground, which stands on no map of walls: it is as long as
  /// the way to the nearest ground in the sensor's cone, or longer. So it is when a vehicle that
  /// flies stands on a slope.
  bool may_be_ground(const Pose& X_WB, const RangeSensorModel& sensor, double half_angle_rad,
                     double range_m) const;

 private:
  std::optional<PlaneReading> read_down(const Eigen::Quaterniond& q_WB,
                                        const Eigen::Vector3d& p_W) const;
  std::optional<PlaneReading> stand(Time now, const Eigen::Vector3d& p_W) const;
  double std_m(const GroundPlane& ground) const;

  std::optional<RowGround> ground_;  // where the map has rows that tell it
  double ground_std_m_;
  std::optional<double> height_m_;  // of B's origin where wheels stand on the ground
  Time next_;                       // when they tell it again
  std::optional<RangeSensorModel> down_;
  SignalReader<RangeSample> reader_;
  std::uint64_t seen_ = 0;
};

}  // namespace vinerow::controllers
