#include "controllers/planning/search/car_space.h"

#include <ompl/base/SpaceInformation.h>

#include <algorithm>

#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {
namespace ob = ompl::base;
}

CarSpace::CarSpace(double radius_m, const Eigen::Vector2d& low_W, const Eigen::Vector2d& high_W)
    : radius_m_(radius_m) {
  ob::RealVectorBounds bounds(2);
  for (unsigned int i = 0; i < 2; ++i) {
    bounds.setLow(i, low_W[i]);
    bounds.setHigh(i, high_W[i]);
  }
  setBounds(bounds);
}

Pose2 CarSpace::pose_of(const ob::State* state) {
  const auto* se2 = state->as<StateType>();
  return {{se2->getX(), se2->getY()}, se2->getYaw()};
}

void CarSpace::set_pose(const Pose2& pose, ob::State* state) {
  auto* se2 = state->as<StateType>();
  se2->setXY(pose.p.x(), pose.p.y());
  const double yaw_rad = wrap_angle(pose.yaw_rad);
  se2->setYaw(yaw_rad >= kPi ? -kPi : yaw_rad);
}

DubinsPath CarSpace::path_between(const ob::State* from, const ob::State* to) const {
  return calc_dubins(pose_of(from), pose_of(to), radius_m_);
}

double CarSpace::distance(const ob::State* from, const ob::State* to) const {
  return path_between(from, to).length_m();
}

void CarSpace::interpolate(const ob::State* from, const ob::State* to, double share,
                           ob::State* state) const {
  if (share >= 1.0) {
    if (state != to) copyState(state, to);
    return;
  }
  const DubinsPath path = path_between(from, to);
  set_pose(pose_on_dubins(pose_of(from), path, share * path.length_m()), state);
}

CarMotionValidator::CarMotionValidator(const ob::SpaceInformationPtr& si,
                                       const Footprint& footprint, double step_m, double longest_m)
    : MotionValidator(si), footprint_(footprint), step_m_(step_m), longest_m_(longest_m) {}

bool CarMotionValidator::checkMotion(const ob::State* from, const ob::State* to) const {
  const auto* space = si_->getStateSpace()->as<CarSpace>();
  const DubinsPath path = space->path_between(from, to);
  if (path.length_m() > longest_m_) return false;
  Pose2 pose = CarSpace::pose_of(from);
  for (const DubinsPath::Piece& piece : path.pieces) {
    if (piece.length_m > 0.0 &&
        !footprint_.is_free_along(pose, piece.length_m, piece.curvature_per_m, step_m_)) {
      return false;
    }
    pose = advance(pose, piece.length_m, piece.length_m * piece.curvature_per_m);
  }
  return footprint_.is_free(pose);
}

bool CarMotionValidator::checkMotion(const ob::State* from, const ob::State* to,
                                     std::pair<ob::State*, double>& last_valid) const {
  if (checkMotion(from, to)) return true;
  if (last_valid.first != nullptr) si_->copyState(last_valid.first, from);
  last_valid.second = 0.0;
  return false;
}

CarObjective::CarObjective(const ob::SpaceInformationPtr& si, const PathCost& cost,
                           double longest_m)
    : OptimizationObjective(si), cost_(cost), longest_m_(longest_m) {
  description_ = "length and clearance";
}

ob::Cost CarObjective::stateCost(const ob::State*) const {
  return ob::Cost(0.0);
}

ob::Cost CarObjective::motionCost(const ob::State* from, const ob::State* to) const {
  const DubinsPath path = si_->getStateSpace()->as<CarSpace>()->path_between(from, to);
  if (path.length_m() > longest_m_) return ob::Cost(cost_.max_of(path.length_m()));
  return ob::Cost(cost_.of(CarSpace::pose_of(from), path));
}

}  // namespace vinerow::controllers
