#include "engine/sim/weather_watch.h"

#include <cmath>

#include "engine/api/map.h"
#include "engine/api/wind_field.h"
#include "engine/api/world_model.h"

namespace vinerow {
namespace {

constexpr Duration kPeriod{1'000'000'000};

/// Mean of the rows' ends, or W's origin if the world has no rows.
Eigen::Vector2d middle_of_rows(const RowMap& rows) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  if (rows.rows.empty()) return sum;
  for (const PlantRow& row : rows.rows) {
    sum += 0.5 * (row.line_W.front() + row.line_W.back()).head<2>();
  }
  return sum / static_cast<double>(rows.rows.size());
}

}  // namespace

WeatherWatch::WeatherWatch(const scenario::WeatherWindow& window, const WorldModel& world)
    : window_(window), wind_(world.wind), p_W_(middle_of_rows(world.rows)) {}

WeatherWatch::Verdict WeatherWatch::look(Time now) {
  if (!began_) {
    began_ = true;
    begin_ = next_ = now;
  }
  if (now < next_) return Verdict::kWait;
  next_ = now + kPeriod;
  Eigen::Vector3d wind_W = Eigen::Vector3d::Zero();
  wind_W.head<2>() =
      mean_wind_mps(wind_, window_.height_m) * downwind_direction(wind_.from_azimuth_rad);
  for (const WindGust& gust : wind_.gusts) wind_W += calc_gust_W(wind_, gust, now.s(), p_W_);
  speeds_mps_.push_back(wind_W.head<2>().norm());
  const auto needed = static_cast<std::size_t>(std::ceil(window_.over_s));
  if (speeds_mps_.size() > needed) speeds_mps_.pop_front();
  if (speeds_mps_.size() == needed && mean_mps() <= window_.max_wind_mps) return Verdict::kGo;
  return (now - begin_).s() >= window_.wait_s + window_.over_s ? Verdict::kGiveUp : Verdict::kWait;
}

double WeatherWatch::mean_mps() const {
  double sum = 0.0;
  for (const double speed_mps : speeds_mps_) sum += speed_mps;
  return speeds_mps_.empty() ? 0.0 : sum / static_cast<double>(speeds_mps_.size());
}

}  // namespace vinerow
