#pragma once
/// 1-cosine gusts of a world that come by chance; those of its list: engine/api/wind_field.h.

#include <optional>

#include "engine/api/wind.h"
#include "engine/core/random.h"
#include "engine/core/time.h"

namespace vinerow::vehicles {

/// Gusts by chance, one after the other: after each the air rests for a time that is
/// exponentially distributed with mean interval - duration, so that they come once per interval on
/// average and never overlap. Direction uniform, amplitude and duration as the world says.
/// The schedule follows from the world's seed alone: every probe makes the same one, piece by
/// piece, however long the run. No heap.
class RandomGusts {
 public:
  /// @pre validate(wind)
  explicit RandomGusts(const Wind& wind);

  /// The gust that is on or comes next. @param time_s  never running back. Meaningless where
  /// the world has none.
  const WindGust& at(double time_s);
  bool none() const { return !statistics_; }

 private:
  void draw_next();

  std::optional<GustStatistics> statistics_;
  RandomStream random_;
  WindGust gust_;
};

}  // namespace vinerow::vehicles
