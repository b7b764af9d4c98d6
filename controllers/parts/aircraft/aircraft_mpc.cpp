#include "controllers/parts/aircraft/aircraft_mpc.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "controllers/parts/solvers/tube_watch.h"
#include "engine/api/messages/event.h"

namespace vinerow::controllers {
namespace {

/// Values of each axis, "lon" first. gust: the strongest feasible one, 0 without a tube; iterations
/// and active: of the QP, 0 if it was not needed; violation: of soft limits, as a share of them;
/// tube: share of the tube that x - z_0 uses; nominal: largest share of its tightened limits that
/// z_0 uses; input: largest share of its limits that u uses; status: of the QP.
constexpr std::array kTubeValues = {"gust_mps",   "qp_iterations", "active_rows", "soft_violation",
                                    "tube_share", "nominal_share", "input_share", "qp_status"};

double largest_share(const Eigen::VectorXd& values, const Eigen::VectorXd& limits) {
  return values.cwiseAbs().cwiseQuotient(limits).maxCoeff();
}

class AircraftMpc final : public Controller {
 public:
  AircraftMpc(const ControllerContext& context, const std::string& type,
              const AircraftTubeParams& params)
      : part_(context.part),
        ports_(context, type, params.limits),
        tube_(ports_.aircraft(), ports_.trims().cruise().level(), context.period.s(), params,
              fmt::format("{} ({})", context.part, type)) {
    for (const char* axis : {"lon", "lat"}) {
      for (const char* value : kTubeValues) {
        values_.names.push_back(fmt::format("{}_{}", axis, value));
      }
    }
    values_.values.assign(values_.names.size(), 0.0);
    if (params.gust_mps > 0.0) {
      promise_ = fmt::format(
          "recursively feasible for gusts up to {:.2f} m/s (longitudinal), {:.2f} m/s (lateral)",
          tube_.lon().largest_gust_mps, tube_.lat().largest_gust_mps);
    }
  }

  void connect(Ports& ports) override {
    ports_.connect(ports);
    tube_out_ = ports.write<NamedValues>("tube");
    event_ = ports.write<Event>("controller_event");
  }

  void step(Time now) override {
    const bool has_reported = !promise_.empty();
    if (has_reported) {
      report_event(now, Event::Level::kInfo, promise_);
      promise_.clear();
    }
    if (!ports_.is_flying()) {
      ports_.write_off(now);
      tube_.reset();
      return;
    }
    ports_.take_over();
    if (ports_.is_launching()) {
      ports_.write_launch(now);
      tube_.reset();
      return;
    }
    ports_.write(now, tube_.step(ports_.deviation()));
    if (!has_reported) report(now);
    write(now);
  }

  bool finished() const override { return ports_.has_ended(); }

 private:
  /// At most one event per tick; a pending one is reported in the next tick.
  void report(Time now) {
    const bool fails =
        tube_.lon_status() != QpStatus::kSolved || tube_.lat_status() != QpStatus::kSolved;
    if (fails != has_failed_) {
      has_failed_ = fails;
      if (fails) {
        report_event(
            now, Event::Level::kError,
            fmt::format("no optimal inputs (QP: longitudinal {}, lateral {}): the feedback K x "
                        "takes over",
                        to_string(tube_.lon_status()), to_string(tube_.lat_status())));
      } else {
        report_event(now, Event::Level::kInfo, "optimal inputs again");
      }
      return;
    }
    if (!report(now, tube_.lon(), "longitudinal", lon_watch_)) {
      report(now, tube_.lat(), "lateral", lat_watch_);
    }
  }

  /// Without gusts there is no tube.
  static const char* name_bounds(const AxisTube& axis) {
    return axis.model.gust.isZero(0.0) ? "limits" : "tube";
  }

  /// @returns whether it has reported an event
  bool report(Time now, const AxisTube& axis, const char* name, TubeWatch& watch) {
    switch (watch.update(axis.mpc.soft_violation(), now.s())) {
      case TubeWatch::PendingEvent::kNone:
        return false;
      case TubeWatch::PendingEvent::kLeft:
        report_event(now, Event::Level::kWarning,
                     fmt::format("{} axis outside its {} by {}; soft constraints take over", name,
                                 name_bounds(axis), axis.describe_violation()));
        return true;
      case TubeWatch::PendingEvent::kBack:
        report_event(now, Event::Level::kInfo,
                     fmt::format("{} axis back inside its {} after {:.2f} s", name,
                                 name_bounds(axis), watch.outside_s()));
        return true;
    }
    return false;
  }

  void report_event(Time now, Event::Level level, const std::string& text) {
    event_.write(now, {level, part_, text});
  }

  void write(Time now) {
    auto at = values_.values.begin();
    const auto add = [&at](const AxisTube& axis, QpStatus status) {
      const TubeMpc& mpc = axis.mpc;
      const double gust = std::isfinite(axis.largest_gust_mps) ? axis.largest_gust_mps : 0.0;
      for (const double value :
           {gust, static_cast<double>(mpc.iterations()), static_cast<double>(mpc.active_rows()),
            mpc.soft_violation(), mpc.tube_share(), largest_share(mpc.z0(), axis.sets.state_limit),
            largest_share(mpc.u(), axis.model.input_limit), static_cast<double>(status)}) {
        *at++ = value;
      }
    };
    add(tube_.lon(), tube_.lon_status());
    add(tube_.lat(), tube_.lat_status());
    tube_out_.write(now, values_);
  }

  std::string part_, promise_;
  AircraftPorts ports_;
  AircraftTube tube_;
  TubeWatch lon_watch_, lat_watch_;
  bool has_failed_ = false;
  NamedValues values_;
  SignalWriter<NamedValues> tube_out_;
  SignalWriter<Event> event_;
};

}  // namespace

std::unique_ptr<Controller> make_aircraft_mpc(const ControllerContext& context,
                                              const std::string& type,
                                              const AircraftTubeParams& params) {
  return std::make_unique<AircraftMpc>(context, type, params);
}

void describe_aircraft_mpc_signals(PartSpec& spec) {
  spec.default_rate_Hz = 20.0;
  spec.reads = {"estimate", "reference"};
  spec.writes = {"actuators", "deviation", "follower", "tube", "controller_event"};
}

}  // namespace vinerow::controllers
