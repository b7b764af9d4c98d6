#pragma once
/// Moments of a mission at which pictures are drawn (`pictures.moments`), from its log.

#include <map>
#include <optional>
#include <set>
#include <string>

#include "engine/core/time.h"
#include "engine/record/log_reader.h"
#include "engine/scenario/scenario.h"

namespace vinerow::playback {

/// Time span of a phase: from its first state that is not "waiting" to its first state that is
/// neither "waiting" nor "running".
struct PhaseSpan {
  Time begin;
  std::optional<Time> end;  ///< absent if it was running when the log ended

  bool contains(Time t) const { return begin <= t && (!end || t <= *end); }
};

/// Spans of the phases by name, without phases that never began. Empty for a run without a mission.
std::map<std::string, PhaseSpan> read_phase_spans(const record::LogReader& reader);

/// The latest phase in which a vehicle works at t. Without a mission, vehicles work all the time,
/// from the log's first instant on. @returns nullopt while the vehicle is parked
std::optional<PhaseSpan> work_at(const scenario::Scenario& scenario, const std::string& vehicle,
                                 Time t, const std::map<std::string, PhaseSpan>& spans);

/// Instants of a camera's frames. A camera that follows a vehicle, behind it or on board, has no
/// frames while the vehicle is parked.
std::set<Time> moment_times(const scenario::Scenario& scenario,
                            const scenario::CameraConfig& camera,
                            const std::map<std::string, PhaseSpan>& spans);

}  // namespace vinerow::playback
