#pragma once
/// Default estimator, whose estimate is the truth.

#include "engine/api/registry.h"
#include "engine/api/stepped_parts.h"

namespace vinerow {

class TruthEstimator final : public Estimator {
 public:
  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    estimate_ = ports.write<Odometry>("estimate");
  }
  void step(Time now) override { estimate_.write(now, truth_.value()); }

 private:
  SignalReader<Odometry> truth_;
  SignalWriter<Odometry> estimate_;
};

/// Registers it as `truth`, for scenarios that name it.
void register_truth_estimator(Registry& registry);

}  // namespace vinerow
