#pragma once
/// Channels of a run: which signals a log contains, and how often.

#include "engine/record/signal_channels.h"

namespace vinerow {
class Simulation;
}

namespace vinerow::run {

/// Adds all signals that something writes, the mounting of the sensors and the scene. Truth and
/// diagnostics have record.truth_rate_Hz, most other signals record.sensor_rate_limit_Hz at most;
/// events, plans, contacts and commands from outside are complete.
/// @param simulation  outlives `channels`
void add_run_channels(const Simulation& simulation, record::SignalChannels& channels);

}  // namespace vinerow::run
