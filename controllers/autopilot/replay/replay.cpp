#include "controllers/autopilot/replay/replay.h"

#include <utility>

#include "controllers/autopilot/ardupilot/ardupilot.h"
#include "controllers/autopilot/ardupilot/ardupilot_dialect.h"
#include "controllers/autopilot/firmware/firmware_autopilot.h"
#include "controllers/autopilot/firmware/recorded_lockstep.h"
#include "controllers/autopilot/px4/px4.h"
#include "controllers/autopilot/px4/px4_dialect.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

/// PX4's outputs are frames of MAVLink 2, whose first byte is their mark.
bool is_of_px4(Bytes outputs) {
  constexpr std::uint8_t kMavlink2 = 0xFD;
  return !outputs.empty() && outputs.front() == kMavlink2;
}

}  // namespace

PartSpec autopilot_replay_spec() {
  PartSpec spec =
      firmware_spec("replay",
                    "The recording of an autopilot in its place: the same outputs without it, "
                    "as long as the state is the recorded one.");
  autopilot_replay_table().add_to(spec);
  return spec;
}

std::unique_ptr<Autopilot> make_autopilot_replay(const ParameterSet& parameters,
                                                 const AutopilotContext& context) {
  const std::string who = context.part + " (replay)";
  const auto [params, file] = autopilot_replay_table().read(parameters, who);
  auto recording = std::make_unique<RecordedLockstep>(file, who);
  const bool is_px4 = is_of_px4(recording->first_outputs());
  std::optional<FirmwareLinkOptions> link;
  if (params.uses_mavlink) {
    link = is_px4 ? px4_link_options(params) : ardupilot_link_options(params);
  }
  std::unique_ptr<Dialect> dialect;
  if (is_px4) {
    dialect = std::make_unique<Px4Dialect>(params, context, who);
  } else {
    dialect = std::make_unique<ArdupilotDialect>(params, context, who);
  }
  return std::make_unique<FirmwareAutopilot>(params.finish_at_s, std::move(link),
                                             std::move(recording), std::move(dialect), context,
                                             "replay");
}

}  // namespace vinerow::controllers
