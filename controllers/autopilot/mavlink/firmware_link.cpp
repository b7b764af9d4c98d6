#include "controllers/autopilot/mavlink/firmware_link.h"

#include <utility>

#include "controllers/autopilot/frames/body_state.h"
#include "controllers/autopilot/mavlink/gps_input.h"
#include "engine/io/missions/mission_items.h"
#include "engine/io/missions/plan_mission.h"
#include "engine/mavlink/enums.h"

namespace vinerow::controllers {
namespace {

constexpr Time kNever{-1};

Event::Level level_of(std::uint8_t severity) {
  if (severity <= mavlink::kSeverityError) return Event::Level::kError;
  return severity == mavlink::kSeverityWarning ? Event::Level::kWarning : Event::Level::kInfo;
}

GroundStationOptions station_options(const FirmwareLinkOptions& options,
                                     const VehicleDescription& vehicle) {
  GroundStationOptions station = options.station;
  station.expects_mission = options.mission.has_value();
  station.vehicle_type = vehicle.rotorcraft   ? mavlink::kTypeQuadrotor
                         : vehicle.fixed_wing ? mavlink::kTypeFixedWing
                                              : mavlink::kTypeGroundRover;
  return station;
}

Odometry odometry_of(const FirmwareEstimate& estimate, const FirmwareFrame& frame) {
  const auto& [time, position, attitude, origin] = estimate;
  Odometry odometry;
  odometry.X_WB.p = frame.local_to_W({origin.latitude, origin.longitude}, 1e-3 * origin.altitude,
                                     {position.x, position.y, position.z});
  odometry.X_WB.q = q_WB_from_ned(attitude.roll, attitude.pitch, attitude.yaw);
  odometry.v_WB_B =
      odometry.X_WB.q.conjugate() * swap_ned_and_W({position.vx, position.vy, position.vz});
  odometry.w_WB_B = swap_frd_and_B({attitude.rollspeed, attitude.pitchspeed, attitude.yawspeed});
  return odometry;
}

}  // namespace

FirmwareLink::FirmwareLink(FirmwareLinkOptions options, const GeoOrigin& origin,
                           const VehicleDescription& vehicle, std::string part, Send send)
    : options_(std::move(options)),
      vehicle_(vehicle),
      part_(std::move(part)),
      send_(std::move(send)),
      frame_(origin, options_.receiver),
      station_(station_options(options_, vehicle), send_),
      last_estimate_(kNever) {
  if (options_.mission) begin_mission(*options_.mission);
}

void FirmwareLink::connect(Ports& ports) {
  if (!has_mission_) plan_ = ports.read_optional<PlannedPath>("plan");
  if (!options_.gps_input.empty()) gnss_ = ports.read<GnssFix>(options_.gps_input);
  estimate_ = ports.write<Odometry>("estimate");
  follower_writer_ = ports.write<FollowerState>("follower");
}

void FirmwareLink::begin_mission(const io::MissionFile& mission) {
  has_mission_ = true;
  std::optional<Geodetic> home;
  if (options_.has_home_item) {
    home = mission.planned_home.value_or(frame_.wgs84().to_geodetic(Eigen::Vector3d::Zero()));
  }
  station_.fly(io::make_mission_items(
      mission, home, [this](const Geodetic& point) { return frame_.place_of(point); }));
}

void FirmwareLink::take(Time now, std::span<const std::uint8_t> bytes) {
  has_heard_ = true;
  reader_.read(bytes, [&](const mavlink::Frame& frame) { station_.take(now, frame); });
  write_estimate(now);
  if (station_.finished() && !follower_.finished) write_follower(now);
}

void FirmwareLink::write_estimate(Time now) {
  const auto& estimate = station_.estimate();
  if (!estimate || estimate->time == last_estimate_) return;
  last_estimate_ = estimate->time;
  estimate_.write(now, odometry_of(*estimate, frame_));
  write_follower(now);
}

void FirmwareLink::write_follower(Time now) {
  follower_.waypoint = station_.current_item();
  follower_.finished = station_.finished();
  if (const auto& navigation = station_.navigation()) {
    follower_.lateral_error_m = navigation->xtrack_error;
    follower_.remaining_m = navigation->wp_dist;
  }
  follower_writer_.write(now, follower_);
}

void FirmwareLink::step(Time now) {
  if (!has_mission_ && plan_.has_value()) {
    begin_mission(
        io::make_plan_mission(plan_.value(), vehicle_, frame_.wgs84(), options_.tolerance_m));
  }
  if (!begin_) begin_ = now;
  if (!has_complained_ && !station_.estimate() &&
      (now - *begin_).s() > options_.station.ready_timeout_s) {
    has_complained_ = true;
    events_.push_back({Event::Level::kWarning, part_,
                       has_heard_ ? "the firmware has no estimate of its position yet"
                                  : "the firmware has sent no MAVLink yet"});
  }
  if (!has_heard_) return;
  if (gnss_.connected() && gnss_.is_newer_than(last_fix_)) {
    send_(receiver_.write(make_gps_input(gnss_.value(), gnss_.stamp())));
  }
  station_.step(now);
}

std::vector<Event> FirmwareLink::take_events() {
  std::vector<Event> events = std::exchange(events_, {});
  for (const SpokenText& text : station_.take_texts()) {
    events.push_back({level_of(text.severity), part_, text.text});
  }
  return events;
}

}  // namespace vinerow::controllers
