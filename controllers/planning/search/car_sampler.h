#pragma once
/// Sampler of RRT*: along the initial path, around it, and wherever a cheaper path could pass.

#include <ompl/base/StateSampler.h>

#include <functional>
#include <vector>

#include "controllers/planning/search/car_space.h"
#include "engine/core/random.h"

namespace vinerow::controllers {

struct CarSampling {
  Pose2 from, to;
  /// Poses of an initial path. They are the first samples, one after the other, so that the tree
  /// contains that path; later they are centres of samples. May be empty.
  std::vector<Pose2> initial_path;
  /// Cost of the best path so far. A sample is rejected unless the sum of its Dubins lengths from
  /// `from` and to `to` is below it (informed sampling by rejection, after Gammell, Srinivasa,
  /// Barfoot, "Informed RRT*", IROS 2014). Infinite if no path is known.
  std::function<double()> best_cost;
  const Footprint* footprint = nullptr;
  double near_share = 0.5;  ///< share of the samples around the initial path
  double near_m = 0.6;      ///< standard deviation of their positions
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
