#include "controllers/autopilot/px4/px4.h"

#include <fmt/format.h>

#include <utility>

#include "controllers/autopilot/firmware/firmware_autopilot.h"
#include "controllers/autopilot/px4/hil_lockstep.h"
#include "controllers/autopilot/px4/px4_dialect.h"
#include "controllers/autopilot/px4/px4_start.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"

namespace vinerow::controllers {
namespace {

/// Rates of its inertial sensors that PX4 knows (IMU_INTEG_RATE).
void check_rate(const AutopilotContext& context, const std::string& who) {
  constexpr double kLeast_Hz = 100.0, kMost_Hz = 400.0;
  const double rate_Hz = 1.0 / context.period.s();
  if (rate_Hz >= kLeast_Hz && rate_Hz <= kMost_Hz) return;
  throw ConfigError(
      fmt::format("{}: it is called at {:g} Hz; PX4 takes its sensors at {:g} to {:g} Hz: set "
                  "rate_Hz, for example to 250",
                  who, rate_Hz, kLeast_Hz, kMost_Hz));
}

}  // namespace

FirmwareLinkOptions px4_link_options(const FirmwareParams& params) {
  FirmwareLinkOptions options = firmware_link_options(params);
  options.receiver = FirmwareFrame::Receiver::kOursInPx4;
  options.has_home_item = false;
  return options;
}

PartSpec px4_spec() {
  PartSpec spec =
      firmware_spec("px4",
                    "An unmodified PX4 in lock-step by its interface to simulators (MAVLink HIL "
                    "over TCP): it gets readings of the vehicle's sensors and drives the "
                    "actuators.");
  px4_table().add_to(spec);
  return spec;
}

std::unique_ptr<Autopilot> make_px4(const ParameterSet& parameters,
                                    const AutopilotContext& context) {
  const std::string who = context.part + " (px4)";
  const FirmwareParams params = px4_table().read(parameters, who);
  check_rate(context, who);
  auto dialect = std::make_unique<Px4Dialect>(params, context, who);
  RunningLockstepOptions options = running_options(params, Protocol::kTcp, px4_port_of(params),
                                                   px4_mavlink_port_of(params), context, who);
  options.command = px4_command(params);
  if (!options.command.empty()) {
    options.environment = px4_environment(params, context);
    options.files = {{kPx4ParameterScript, px4_parameter_script(params, context)}};
  }
  std::optional<FirmwareLinkOptions> link;
  if (params.uses_mavlink) link = px4_link_options(params);
  return std::make_unique<FirmwareAutopilot>(params.finish_at_s, std::move(link),
                                             std::make_unique<HilLockstep>(std::move(options), who),
                                             std::move(dialect), context, "px4");
}

}  // namespace vinerow::controllers
