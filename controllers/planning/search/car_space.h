#pragma once
/// OMPL's view of a vehicle that drives forward with a least turning radius.
///
/// OMPL's own DubinsStateSpace is not used: in the version that Debian ships it asserts on rounding
/// (a heading of exactly pi, words of nearly no length) and would end the process.

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/spaces/SE2StateSpace.h>

#include "controllers/planning/search/way_cost.h"

namespace vinerow::controllers {

/// Poses; the distance from one to another is the length of the shortest Dubins path.
class CarSpace final : public ompl::base::SE2StateSpace {
 public:
  /// @param low_W, high_W  corners of the box that positions lie in
  CarSpace(double radius_m, const Eigen::Vector2d& low_W, const Eigen::Vector2d& high_W);

  double radius_m() const { return radius_m_; }
  static Pose2 pose_of(const ompl::base::State* state);
  /// The heading is wrapped to [-pi, pi), which OMPL asks for.
  static void set_pose(const Pose2& pose, ompl::base::State* state);
  DubinsPath path_between(const ompl::base::State* from, const ompl::base::State* to) const;

  bool isMetricSpace() const override { return false; }
  bool hasSymmetricDistance() const override { return false; }
  bool hasSymmetricInterpolate() const override { return false; }
  double distance(const ompl::base::State* from, const ompl::base::State* to) const override;
  void interpolate(const ompl::base::State* from, const ompl::base::State* to, double share,
                   ompl::base::State* state) const override;

 private:
  double radius_m_;
};

/// Is the Dubins path between two states free for the whole outline, and short enough for an edge?
/// Between poses side by side it is a loop of several radii, and trees hold none of those.
class CarMotionValidator final : public ompl::base::MotionValidator {
 public:
  /// @param footprint  must outlive this
  CarMotionValidator(const ompl::base::SpaceInformationPtr& si, const Footprint& footprint,
                     double step_m, double longest_m);

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override;
  /// Asked by no planner used here. The last valid state is the first.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last_valid) const override;

 private:
  const Footprint& footprint_;
  double step_m_;
  double longest_m_;
};

/// WayCost as OMPL wants it. Motions too long for an edge cost the most that their length can,
/// which is quickly worked out.
class CarObjective final : public ompl::base::OptimizationObjective {
 public:
  /// @param cost  must outlive this
  CarObjective(const ompl::base::SpaceInformationPtr& si, const WayCost& cost, double longest_m);

  ompl::base::Cost stateCost(const ompl::base::State* state) const override;
  ompl::base::Cost motionCost(const ompl::base::State* from,
                              const ompl::base::State* to) const override;
  bool isSymmetric() const override { return false; }

 private:
  const WayCost& cost_;
  double longest_m_;
};

}  // namespace vinerow::controllers
