#include "engine/sensors/gnss.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/sensors/gnss_error.h"
#include "engine/sensors/gnss_mode.h"
#include "engine/sensors/gnss_tracking.h"
#include "engine/sensors/satellite_receiver.h"

namespace vinerow {
namespace {

struct Jamming {
  TimeWindow window;
  double drop_dB;
  double ramp_s;

  double loss_dB(Time now) const {
    if (!window.contains(now)) return 0.0;
    if (ramp_s <= 0.0) return drop_dB;
    const double edge_s = std::min((now - window.begin).s(), (window.end - now).s());
    return drop_dB * std::min(1.0, edge_s / ramp_s);
  }
};

std::vector<Jamming> read_jamming(const ParameterSet& parameters, const std::string& part) {
  std::vector<Jamming> all;
  for (const ParameterSet& entry : parameters.groups("jamming")) {
    const Jamming jamming{read_time_window(entry, part + ": jamming"), entry.number("drop_dB"),
                          entry.number("ramp_s")};
    const double length_s = (jamming.window.end - jamming.window.begin).s();
    if (2.0 * jamming.ramp_s > length_s) {
      throw ConfigError(
          fmt::format("{}: jamming: ramp_s = {} s, must be at most half of the "
                      "window from {} s to {} s",
                      part, jamming.ramp_s, entry.number("begin_s"), entry.number("end_s")));
    }
    all.push_back(jamming);
  }
  return all;
}

GnssSky read_sky(const ParameterSet& parameters, const SensorContext& context) {
  static const std::vector<std::string> kKnown = {"gps", "galileo"};
  std::vector<CircularOrbit> orbits;
  std::vector<std::string> seen;
  for (const std::string& name : parameters.texts("constellations")) {
    if (std::find(kKnown.begin(), kKnown.end(), name) == kKnown.end()) {
      throw ConfigError(fmt::format("{}: constellations: unknown constellation '{}'{} (known: {})",
                                    context.part, name, did_you_mean(name, kKnown), join(kKnown)));
    }
    if (std::find(seen.begin(), seen.end(), name) != seen.end()) {
      throw ConfigError(fmt::format("{}: constellations: '{}' is given twice", context.part, name));
    }
    seen.push_back(name);
    const std::vector<CircularOrbit> more = name == "gps" ? gps_orbits() : galileo_orbits();
    orbits.insert(orbits.end(), more.begin(), more.end());
  }
  if (orbits.empty()) {
    throw ConfigError(fmt::format("{}: constellations is empty, must name one of: {}", context.part,
                                  join(kKnown)));
  }
  return GnssSky(context.world->origin, std::move(orbits),
                 read_utc(parameters.text("epoch_utc"), context.part + ": epoch_utc"));
}

class Gnss final : public SatelliteReceiver {
 public:
  Gnss(const ParameterSet& parameters, const SensorContext& context)
      : SatelliteReceiver(parameters, context),
        jamming_(read_jamming(parameters, context.part)),
        tracking_(read_gnss_signals(parameters, context.part), read_sky(parameters, context),
                  *context.scene, context.period.s(), is_running_at_start(parameters),
                  context.random("fading")),
        modes_(read_gnss_mode_rules(parameters, context.part), context.period.s(),
               is_running_at_start(parameters)),
        error_(read_gnss_errors(parameters), context.period.s(), context.random()) {}

  void step(Time now) override {
    const GnssFix exact = exact_fix();
    error_.draw();

    double jamming_dB = 0.0;
    for (const Jamming& jamming : jamming_) jamming_dB = std::max(jamming_dB, jamming.loss_dB(now));
    const GnssView view =
        tracking_.look(now.s(), exact.p_W, readings_.is_in_outage(now), jamming_dB);
    Dilution by_code, by_carrier;
    const double none = std::numeric_limits<double>::infinity();
    const double code_pdop = view.code.read(by_code) ? by_code.position() : none;
    const double carrier_pdop = view.carrier.read(by_carrier) ? by_carrier.position() : none;

    GnssFix fix;
    fix.mode = modes_.step(code_pdop, view.carrier.count(), carrier_pdop);
    const bool is_rtk = fix.mode >= GnssFix::Mode::kFloat;
    fix.satellites = is_rtk ? view.carrier.count() : view.code.count();
    fix.valid = fix.mode != GnssFix::Mode::kNone;
    if (fix.valid) {
      fix.p_W = exact.p_W;
      fix.v_W = exact.v_W;
      error_.apply(is_rtk ? by_carrier : by_code, fix);
      locate(fix);
    }
    readings_.push(now, fix, exact);
  }

 private:
  std::vector<Jamming> jamming_;
  GnssTracking tracking_;
  GnssModes modes_;
  GnssError error_;
};

}  // namespace

PartSpec gnss_spec() {
  const std::vector<ParameterSpec> jamming = join_parameters(
      {time_window_fields("the jamming"),
       {required(number_parameter("drop_dB", "dB", 20.0, 0.0, 200.0,
                                  "loss of carrier-to-noise density at its strongest")),
        number_parameter("ramp_s", "s", 0.0, 0.0, 1e6, "how long it takes to rise, and to fall")}});
  return mounted_sensor_spec<GnssFix>(
      "gnss",
      "Satellite receiver, standalone to RTK, whose fix and error follow from the satellites it "
      "sees past ground, posts and leaves",
      5.0,
      join_parameters(
          {{text_list_parameter("constellations", {"gps", "galileo"},
                                "satellites it receives: gps, galileo"),
            text_parameter("epoch_utc", "2024-06-15T10:00:00",
                           "date and time at the start of the run, which say where satellites "
                           "stand")},
           gnss_mode_parameters(),
           gnss_signal_parameters(),
           gnss_error_parameters(),
           {group_list_parameter("jamming", jamming, "time windows of disturbed reception")}}));
}

std::unique_ptr<Sensor> make_gnss(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Gnss>(parameters, context);
}

}  // namespace vinerow
