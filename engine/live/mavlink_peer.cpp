#include "engine/live/mavlink_peer.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <vector>

#include "engine/api/messages/event.h"
#include "engine/api/messages/flight.h"
#include "engine/api/messages/path.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/outside.h"
#include "engine/core/error.h"
#include "engine/io/missions/mav_command.h"
#include "engine/io/missions/mission_items.h"
#include "engine/io/missions/plan_mission.h"
#include "engine/live/mavlink_vehicle.h"
#include "engine/math/angles.h"
#include "engine/math/geo.h"
#include "engine/mavlink/enums.h"
#include "engine/mavlink/udp_socket.h"
#include "engine/sim/simulation.h"
#include "engine/sim/vehicle_runtime.h"

namespace vinerow::live {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kLook{50};
constexpr milliseconds kHeartbeat{1000};
/// A plan is shown with legs this near to it.
constexpr double kTolerance_m = 0.1;
/// A goal is reached within this distance, unless its item says otherwise (param2).
constexpr double kReach_m = 1.0;

template <class T>
const Signal<T>* find_signal(const SignalBus& bus, const std::string& name) {
  return dynamic_cast<const Signal<T>*>(bus.find(name));
}

std::uint8_t type_of(const VehicleDescription& vehicle) {
  if (vehicle.rotorcraft) return mavlink::kTypeQuadrotor;
  return vehicle.fixed_wing ? mavlink::kTypeFixedWing : mavlink::kTypeGroundRover;
}

Eigen::Vector3d ned(const Eigen::Vector3d& v_W) {
  return {v_W.y(), v_W.x(), -v_W.z()};
}

/// Roll, pitch and yaw of forward-right-down in north-east-down.
Eigen::Vector3d angles_of(const Eigen::Quaterniond& q_WB) {
  const Eigen::Matrix3d R = q_WB.toRotationMatrix();
  // x of B in W, and its z: nose and belly.
  const Eigen::Vector3d nose = ned(R.col(0)), right = ned(-R.col(1)), down = ned(-R.col(2));
  return {std::atan2(right.z(), down.z()), std::asin(std::clamp(-nose.z(), -1.0, 1.0)),
          std::atan2(nose.y(), nose.x())};
}

/// One vehicle and the goals that a ground station gave it.
class PeerVehicle final : public MavlinkCommands {
 public:
  PeerVehicle(LiveRun& run, const Simulation& simulation, const VehicleRuntime& vehicle, int number,
              MavlinkVehicle::Send send)
      : run_(run),
        runtime_(vehicle),
        bus_(simulation.bus()),
        frame_(simulation.world().origin),
        name_(vehicle.name()),
        mavlink_(options_of(simulation, vehicle, number), *this, std::move(send)) {
    const std::string goal = name_ + "/goal_pose";
    const auto& outside = simulation.outside_signals();
    takes_goals_ = std::find(outside.begin(), outside.end(), goal) != outside.end();
    // The vehicle's own receiver is the first one of its sensors.
    for (const auto& signal : bus_.signals()) {
      if (!signal->name().starts_with(name_ + "/") || signal->name().ends_with("_truth")) continue;
      if (!gnss_) gnss_ = dynamic_cast<const Signal<GnssFix>*>(signal.get());
    }
  }

  const std::string& name() const { return name_; }
  MavlinkVehicle& mavlink() { return mavlink_; }

