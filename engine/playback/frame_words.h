#pragma once
/// Text in frames of a run, for readers who do not know its files.

#include <map>
#include <string>
#include <vector>

#include "engine/core/time.h"
#include "engine/playback/phase_moments.h"
#include "engine/scenario/scenario.h"

namespace vinerow::playback {

/// "cooperative_small" -> "Cooperative small".
std::string title_of_name(const std::string& name);

/// The description's first sentence, or the part before its colon or dash, if that is short enough
/// for a picture, else the name in words: "Paper C in open loop", "Cooperative small".
std::string picture_title(const scenario::Scenario& scenario);

/// Keyword of the text in a frame's file that lists the share of the picture for each vehicle.
inline constexpr const char* kSeenKey = "vinerow:seen";
/// Conversion between shares of a picture by vehicle and this text, with one line "rover 0.0312"
/// for each vehicle. Other lines are ignored.
std::string seen_text(const std::map<std::string, double>& shares);
std::map<std::string, double> parse_seen(const std::string& text);

/// "05:33.2"
std::string clock_text(Time t);

/// Names of the phases that run at t, with underscores as spaces, in the scenario's order.
std::vector<std::string> phases_at(const scenario::Scenario& scenario,
                                   const std::map<std::string, PhaseSpan>& spans, Time t);

}  // namespace vinerow::playback
