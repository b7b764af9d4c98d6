#pragma once
/// OMPL state space, motion validator and objective of a vehicle that drives forward with a minimum
/// turning radius.
///
/// OMPL's own DubinsStateSpace is not used: in the version that Debian ships its assertions fail on
/// rounding (a heading of exactly pi, words of nearly zero length) and end the process.

#include <ompl/base/MotionValidator.h>
#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/spaces/SE2StateSpace.h>

#include "controllers/planning/search/path_cost.h"

namespace vinerow::controllers {

/// Space of poses; the distance from one to another is the length of the shortest Dubins path.
class CarSpace final : public ompl::base::SE2StateSpace {
 public:
  /// @param low_W, high_W  corners of the box that contains all positions
  CarSpace(double radius_m, const Eigen::Vector2d& low_W, const Eigen::Vector2d& high_W);

  double radius_m() const { return radius_m_; }
  static Pose2 pose_of(const ompl::base::State* state);
  /// Wraps the heading to [-pi, pi), as OMPL requires.
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

/// Validator: the Dubins path between two states is free for the whole outline and short enough for
/// an edge. Between poses side by side the path is a loop of several radii, which trees do not use.
class CarMotionValidator final : public ompl::base::MotionValidator {
 public:
  /// @param footprint  must outlive this
  CarMotionValidator(const ompl::base::SpaceInformationPtr& si, const Footprint& footprint,
                     double step_m, double longest_m);

  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to) const override;
  /// Not called by the planners used here. The last valid state is the first.
  bool checkMotion(const ompl::base::State* from, const ompl::base::State* to,
                   std::pair<ompl::base::State*, double>& last_valid) const override;

 private:
  const Footprint& footprint_;
  double step_m_;
  double longest_m_;
};

/// PathCost as an OMPL objective. Motions too long for an edge get the upper bound of the cost for
/// their length, which is cheap to compute.
class CarObjective final : public ompl::base::OptimizationObjective {
 public:
  /// @param cost  must outlive this
  CarObjective(const ompl::base::SpaceInformationPtr& si, const PathCost& cost, double longest_m);

  ompl::base::Cost stateCost(const ompl::base::State* state) const override;
  ompl::base::Cost motionCost(const ompl::base::State* from,
                              const ompl::base::State* to) const override;
  bool isSymmetric() const override { return false; }

 private:
  const PathCost& cost_;
  double longest_m_;
};

}  // namespace vinerow::controllers
