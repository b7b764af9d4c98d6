#include "controllers/autopilot/ardupilot/ardupilot.h"

#include "controllers/autopilot/ardupilot/ardupilot_dialect.h"
#include "controllers/autopilot/ardupilot/json_lockstep.h"
#include "controllers/autopilot/ardupilot/start_command.h"
#include "controllers/autopilot/firmware/firmware_autopilot.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {

FirmwareLinkOptions ardupilot_link_options(const FirmwareParams& params) {
  FirmwareLinkOptions options = firmware_link_options(params);
  options.gps_input = params.gnss;
  options.receiver =
      params.gnss.empty() ? FirmwareFrame::Receiver::kOfFirmware : FirmwareFrame::Receiver::kOurs;
  return options;
}

PartSpec ardupilot_spec() {
  PartSpec spec =
      firmware_spec("ardupilot",
                    "An unmodified ArduPilot (Rover, Copter, Plane) in lock-step by its JSON "
                    "interface: it gets a state for each step and drives the actuators.");
  ardupilot_table().add_to(spec);
  return spec;
}

std::unique_ptr<Autopilot> make_ardupilot(const ParameterSet& parameters,
                                          const AutopilotContext& context) {
  const std::string who = context.part + " (ardupilot)";
  const FirmwareParams params = ardupilot_table().read(parameters, who);
  RunningLockstepOptions options = running_options(params, Protocol::kUdp, lockstep_port_of(params),
                                                   mavlink_port_of(params), context, who);
  options.command = start_command(params, context);
  options.files = {{kParameterFile, parameter_text(start_parameters(params, context))}};
  std::optional<FirmwareLinkOptions> link;
  if (params.uses_mavlink) link = ardupilot_link_options(params);
  auto dialect = std::make_unique<ArdupilotDialect>(params, context, who);
  return std::make_unique<FirmwareAutopilot>(
      params.finish_at_s, std::move(link), std::make_unique<JsonLockstep>(std::move(options), who),
      std::move(dialect), context, "ardupilot");
}

}  // namespace vinerow::controllers
