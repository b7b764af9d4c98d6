#pragma once
/// Channels of a run's signals with CDR-encoded ROS 2 messages, for any MessageSink (README.md has
/// the table of signals and messages). Log and live connections share this code, so a client
/// receives the same channels, schemas and bytes that the log contains.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/api/signal.h"
#include "engine/record/message_sink.h"
#include "engine/record/scene_message.h"

namespace vinerow::record {

class SignalChannels {
 public:
  /// @param sink  outlives this object
  /// @param compact_poses  true: link and sensor poses are stored relative to "<vehicle>/truth",
  ///   rounded to 1 nm and 2 nrad. false: exactly in W
  SignalChannels(MessageSink& sink, bool compact_poses);
  ~SignalChannels();

  /// Adds a channel for a signal, and a second one "<topic>/exact" if the ROS 2 type cannot hold
  /// the exact value. The topic is "/" + signal name. Channel ids follow the order of calls.
  /// @param min_period  samples closer than this to the last one are skipped; 0 = none is skipped
  /// @param frame  of messages that name the signal's own; empty: the signal's name
  /// @param exact_alone  if there are two messages, only the exact one, as "<topic>"
  void add_signal(const SignalBase& signal, Duration min_period, const std::string& frame = {},
                  bool exact_alone = false);

  /// Static transforms between frames as "/tf_static", at time 0.
  void add_static_transforms(const std::vector<StaticTransform>& transforms);
  /// Solid objects for display as "/run/scene", at time 0.
  void add_scene(const std::vector<SceneEntity>& entities);

  /// Passes on every added signal that was written since the last call. Log time is `now`, publish
  /// time is the signal's stamp. Which samples are skipped does not depend on the sink.
  void write_new(Time now);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::record
