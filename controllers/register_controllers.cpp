#include "controllers/register_controllers.h"

#include "controllers/autopilot/ardupilot/ardupilot.h"
#include "controllers/autopilot/px4/px4.h"
#include "controllers/autopilot/replay/replay.h"
#include "controllers/dwa/dwa.h"
#include "controllers/estimation/inertial/error_state_estimator.h"
#include "controllers/estimation/odometry/gps_pose.h"
#include "controllers/estimation/odometry/odometry_filter.h"
#include "controllers/estimation/row_camera/row_camera.h"
#include "controllers/estimation/row_localisation/distance_filter.h"
#include "controllers/estimation/row_localisation/map_localisation.h"
#include "controllers/fixed_wing_lqr/fixed_wing_lqr.h"
#include "controllers/fixed_wing_pid/fixed_wing_pid.h"
#include "controllers/four_wheel_steering/four_wheel_steering.h"
#include "controllers/mpc_nominal/mpc_nominal.h"
#include "controllers/path_follower/path_follower.h"
#include "controllers/planning/flight/mission_route.h"
#include "controllers/planning/flight/row_flight.h"
#include "controllers/planning/routes/coverage_planner.h"
#include "controllers/planning/routes/go_to.h"
#include "controllers/planning/routes/remote_goal.h"
#include "controllers/planning/routes/rrt_quartile_planner.h"
#include "controllers/planning/routes/rrt_star.h"
#include "controllers/planning/routes/waypoints.h"
#include "controllers/planning/survey/survey.h"
#include "controllers/pure_pursuit/pure_pursuit.h"
#include "controllers/quadrotor_lqr/quadrotor_lqr.h"
#include "controllers/quadrotor_mpc/quadrotor_mpc.h"
#include "controllers/quadrotor_pid/quadrotor_pid.h"
#include "controllers/remote/remote_actuators.h"
#include "controllers/remote/remote_velocity.h"
#include "controllers/trajectory/trajectory.h"
#include "controllers/trmpc/trmpc.h"
#include "controllers/waypoint_guidance/waypoint_guidance.h"

namespace vinerow::controllers {

void register_controllers(Registry& registry) {
  registry.add_estimator(error_state_kalman_spec(), make_error_state_kalman);
  registry.add_estimator(distance_filter_spec(), make_distance_filter);
  registry.add_estimator(map_localisation_spec(), make_map_localisation);
  registry.add_estimator(gps_pose_spec(), make_gps_pose);
  registry.add_estimator(odometry_filter_spec(), make_odometry_filter);
  registry.add_estimator(row_camera_spec(), make_row_camera);
  registry.add_planner(coverage_spec(), make_coverage);
  registry.add_planner(go_to_spec(), make_go_to);
  registry.add_planner(mission_route_spec(), make_mission_route);
  registry.add_planner(row_flight_spec(), make_row_flight);
  registry.add_planner(rrt_quartile_spec(), make_rrt_quartile);
  registry.add_planner(rrt_star_spec(), make_rrt_star);
  registry.add_planner(survey_spec(), make_survey);
  registry.add_planner(waypoints_spec(), make_waypoints);
  registry.add_guidance(dwa_spec(), make_dwa);
  registry.add_guidance(remote_goal_spec(), make_remote_goal);
  registry.add_guidance(trajectory_spec(), make_trajectory);
  registry.add_guidance(waypoint_guidance_spec(), make_waypoint_guidance);
  registry.add_controller(pure_pursuit_spec(), make_pure_pursuit);
  registry.add_controller(path_follower_spec(), make_path_follower);
  registry.add_controller(four_wheel_steering_spec(), make_four_wheel_steering);
  registry.add_controller(fixed_wing_lqr_spec(), make_fixed_wing_lqr);
  registry.add_controller(fixed_wing_pid_spec(), make_fixed_wing_pid);
  registry.add_controller(quadrotor_lqr_spec(), make_quadrotor_lqr);
  registry.add_controller(quadrotor_pid_spec(), make_quadrotor_pid);
  registry.add_controller(quadrotor_mpc_spec(), make_quadrotor_mpc);
  registry.add_controller(remote_velocity_spec(), make_remote_velocity);
  registry.add_controller(remote_actuators_spec(), make_remote_actuators);
  registry.add_autopilot(ardupilot_spec(), make_ardupilot);
  registry.add_autopilot(px4_spec(), make_px4);
  registry.add_autopilot(autopilot_replay_spec(), make_autopilot_replay);
  registry.add_controller(mpc_nominal_spec(), make_mpc_nominal);
  registry.add_controller(trmpc_spec(), make_trmpc);
}

}  // namespace vinerow::controllers
