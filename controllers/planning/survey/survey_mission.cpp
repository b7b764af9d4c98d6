#include "controllers/planning/survey/survey_mission.h"

#include <limits>

#include "engine/io/missions/mav_command.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"

namespace vinerow::controllers {
namespace {

constexpr double kKeep = std::numeric_limits<double>::quiet_NaN();

}  // namespace

io::MissionFile make_survey_mission(const SurveyPlan& plan, const GeoOrigin& origin,
                                    double home_ground_m, bool returns) {
  const LocalFrame frame(origin);
  const std::vector<PathPoint>& points = plan.path.points;
  io::MissionFile mission;
  mission.format = "QGroundControl plan";
  const auto add = [&](int command, int map_frame, const std::array<double, 7>& params) {
    const int number = static_cast<int>(mission.items.size()) + 1;
    mission.items.push_back({command, map_frame, params, true, number});
  };
  const auto add_place = [&](int command, double first, const Eigen::Vector3d& p_W) {
    const Geodetic place = frame.to_geodetic(p_W);
    add(command, io::kFrameHome,
        {first, 0, 0, kKeep, deg_from_rad(place.latitude_rad), deg_from_rad(place.longitude_rad),
         p_W.z() - home_ground_m});
  };
  const Eigen::Vector3d home_W(points[0].p_W.x(), points[0].p_W.y(), home_ground_m);
  mission.planned_home = frame.to_geodetic(home_W);
  const double speed_mps = points[0].speed_mps;
  mission.rotorcraft = plan.rotorcraft;
  if (speed_mps > 0.0) {
    (plan.rotorcraft ? mission.hover_speed_mps : mission.cruise_speed_mps) = speed_mps;
  }
  const auto take_off = [&](double pitch_deg, const Eigen::Vector3d& p_W) {
    constexpr double kThroughAir = 0.0, kOverGround = 1.0;
    add_place(io::kNavTakeOff, pitch_deg, p_W);
    if (speed_mps > 0.0) {
      add(io::kDoChangeSpeed, io::kFrameMission,
          {plan.rotorcraft ? kOverGround : kThroughAir, speed_mps, -1, 0, 0, 0, 0});
    }
  };
  if (plan.rotorcraft) take_off(0.0, points[0].p_W);
  bool is_on = false;
  // "Return" leads to home itself.
  const std::size_t end = returns ? points.size() - 1 : points.size();
  for (std::size_t i = 1; i < end; ++i) {
    constexpr double kPitch_deg = 15.0;
    if (i == 1 && !plan.rotorcraft) {
      take_off(kPitch_deg, points[i].p_W);
    } else {
      add_place(io::kNavWaypoint, 0.0, points[i].p_W);
    }
    const bool is_lane = points[i].kind == PathKind::kLeg;
    if (is_lane == is_on) continue;
    is_on = is_lane;
    add(io::kDoSetCameraTriggerDistance, io::kFrameMission,
        {is_on ? plan.photo_distance_m : 0.0, 0, is_on ? 1.0 : 0.0, 0, 0, 0, 0});
  }
  if (returns) add(io::kNavReturn, io::kFrameMission, {0, 0, 0, 0, 0, 0, 0});
  return mission;
}

}  // namespace vinerow::controllers
