#pragma once
/// Random 1-cosine gusts of a world; listed gusts: engine/api/wind_field.h.

#include <optional>

#include "engine/api/wind.h"
#include "engine/core/random.h"
#include "engine/core/time.h"

namespace vinerow::vehicles {

/// Sequence of random gusts. The pause after each is exponentially distributed with the mean
/// interval - duration, so that there is one gust per interval on average and none overlap.
/// Direction is uniform; amplitude and duration are those of the world. The schedule depends only
/// on the world's seed: every probe generates the same one, gust by gust. No heap.
class RandomGusts {
 public:
  /// @pre validate(wind)
  explicit RandomGusts(const Wind& wind);

  /// The present or next gust. Undefined if the world has no random gusts.
  /// @param time_s  must not decrease from call to call
  const WindGust& at(double time_s);
  bool none() const { return !statistics_; }

 private:
  void draw_next();

  std::optional<GustStatistics> statistics_;
  RandomStream random_;
  WindGust gust_;
};

}  // namespace vinerow::vehicles
