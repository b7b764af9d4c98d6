#include "controllers/planning/search/car_sampler.h"

#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {
namespace ob = ompl::base;
constexpr int kMaxTries = 50;  // then a sample that cannot improve the path is accepted
}  // namespace

CarSampler::CarSampler(const CarSpace* space, const CarSampling& sampling, RandomStream& random)
    : StateSampler(space), car_(*space), sampling_(sampling), random_(random) {}

Pose2 CarSampler::draw() {
  const auto& path = sampling_.initial_path;
  if (!path.empty() && random_.uniform() < sampling_.near_share) {
    const auto at = static_cast<std::size_t>(random_.uniform() * static_cast<double>(path.size()));
    const double x = random_.normal(), y = random_.normal(), yaw = random_.normal();
    return {path[at].p + sampling_.near_m * Eigen::Vector2d(x, y),
            path[at].yaw_rad + sampling_.near_rad * yaw};
  }
  const ob::RealVectorBounds& box = car_.getBounds();
  const double x = random_.uniform(box.low[0], box.high[0]);
  const double y = random_.uniform(box.low[1], box.high[1]);
  return {{x, y}, random_.uniform(-kPi, kPi)};
}

bool CarSampler::is_worth(const Pose2& pose) const {
  const ob::RealVectorBounds& box = car_.getBounds();
  if (pose.p.x() < box.low[0] || pose.p.x() > box.high[0] || pose.p.y() < box.low[1] ||
      pose.p.y() > box.high[1] || !sampling_.footprint->is_free(pose)) {
    return false;
  }
  const double best = sampling_.best_cost();
  if ((pose.p - sampling_.from.p).norm() + (sampling_.to.p - pose.p).norm() >= best) return false;
  const double there_m = calc_dubins(sampling_.from, pose, car_.radius_m()).length_m();
  if (there_m >= best) return false;
  return there_m + calc_dubins(pose, sampling_.to, car_.radius_m()).length_m() < best;
}

void CarSampler::sampleUniform(ob::State* state) {
  if (given_out_ < sampling_.initial_path.size()) {
    CarSpace::set_pose(sampling_.initial_path[given_out_++], state);
    return;
  }
  Pose2 pose = draw();
  for (int i = 0; i < kMaxTries && !is_worth(pose); ++i) pose = draw();
  CarSpace::set_pose(pose, state);
  car_.enforceBounds(state);
}

void CarSampler::sampleUniformNear(ob::State* state, const ob::State* near, double distance) {
  sampleGaussian(state, near, distance);
}

void CarSampler::sampleGaussian(ob::State* state, const ob::State* mean, double std_dev) {
  const Pose2 centre = CarSpace::pose_of(mean);
  const double x = random_.normal(), y = random_.normal(), yaw = random_.normal();
  CarSpace::set_pose({centre.p + std_dev * Eigen::Vector2d(x, y), centre.yaw_rad + std_dev * yaw},
                     state);
  car_.enforceBounds(state);
}

}  // namespace vinerow::controllers
