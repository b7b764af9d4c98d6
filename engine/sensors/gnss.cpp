#include "engine/sensors/gnss.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/core/error.h"
#include "engine/core/suggest.h"
#include "engine/io/geo.h"
#include "engine/sensors/gnss_error.h"
#include "engine/sensors/gnss_mode.h"
#include "engine/sensors/gnss_tracking.h"
#include "engine/sensors/mounting.h"
#include "engine/sensors/readings.h"

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

class Gnss final : public Sensor {
 public:
  Gnss(const ParameterSet& parameters, const SensorContext& context)
      : frame_(context.world->origin),
        X_BS_(mounting_pose(parameters)),
        readings_(parameters, context),
        jamming_(read_jamming(parameters, context.part)),
        tracking_(read_gnss_signals(parameters, context.part), read_sky(parameters, context),
                  *context.scene, context.period.s(), is_running_at_start(parameters),
                  context.random("fading")),
        modes_(read_gnss_mode_rules(parameters, context.part), context.period.s(),
               is_running_at_start(parameters)),
        error_(read_gnss_errors(parameters), context.period.s(), context.random()) {}

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    readings_.connect(ports);
  }
  Duration delay() const override { return readings_.delay(); }
  std::optional<Pose> mounting_X_BS() const override { return X_BS_; }
  void deliver(Time) override { readings_.deliver(); }

  void step(Time now) override {
    const Odometry& truth = truth_.value();
    GnssFix exact;
    exact.valid = true;
    exact.p_W = truth.X_WB * X_BS_.p;
    exact.v_W = truth.X_WB.q * (truth.v_WB_B + truth.w_WB_B.cross(X_BS_.p));
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
    locate(exact);
    readings_.push(now, fix, exact);
  }

 private:
  void locate(GnssFix& fix) const {
    const io::Geodetic g = frame_.to_geodetic(fix.p_W);
    fix.latitude_rad = g.latitude_rad;
    fix.longitude_rad = g.longitude_rad;
    fix.altitude_m = g.altitude_m;
  }

  io::LocalFrame frame_;
  Pose X_BS_;
  Readings<GnssFix> readings_;
  std::vector<Jamming> jamming_;
  GnssTracking tracking_;
  GnssModes modes_;
  GnssError error_;
  SignalReader<Odometry> truth_;
};

}  // namespace

PartSpec gnss_spec() {
  PartSpec spec;
  spec.name = "gnss";
  spec.description =
      "Satellite receiver, standalone to RTK, whose fix and error follow from the satellites it "
      "sees past ground, posts and leaves";
  spec.default_rate_Hz = 5.0;
  spec.parameters = mounting_parameters({0.0, 0.0, 0.0});
  const auto add = [&](std::vector<ParameterSpec> more) {
    for (ParameterSpec& parameter : more) spec.parameters.push_back(std::move(parameter));
  };
  add({text_list_parameter("constellations", {"gps", "galileo"},
                           "satellites it receives: gps, galileo"),
       text_parameter("epoch_utc", "2024-06-15T10:00:00",
                      "date and time at the start of the run, which say where satellites stand")});
  add(gnss_mode_parameters());
  add(gnss_signal_parameters());
  add(gnss_error_parameters());
  std::vector<ParameterSpec> jamming = time_window_fields("the jamming");
  jamming.push_back(required(number_parameter(
      "drop_dB", "dB", 20.0, 0.0, 200.0, "loss of carrier-to-noise density at its strongest")));
  jamming.push_back(
      number_parameter("ramp_s", "s", 0.0, 0.0, 1e6, "how long it takes to rise, and to fall"));
  add({group_list_parameter("jamming", std::move(jamming), "time windows of disturbed reception")});
  add_reading_parameters(spec.parameters);
  spec.reads = {"truth"};
  spec.writes = {"<name>: GnssFix", "<name>_truth: GnssFix"};
  return spec;
}

std::unique_ptr<Sensor> make_gnss(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Gnss>(parameters, context);
}

}  // namespace vinerow
