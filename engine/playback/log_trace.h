#pragma once
/// What pictures need of a log, in memory: where every vehicle and link was, what was planned and
/// measured.

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

/// Samples of one signal in rising time.
template <class T>
struct Trace {
  std::vector<Time> times;
  std::vector<T> values;

  bool empty() const { return times.empty(); }
  /// Index of the last sample at or before t; 0 if t is before the first. @pre !empty()
  std::size_t index_at(Time t) const;
};

/// Pose, speed and covariance at t, between the samples around it (constant twist is not assumed:
/// straight and slerp). @pre !trace.empty()
Odometry odometry_at(const Trace<Odometry>& trace, Time t);

struct VehicleTrace {
  Trace<Odometry> truth;
  Trace<LinkPoses> links;
  Trace<PlannedPath> plan;
  Trace<LineList> plan_tree;
  std::map<std::string, Trace<RangeSample>> ranges;  ///< by sensor
  std::map<std::string, Trace<LaserScan>> scans;     ///< by sensor, where they were asked for
  std::map<std::string, Trace<CameraShot>> shots;    ///< by sensor
  /// "estimate" and those of observers by signal, where they were asked for.
  std::map<std::string, Trace<Odometry>> estimates;
  LineList map_edges;  ///< of its own map, where they were asked for; empty where it has none

  /// Pose and speed at t.
  Odometry truth_at(Time t) const { return odometry_at(truth, t); }
  /// Link poses at t, interpolated likewise.
  std::vector<Pose> links_at(Time t) const;
};

struct LogTrace {
  Time first;
  Time last;
  OccupancyGrid map;  ///< of the run; empty where the log has none
  std::map<std::string, VehicleTrace> vehicles;
};

/// Whether a topic tells what the sensor beside it would have read without error: "<sensor>_truth".
bool is_truth_beside(const record::LogReader& log, const std::string& topic);

/// What is read beside the rest.
struct TraceWishes {
  bool scans = false;  ///< half a megabyte for each second of a laser scanner
  bool estimates = false;
  bool map_edges = false;
};

/// What is_truth_beside() is left out.
/// @param vehicles  names to look for
LogTrace read_trace(const record::LogReader& log, const std::vector<std::string>& vehicles,
                    const TraceWishes& wishes = {});

}  // namespace vinerow::playback