  /// Telemetry of an instant, and the goals. In the run's thread.
  void report(Time now) {
    const auto* estimate = find_signal<Odometry>(bus_, name_ + "/estimate");
    const bool is_known = estimate != nullptr && estimate->sequence() > 0;
    const Odometry& state = is_known ? estimate->value() : runtime_.truth();
    if (!home_) home_ = state.X_WB.p;
    MavlinkState report;
    report.time = now;
    const Geodetic place = frame_.to_geodetic(state.X_WB.p);
    report.latitude_rad = place.latitude_rad;
    report.longitude_rad = place.longitude_rad;
    report.altitude_m = place.altitude_m;
    report.height_above_home_m = state.X_WB.p.z() - home_->z();
    report.position_NED_m = ned(state.X_WB.p);
    report.velocity_NED_mps = ned(state.X_WB.q * state.v_WB_B);
    report.roll_pitch_yaw_rad = angles_of(state.X_WB.q);
    report.rates_FRD_radps = {state.w_WB_B.x(), -state.w_WB_B.y(), -state.w_WB_B.z()};
    report.airspeed_mps = state.v_WB_B.norm();
    if (const auto* battery = find_signal<BatteryState>(bus_, name_ + "/battery");
        battery != nullptr && battery->sequence() > 0) {
      report.power_W = battery->value().power_W;
      report.charge = battery->value().charge;
    }
    report.is_at_work = !runtime_.finished() && !runtime_.crash();
    report.has_crashed = runtime_.crash().has_value();
    mavlink_.report(report);
    report_fix();
    show_plan();
    pursue(now, state.X_WB.p);
  }

  std::string take_mission(const std::vector<mavlink::MissionItemInt>& items) override {
    if (!takes_goals_) {
      return fmt::format(
          "{} follows its scenario: it takes missions only with the guidance remote_goal", name_);
    }
    std::vector<Goal> goals;
    for (const mavlink::MissionItemInt& item : items) {
      if (item.command != io::kNavWaypoint) {
        return fmt::format("item {}: {} drives to waypoints, not {}", item.seq, name_,
                           io::describe_mav_command(item.command));
      }
      Geodetic place;
      place.latitude_rad = rad_from_deg(1e-7 * item.x);
      place.longitude_rad = rad_from_deg(1e-7 * item.y);
      place.altitude_m = frame_.origin().altitude_m;
      Goal goal;
      goal.p_W = frame_.to_local(place);
      goal.reach_m = item.param2 > 0.0F ? static_cast<double>(item.param2) : kReach_m;
      goals.push_back(goal);
    }
    goals_ = std::move(goals);
    next_.reset();
    return "";
  }

  std::string start_mission() override {
    run_.control().resume();
    if (!takes_goals_) return "";
    if (goals_.empty()) return fmt::format("{} has no mission: upload one first", name_);
    next_ = 0;
    return send_goal();
  }

  std::string pause(bool pauses) override {
    pauses ? run_.control().pause() : run_.control().resume();
    return "";
  }
  std::string set_speed(double speed) override { return run_.control().set_speed(speed); }
  double speed() const override { return run_.control().snapshot().speed; }

 private:
  struct Goal {
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
    double reach_m = kReach_m;
  };

  static MavlinkVehicleOptions options_of(const Simulation& simulation,
                                          const VehicleRuntime& vehicle, int number) {
    MavlinkVehicleOptions options;
    options.sender = {static_cast<std::uint8_t>(number), 1};
    options.type = type_of(vehicle.vehicle().description());
    options.name = vehicle.name();
    const Geodetic home = LocalFrame(simulation.world().origin).to_geodetic(vehicle.truth().X_WB.p);
    options.home_latitude_rad = home.latitude_rad;
    options.home_longitude_rad = home.longitude_rad;
    options.home_altitude_m = home.altitude_m;
    return options;
  }

  void report_fix() {
    if (gnss_ == nullptr || gnss_->sequence() == seen_fix_) return;
    seen_fix_ = gnss_->sequence();
    const GnssFix& fix = gnss_->value();
    MavlinkFix report;
    report.time = gnss_->stamp();
    report.type = mavlink::fix_type(fix.valid, static_cast<int>(fix.mode));
    report.latitude_rad = fix.latitude_rad;
    report.longitude_rad = fix.longitude_rad;
    report.altitude_m = fix.altitude_m;
    report.velocity_NED_mps = ned(fix.v_W);
    report.std_NED_m = {fix.std_m.y(), fix.std_m.x(), fix.std_m.z()};
    report.satellites = fix.satellites;
    mavlink_.report(report);
  }

