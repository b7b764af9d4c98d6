#include "engine/playback/phase_moments.h"

#include <algorithm>

#include "engine/api/messages/commands.h"
#include "engine/sim/phase_report.h"

namespace vinerow::playback {
std::map<std::string, PhaseSpan> read_phase_spans(const record::LogReader& reader) {
  std::map<std::string, PhaseSpan> spans;
  if (!reader.has_topic("/run/phases")) return spans;
  reader.read<NamedValues>("/run/phases", [&](Time t, const NamedValues& states) {
    for (std::size_t i = 0; i < states.names.size(); ++i) {
      if (states.values[i] == static_cast<double>(PhaseState::kWaiting)) continue;
      PhaseSpan& span = spans.emplace(states.names[i], PhaseSpan{t, std::nullopt}).first->second;
      const bool runs = states.values[i] == static_cast<double>(PhaseState::kRunning);
      if (!runs && !span.end) span.end = t;
    }
  });
  return spans;
}

std::optional<PhaseSpan> work_at(const scenario::Scenario& scenario, const std::string& vehicle,
                                 Time t, const std::map<std::string, PhaseSpan>& spans) {
  if (scenario.phases.empty()) return PhaseSpan{Time{}, std::nullopt};
  std::optional<PhaseSpan> latest;
  for (const scenario::PhaseConfig& phase : scenario.phases) {
    const auto& who = phase.vehicles;
    const auto span = spans.find(phase.name);
    if (std::find(who.begin(), who.end(), vehicle) == who.end() || span == spans.end()) continue;
    if (!span->second.contains(t)) continue;
    if (!latest || span->second.begin >= latest->begin) latest = span->second;
  }
  return latest;
}

std::set<Time> moment_times(const scenario::Scenario& scenario,
                            const scenario::CameraConfig& camera,
                            const std::map<std::string, PhaseSpan>& spans) {
  std::set<Time> times;
  const bool follows =
      camera.kind == scenario::CameraKind::kChase || camera.kind == scenario::CameraKind::kOnBoard;
  for (const scenario::PhaseMoment& moment : scenario.pictures.moments) {
    const auto span = spans.find(moment.phase);
    if (span == spans.end()) continue;
    const Time t = span->second.begin + duration_from_s(moment.after_s);
    if (!follows || work_at(scenario, camera.vehicle, t, spans)) times.insert(t);
  }
  return times;
}

}  // namespace vinerow::playback
