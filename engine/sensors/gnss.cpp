#include "engine/sensors/gnss.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "engine/sensors/gnss_error.h"
#include "engine/sensors/gnss_mode.h"
#include "engine/sensors/gnss_tracking.h"
#include "engine/sensors/satellite_receiver.h"

namespace vinerow::sensors {
namespace {

struct JammingParams {
  TimeWindowParams window;
  double drop_dB = 0.0;
  double ramp_s = 0.0;
};

std::string find_fault_in_ramp(const JammingParams& p) {
  const TimeWindow window = p.window.window();
  const double length_s = (window.end - window.begin).s();
  if (2.0 * p.ramp_s <= length_s) return "";
  return fmt::format("ramp_s = {} s, must be at most half of the window from {} s to {} s",
                     p.ramp_s, p.window.begin_s, p.window.end_s);
}

const ParameterTable<JammingParams>& jamming_table() {
  using P = JammingParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .include(&P::window, time_window_table())
          .reword("begin_s", "start of the jamming")
          .reword("end_s", "end of the jamming")
          .number("drop_dB", "dB", &P::drop_dB, between(0.0, 200.0),
                  "maximum loss of carrier-to-noise density")
          .required()
          .number("ramp_s", "s", &P::ramp_s, between(0.0, 1e6), "rise time, and fall time")
          .rule(find_fault_in_ramp);
  return table;
}

struct GnssParams {
  GnssSkyParams sky;
  GnssModeRules modes;
  GnssSignals signals;
  GnssErrorParams errors;
  std::vector<JammingParams> jamming;
};

const ParameterTable<GnssParams>& gnss_table() {
  using P = GnssParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .include(&P::sky, gnss_sky_table())
          .include(&P::modes, gnss_mode_table())
          .include(&P::signals, gnss_signal_table())
          .include(&P::errors, gnss_error_table())
          .groups("jamming", &P::jamming, jamming_table(), "time windows of disturbed reception");
  return table;
}

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

std::vector<Jamming> make_jamming(const std::vector<JammingParams>& params) {
  std::vector<Jamming> all;
  for (const JammingParams& p : params) all.push_back({p.window.window(), p.drop_dB, p.ramp_s});
  return all;
}

class Gnss final : public SatelliteReceiver {
 public:
  Gnss(const ParameterSet& parameters, const SensorContext& context)
      : Gnss(gnss_table().read(parameters, context.part), parameters, context) {}
  Gnss(const GnssParams& params, const ParameterSet& parameters, const SensorContext& context)
      : SatelliteReceiver(parameters, context),
        jamming_(make_jamming(params.jamming)),
        tracking_(params.signals, make_gnss_sky(params.sky, context.world->origin, context.part),
                  *context.scene, LeafAreaDensity(*context.world), context.period.s(),
                  params.modes.is_running_at_start, context.random("fading")),
        modes_(params.modes, context.period.s()),
        error_(params.errors.resolve(), context.period.s(), context.random()) {}

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
  return mounted_sensor_spec<GnssFix>(
      "gnss",
      "Satellite receiver, standalone to RTK, whose fix and error depend on the satellites visible "
      "past ground, posts and leaves",
      5.0, gnss_table());
}

std::unique_ptr<Sensor> make_gnss(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Gnss>(parameters, context);
}

}  // namespace vinerow::sensors