  /// The plan can be downloaded, as a mission would be.
  void show_plan() {
    const auto* plan = find_signal<PlannedPath>(bus_, name_ + "/plan");
    if (plan == nullptr || plan->sequence() == seen_plan_ || takes_goals_) return;
    seen_plan_ = plan->sequence();
    const io::MissionFile mission = io::make_plan_mission(
        plan->value(), runtime_.vehicle().description(), frame_, kTolerance_m);
    mavlink_.set_mission(io::make_mission_items(mission, std::nullopt));
  }

  /// Gives the next goal when the present one is reached.
  void pursue(Time /*now*/, const Eigen::Vector3d& p_W) {
    if (!next_) return;
    const Goal& goal = goals_[*next_];
    if ((goal.p_W - p_W).head<2>().norm() > goal.reach_m) return;
    mavlink_.reached(static_cast<int>(*next_));
    if (++*next_ == goals_.size()) {
      next_.reset();
      return;
    }
    if (const std::string refusal = send_goal(); !refusal.empty()) {
      mavlink_.say(mavlink::kSeverityWarning, refusal);
      next_.reset();
    }
  }

  std::string send_goal() {
    PoseTarget target;
    const Goal& goal = goals_[*next_];
    target.X_WB.p = goal.p_W;
    // On arrival it looks to the next goal, or where it came from.
    const Eigen::Vector3d from = *next_ > 0 ? goals_[*next_ - 1].p_W : runtime_.truth().X_WB.p;
    const Eigen::Vector3d ahead =
        *next_ + 1 < goals_.size() ? goals_[*next_ + 1].p_W - goal.p_W : goal.p_W - from;
    target.X_WB.q = Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), Eigen::Vector3d::UnitZ());
    mavlink_.set_current(static_cast<int>(*next_));
    return run_.control().submit(
        {outside_command<PoseTarget>(name_ + "/goal_pose", Time{}, target), "ground station"});
  }

  LiveRun& run_;
  const VehicleRuntime& runtime_;
  const SignalBus& bus_;
  LocalFrame frame_;
  std::string name_;
  bool takes_goals_ = false;
  MavlinkVehicle mavlink_;
  const Signal<GnssFix>* gnss_ = nullptr;
  std::uint64_t seen_fix_ = 0, seen_plan_ = 0;
  std::optional<Eigen::Vector3d> home_;
  std::vector<Goal> goals_;
  std::optional<std::size_t> next_;
};

class Peer final : public MavlinkPeer, public RunListener, public RunObserver {
 public:
  Peer(LiveRun& run, const MavlinkOptions& options)
      : run_(run), host_(host_of(options)), socket_({is_here() ? host_ : 0, 0}, "--mavlink") {
    stations_.push_back({host_, static_cast<std::uint16_t>(options.port)});
    run_.add_listener(this);
    thread_ = std::thread([this] { work(); });
  }

  ~Peer() override {
    run_.remove_listener(this);
    ends_ = true;
    thread_.join();
  }

  void on_begin(Simulation& simulation) override {
    const std::lock_guard lock(mutex_);
    vehicles_.clear();
    for (const auto& vehicle : simulation.vehicles()) {
      const int number = static_cast<int>(vehicles_.size()) + 1;
      vehicles_.push_back(std::make_unique<PeerVehicle>(
          run_, simulation, *vehicle, number,
          [this](std::span<const std::uint8_t> frame) { send(frame); }));
    }
    next_report_ = Time{};
    simulation.add_observer(this);
  }

  void on_end() override {
    const std::lock_guard lock(mutex_);
    vehicles_.clear();  // they look at the simulation
  }

