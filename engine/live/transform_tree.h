#pragma once
/// Transforms of all vehicles as ROS listeners expect them (REP 105):
/// map -> <vehicle>/odom -> <vehicle>/base_link -> <vehicle>/<link>.
///
/// `odom` -> `base_link` is the vehicle's dead reckoning, the first of its sensors that writes
/// DeadReckoning. Without one `odom` lies where `map` does, and does not drift. `map` -> `odom`
/// corrects the drift, so that the body is where `Localisation` says. While there is no reading, as
/// of a parked vehicle, the last one counts.

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/api/messages/motion.h"
#include "engine/api/signal.h"
#include "engine/record/cdr.h"
#include "engine/record/write_context.h"

namespace vinerow::live {

enum class Localisation {
  kTruth,     ///< the true pose
  kEstimate,  ///< the vehicle's estimator
  kNone       ///< a node outside publishes map -> odom
};

class TransformTree {
 public:
  /// @param bus  of a run whose signals all exist; outlives this object
  TransformTree(const SignalBus& bus, Localisation localisation);

  /// Collects the transforms that are new since the last call. Call at every instant, also without
  /// listeners: it remembers poses until readings arrive. @returns whether there are any
  bool update(Time now);
  /// Writes them as a tf2_msgs/msg/TFMessage.
  void write(record::CdrWriter& out) const;

 private:
  template <class T>
  struct Watched {
    const Signal<T>* signal = nullptr;  ///< null: the vehicle has no such signal
    std::uint64_t seen = 0;

    /// Whether there is a value that an earlier call has not seen.
    bool is_new();
  };
  struct Vehicle {
    record::FrameNames frames;
    std::string odom;                             ///< "rover/odom"
    const Signal<Odometry>* localised = nullptr;  ///< null: map -> odom comes from outside
    const Signal<Odometry>* truth = nullptr;
    Watched<Odometry> body;  ///< what places the body if there is no dead reckoning
    Watched<LinkPoses> links;
    Watched<DeadReckoning> reckoning;
    Watched<DeadReckoning> reckoning_truth;  ///< written when it measures, before any delay
    std::optional<Time> heard;               ///< when the last reading arrived
    /// Poses by localisation at the instants of measurements that have not arrived.
    std::deque<std::pair<Time, Pose>> measured;
  };
  struct Transform {
    Time stamp;
    const std::string* parent;
    std::string child;
    Pose X_PC;
  };

  void add_vehicle(const SignalBus& bus, const Signal<LinkPoses>& links, Localisation localisation);
  void add_body(Vehicle& vehicle);
  void add_reckoned(Vehicle& vehicle, Time now);
  void add_held(const Vehicle& vehicle, Time now);
  void add_links(const Vehicle& vehicle);

  const std::string map_;
  std::vector<Vehicle> vehicles_;
  std::vector<Transform> transforms_;  ///< new ones
};

}  // namespace vinerow::live
