#include "engine/sensors/gnss_heading.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/messages/heading.h"
#include "engine/api/world_model.h"
#include "engine/sensors/gnss_error.h"
#include "engine/sensors/gnss_mode.h"
#include "engine/sensors/gnss_tracking.h"
#include "engine/sensors/mounted_sensor.h"

namespace vinerow::sensors {
namespace {

/// Defaults: u-blox, ZED-F9P and ZED-F9H data sheets, moving base: heading accuracy 0.4 deg over 1
/// m, which is 7.0 mm across the baseline (secondary source; the data sheets were not available).
/// Share of white noise and correlation time as for an RTK fix (gnss_error.h); twice the error in
/// height is chosen.
struct GnssHeadingParams {
  double baseline_m = 1.0;
  GnssPair white_std_m{0.0040, 0.0080};
  GnssPair walk_std_m{0.0057, 0.0114};
  double walk_time_s = 60.0;
  GnssPair usual_dop{1.0, 1.45};
  GnssSkyParams sky;
  GnssModeRules modes;
  GnssSignals signals;
};

const ParameterTable<GnssHeadingParams>& gnss_heading_table() {
  using P = GnssHeadingParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("baseline_m", "m", &P::baseline_m, between(0.1, 50.0),
                  "distance from the first antenna to the second, along x of the sensor")
          .numbers("white_std_m", "m", &P::white_std_m, between(0.0, 10.0),
                   "white error of the baseline, horizontal and vertical")
          .numbers("walk_std_m", "m", &P::walk_std_m, between(0.0, 10.0),
                   "slowly varying error of the baseline, horizontal and vertical")
          .number("walk_time_s", "s", &P::walk_time_s, kPositive,
                  "correlation time of the slowly varying error")
          .numbers("usual_dop", "", &P::usual_dop, above(0.0, 1e3),
                   "horizontal, vertical dilution for which these errors hold")
          .include(&P::sky, gnss_sky_table())
          .integer("fixed_satellites", inside(&P::modes, &GnssModeRules::fixed_satellites),
                   between(5, 50), "minimum number of satellites by carrier phase at each antenna")
          .number("max_rtk_pdop", "", inside(&P::modes, &GnssModeRules::max_rtk_pdop),
                  between(1.0, 1e3), "maximum dilution")
          .number("time_to_fix_s", "s", inside(&P::modes, &GnssModeRules::time_to_fix_s),
                  between(0.0, 1e4), "time until the ambiguities are first resolved")
          .number("time_to_refix_s", "s", inside(&P::modes, &GnssModeRules::time_to_refix_s),
                  between(0.0, 1e4), "time until they are resolved again")
          .include(&P::signals, gnss_signal_table());
  return table;
}

class GnssHeadingSensor final : public MountedSensor<GnssHeading> {
 public:
  GnssHeadingSensor(const ParameterSet& parameters, const SensorContext& context)
      : GnssHeadingSensor(gnss_heading_table().read(parameters, context.part), parameters,
                          context) {}
  GnssHeadingSensor(const GnssHeadingParams& params, const ParameterSet& parameters,
                    const SensorContext& context)
      : MountedSensor(parameters, context),
        params_(params),
        first_(params.signals, make_gnss_sky(params.sky, context.world->origin, context.part),
               *context.scene, LeafAreaDensity(*context.world), context.period.s(), true,
               context.random("fading")),
        second_(params.signals, make_gnss_sky(params.sky, context.world->origin, context.part),
                *context.scene, LeafAreaDensity(*context.world), context.period.s(), true,
                context.random("fading_second")),
        modes_(params.modes, context.period.s()),
        random_(context.random()) {
    for (GaussMarkov& walk : walks_) {
      walk = GaussMarkov(1.0, params_.walk_time_s, context.period.s());
      walk.start(random_);
    }
  }

  void step(Time now) override {
    for (GaussMarkov& walk : walks_) walk.step(random_);
    const double z = random_.normal(), y = random_.normal(), x = random_.normal();
    const Eigen::Vector3d white(x, y, z);
    const Pose X_WA = X_WS();
    const Eigen::Vector3d baseline_W = X_WA.q * Eigen::Vector3d(params_.baseline_m, 0.0, 0.0);
    GnssHeading exact = reading_of(baseline_W, Eigen::Vector3d::Zero());

    const bool in_outage = readings_.is_in_outage(now);
    const GnssView here = first_.look(now.s(), X_WA.p, in_outage, 0.0);
    const GnssView there = second_.look(now.s(), X_WA.p + baseline_W, in_outage, 0.0);
    const int satellites = std::min(here.carrier.count(), there.carrier.count());
    const double none = std::numeric_limits<double>::infinity();
    Dilution first, second;
    const bool both = here.carrier.read(first) && there.carrier.read(second);
    const double pdop = both ? std::max(first.position(), second.position()) : none;
    const bool fixed = modes_.step(pdop, satellites, pdop) == GnssFix::Mode::kFixed;
    exact.satellites = satellites;

    GnssHeading reading;
    if (fixed) {
      const Eigen::Vector3d dilution = first.axes.cwiseMax(second.axes);
      Eigen::Vector3d error, std;
      for (int axis = 0; axis < 3; ++axis) {
        const int kind = axis == 2 ? 1 : 0;
        const double usual =
            axis == 2 ? params_.usual_dop[1] : params_.usual_dop[0] / std::sqrt(2.0);
        const double scale = dilution[axis] / usual;
        error[axis] = scale * (params_.white_std_m[kind] * white[axis] +
                               params_.walk_std_m[kind] * walks_[axis].value());
        std[axis] = scale * std::hypot(params_.white_std_m[kind], params_.walk_std_m[kind]);
      }
      reading = reading_of(baseline_W + error, std);
    }
    reading.satellites = satellites;
    readings_.push(now, reading, exact);
  }

 private:
  GnssHeading reading_of(const Eigen::Vector3d& baseline_W, const Eigen::Vector3d& std_m) const {
    GnssHeading reading;
    reading.valid = true;
    reading.length_m = params_.baseline_m;
    reading.baseline_W = baseline_W;
    reading.std_m = std_m;
    const Eigen::Vector2d in_plane = baseline_W.head<2>();
    reading.heading_rad = std::atan2(in_plane.y(), in_plane.x());
    // d heading = (-y dx + x dy) / r^2
    const double r2 = std::max(in_plane.squaredNorm(), 1e-12);
    reading.heading_std_rad = std::hypot(in_plane.y() * std_m.x(), in_plane.x() * std_m.y()) / r2;
    return reading;
  }

  GnssHeadingParams params_;
  GnssTracking first_, second_;
  GnssModes modes_;
  RandomStream random_;
  std::array<GaussMarkov, 3> walks_;
};

}  // namespace

PartSpec gnss_heading_spec() {
  return mounted_sensor_spec<GnssHeading>(
      "gnss_heading",
      "Heading and slope by two satellite antennas (moving baseline by carrier phase), visible "
      "past ground, posts and leaves",
      5.0, gnss_heading_table());
}

std::unique_ptr<Sensor> make_gnss_heading(const ParameterSet& parameters,
                                          const SensorContext& context) {
  return std::make_unique<GnssHeadingSensor>(parameters, context);
}

}  // namespace vinerow::sensors
