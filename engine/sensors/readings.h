#pragma once
/// Output stage of a sensor: dropouts, delay, and the true value of each reading.
///
/// A sensor `gps` writes the signals "gps" (for the vehicle) and "gps_truth" (the same without any
/// error, at the instant of the measurement, for people and checks; no part of a vehicle may read
/// it). Parameters: `delay_s`, `dropout_share`, `outages`.
///
/// A dropout is a message that never arrives: nothing is written. In an outage each sensor decides
/// what it writes: an invalid fix, no echo. Dropouts use a random stream of their own, one number
/// per reading, so they do not change the noise.

#include <initializer_list>
#include <string>
#include <vector>

#include "engine/api/parameter_table.h"
#include "engine/api/stepped_parts.h"
#include "engine/core/random.h"
#include "engine/sensors/delay_line.h"
#include "engine/sensors/time_window.h"

namespace vinerow::sensors {

struct ReadingParams {
  double delay_s = 0.0;
  double dropout_share = 0.0;
  std::vector<TimeWindowParams> outages;
};

/// `delay_s`, `dropout_share`, `outages`.
const ParameterTable<ReadingParams>& reading_table();

template <class T>
class Readings {
 public:
  /// @param parameters  with those of reading_table()
  Readings(const ParameterSet& parameters, const SensorContext& context)
      : Readings(reading_table().read(parameters, context.part), context) {}
  /// @param has_truth  false: the readings have no error, and no truth is written
  Readings(const ReadingParams& params, const SensorContext& context, bool has_truth = true)
      : has_truth_(has_truth),
        name_(context.name),
        outages_(windows_of(params.outages)),
        dropout_share_(params.dropout_share),
        line_(duration_from_s(params.delay_s), context.period),
        random_(context.random("dropout")) {}

  void connect(Ports& ports) {
    out_ = ports.write<T>(name_);
    if (has_truth_) truth_out_ = ports.write<T>(name_ + "_truth");
  }
  /// For readings that own memory; see DelayLine.
  void prefill(const T& reading) { line_.prefill(reading); }
  Duration delay() const { return line_.delay(); }
  void deliver() { line_.deliver(out_); }

  bool is_in_outage(Time now) const { return is_in_any(outages_, now); }

  /// Called once per tick, outages included. The truth is written even if the reading is lost.
  void push(Time now, const T& reading, const T& truth) {
    if (has_truth_) truth_out_.write(now, truth);
    const bool is_lost = dropout_share_ > 0.0 && random_.uniform() < dropout_share_;
    if (is_lost) {
      line_.push_lost();
    } else {
      line_.push(now, reading, out_);
    }
  }

  /// For an outage of a sensor whose message cannot express "invalid": no reading is written, but
  /// the truth is. The random numbers of later dropouts stay the same.
  void push_silence(Time now, const T& truth) {
    if (has_truth_) truth_out_.write(now, truth);
    if (dropout_share_ > 0.0) random_.uniform();
    line_.push_lost();
  }

  void push_or_silence(Time now, const T& reading, const T& truth) {
    if (is_in_outage(now)) {
      push_silence(now, truth);
    } else {
      push(now, reading, truth);
    }
  }

  /// Instead of push() at a tick without a reading, for sensors that do not read at every tick.
  void push_nothing() { line_.push_lost(); }

 private:
  bool has_truth_;
  std::string name_;
  std::vector<TimeWindow> outages_;
  double dropout_share_;
  DelayLine<T> line_;
  RandomStream random_;
  SignalWriter<T> out_;
  SignalWriter<T> truth_out_;
};

}  // namespace vinerow::sensors
