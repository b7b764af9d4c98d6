#pragma once
/// The laboratory's flights for MapLocalisationLaw.

#include <memory>

#include "controllers/estimation/row_localisation/map_localisation_law.h"
#include "tests/controllers/estimation/row_localisation/localisation_lab.h"

namespace vinerow::test {

class MapLocalisationFilter final : public LabFilter {
 public:
  /// @param on_map  judged by its place beside the map's walls instead of that in W
  MapLocalisationFilter(const controllers::MapLocalisationParams& params, const LabContext& context,
                        bool on_map = false)
      : law_(params, context.map, context.index, context.sensors),
        on_map_(on_map),
        period_s_(0.01 * context.setup.range_every) {}

  void start(Time now, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance) override {
    law_.start(now, p_W, covariance);
  }
  void inertial(Time now, const Eigen::Vector3d& v_W, const Eigen::Quaterniond& q_WB,
                const Eigen::Vector3d&, const Eigen::Vector3d&) override {
    law_.predict(now, v_W, q_WB);
  }
  void fix(Time measured, const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m) override {
    law_.correct_fix(measured, p_W, std_m, Eigen::Vector3d::Zero());
  }
  void height(Time measured, double z_m, double std_m) override {
    law_.correct_plane(measured, Eigen::Vector3d::UnitZ(), z_m, std_m);
  }
  void ranges(Time measured, std::span<const controllers::RangeReading> readings) override {
    for (const controllers::RangeReading& reading : readings) {
      if (std::isfinite(reading.range_m)) {
        law_.correct_range(measured, reading.sensor, reading.range_m, period_s_);
      }
    }
  }
  Eigen::Vector3d p_W() const override {
    return on_map_ ? law_.position_on_map() : law_.state().p_W();
  }
  Eigen::Matrix3d covariance() const override {
    return on_map_ ? law_.position_on_map_covariance() : law_.position_covariance();
  }
  const controllers::MapLocalisationLaw& law() const { return law_; }

 private:
  controllers::MapLocalisationLaw law_;
  bool on_map_;
  double period_s_;
};

inline LabFilterMaker map_localisation(const controllers::MapLocalisationParams& params = {},
                                       bool on_map = false) {
  return [params, on_map](const LabContext& context) {
    return std::make_unique<MapLocalisationFilter>(params, context, on_map);
  };
}

}  // namespace vinerow::test