  void on_status(RunControl::Level level, const std::string& sentence) override {
    constexpr std::uint8_t kSeverity[] = {mavlink::kSeverityInfo, mavlink::kSeverityWarning,
                                          mavlink::kSeverityError};
    const std::lock_guard lock(mutex_);
    if (!vehicles_.empty()) {
      vehicles_.front()->mavlink().say(kSeverity[static_cast<int>(level)], sentence);
    }
  }

  void on_instant(Time now) override {
    constexpr Duration kPeriod{100'000'000};
    // As often in simulated time; a run faster than real time sends less.
    if (now < next_report_ || Clock::now() - last_report_.load() < milliseconds(20)) return;
    next_report_ = now + kPeriod;
    last_report_ = Clock::now();
    const std::lock_guard lock(mutex_);
    for (const auto& vehicle : vehicles_) vehicle->report(now);
  }

  void on_event(Time /*now*/, const Event& event) override {
    const std::lock_guard lock(mutex_);
    for (const auto& vehicle : vehicles_) {
      if (!event.source.starts_with(vehicle->name())) continue;
      const std::uint8_t severity = event.level == Event::Level::kError ? mavlink::kSeverityError
                                    : event.level == Event::Level::kWarning
                                        ? mavlink::kSeverityWarning
                                        : mavlink::kSeverityInfo;
      vehicle->mavlink().say(severity, event.text);
    }
  }

 private:
  static std::uint32_t host_of(const MavlinkOptions& options) {
    const auto host = mavlink::parse_ipv4(options.host);
    if (host) return *host;
    throw ConfigError(fmt::format(
        "--mavlink-host = '{}', must be an IPv4 address such as 127.0.0.1", options.host));
  }
  /// A ground station on this machine: no other one can reach our socket.
  bool is_here() const { return host_ >> 24 == 127; }

  void send(std::span<const std::uint8_t> frame) {
    for (const mavlink::UdpAddress& station : stations_) socket_.send(frame, station);
  }

  void work() {
    auto beat = Clock::now(), reminder = beat;
    while (!ends_) {
      const auto datagram = socket_.receive(kLook);
      const std::lock_guard lock(mutex_);
      if (datagram) {
        meet(datagram->from);
        reader_.read(datagram->bytes, [this](const mavlink::Frame& frame) {
          for (const auto& vehicle : vehicles_) vehicle->mavlink().take(frame);
        });
      }
      // A run that is paused or slow must not look lost.
      if (Clock::now() - std::max(beat, last_report_.load()) > kHeartbeat) {
        beat = Clock::now();
        for (const auto& vehicle : vehicles_) vehicle->mavlink().heartbeat();
      }
      if (Clock::now() - reminder > kHeartbeat) {
        reminder = Clock::now();
        for (const auto& vehicle : vehicles_) vehicle->mavlink().remind();
      }
    }
  }

  /// A ground station that sends to us gets the telemetry too.
  void meet(const mavlink::UdpAddress& station) {
    constexpr std::size_t kMostStations = 8;
    if (std::find(stations_.begin(), stations_.end(), station) != stations_.end()) return;
    if (stations_.size() < kMostStations) stations_.push_back(station);
  }

  LiveRun& run_;
  std::uint32_t host_;
  mavlink::UdpSocket socket_;
  mavlink::FrameReader reader_;
  std::recursive_mutex mutex_;  // sentences of the control come back as on_status()
  std::vector<mavlink::UdpAddress> stations_;
  std::vector<std::unique_ptr<PeerVehicle>> vehicles_;
  Time next_report_;
  std::atomic<Clock::time_point> last_report_{};
  std::atomic<bool> ends_ = false;
  std::thread thread_;
};

}  // namespace

std::unique_ptr<MavlinkPeer> make_mavlink_peer(LiveRun& run, const MavlinkOptions& options) {
  return std::make_unique<Peer>(run, options);
}

}  // namespace vinerow::live
