#pragma once
/// Where RRT* looks: along the first way, around it, and wherever a shorter way could pass.

#include <ompl/base/StateSampler.h>

#include <functional>
#include <vector>

#include "controllers/planning/search/car_space.h"
#include "engine/core/random.h"

namespace vinerow::controllers {

struct CarSampling {
  Pose2 from, to;
  /// Poses of a first way: given out first, one after the other, so that the tree holds that way;
  /// later as centres to look around. May be empty.
  std::vector<Pose2> first_way;
  /// A way through a sample must be able to cost less: its Dubins lengths from `from` and to `to`
  /// together (informed sampling after Gammell, Srinivasa, Barfoot, "Informed RRT*", IROS 2014, by
  /// rejection). Infinite where no way is known.
  std::function<double()> best_cost;
  const Footprint* footprint = nullptr;
  double near_share = 0.5;  ///< of the samples around the first way
  double near_m = 0.6;      ///< standard deviation of those
  double near_rad = 0.4;
};

class CarSampler final : public ompl::base::StateSampler {
 public:
  /// @param sampling, random  must outlive this
  CarSampler(const CarSpace* space, const CarSampling& sampling, RandomStream& random);

  void sampleUniform(ompl::base::State* state) override;
  void sampleUniformNear(ompl::base::State* state, const ompl::base::State* near,
                         double distance) override;
  void sampleGaussian(ompl::base::State* state, const ompl::base::State* mean,
                      double std_dev) override;

 private:
  Pose2 draw();
  bool is_worth(const Pose2& pose) const;

  const CarSpace& car_;
  const CarSampling& sampling_;
  RandomStream& random_;
  std::size_t given_out_ = 0;
};

}  // namespace vinerow::controllers
