#pragma once
/// Contents of a log that pictures need, in memory: poses of vehicles and links, plans and
/// measurements.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "engine/api/messages/grid.h"
#include "engine/api/messages/motion.h"
#include "engine/api/messages/path.h"
#include "engine/api/messages/sensors.h"
#include "engine/core/time.h"
#include "engine/math/pose.h"
#include "engine/record/log_reader.h"

namespace vinerow::playback {

/// Samples of one signal in ascending time.
template <class T>
struct Trace {
  std::vector<Time> times;
  std::vector<T> values;

  void add(Time t, const T& value) {
    times.push_back(t);
    values.push_back(value);
  }
  bool empty() const { return times.empty(); }
  /// Index of the last sample at or before t; 0 if t is before the first. @pre !empty()
  std::size_t index_at(Time t) const;
};

/// Appends the messages of a topic when the pass runs. @param trace  outlives that
template <class T>
void read_into(record::LogPass& pass, const std::string& topic, Trace<T>& trace) {
  pass.read<T>(topic, [&trace](Time t, const T& value) { trace.add(t, value); });
}

/// Pose, speed and covariance at t, interpolated between the samples around it (positions linearly,
/// attitudes by slerp). @pre !trace.empty()
Odometry odometry_at(const Trace<Odometry>& trace, Time t);

struct VehicleTrace {
  Trace<Odometry> truth;
  Trace<LinkPoses> links;
  Trace<PlannedPath> plan;
  Trace<LineList> plan_tree;
  std::map<std::string, Trace<RangeSample>> ranges;  ///< by sensor
  std::map<std::string, Trace<LaserScan>> scans;     ///< by sensor, if requested
  std::map<std::string, Trace<CameraShot>> shots;    ///< by sensor
  /// "estimate" and the estimates of observers by signal, if requested.
  std::map<std::string, Trace<Odometry>> estimates;
  LineList map_edges;  ///< of its own map, if requested; empty if it has no row meshes

  /// Pose and speed at t.
  Odometry truth_at(Time t) const { return odometry_at(truth, t); }
  /// Link poses at t, interpolated likewise.
  std::vector<Pose> links_at(Time t) const;
};

struct LogTrace {
  Time first;
  Time last;
  OccupancyGrid map;  ///< of the run; empty if the log contains no map
  std::map<std::string, VehicleTrace> vehicles;
};

/// True for topics "<sensor>_truth", which contain a sensor's error-free readings.
bool is_truth_of_reading(const record::LogReader& log, const std::string& topic);

/// Optional contents of a trace.
struct TraceWishes {
  bool scans = false;  ///< half a megabyte for each second of a laser scanner
  bool estimates = false;
  bool map_edges = false;
};

/// Reads a trace, without the topics for which is_truth_of_reading() is true.
/// @param vehicles  names of the vehicles to read
LogTrace read_trace(const record::LogReader& log, const std::vector<std::string>& vehicles,
                    const TraceWishes& wishes = {});

}  // namespace vinerow::playback
