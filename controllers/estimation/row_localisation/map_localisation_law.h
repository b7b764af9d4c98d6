#pragma once
/// Where a vehicle is between mapped rows: a bank of extended Kalman filters, one per alley it may
/// stand in, fed with the inertial unit's velocity and attitude, satellite fixes, and echoes of
/// range sensors. Knows no signals.
///
/// What is beyond paper C's filter (controllers/estimation/row_localisation/distance_filter.h): the
/// echo itself is the measurement, its variance holds the map's roughness for as long as it stays
/// the same along the row; the cone is part of the prediction, and so is a wall's roughness over
/// the stretch of row that the vehicle may be at; echoes that no wall explains are gated, doubtful
/// ones weigh less (Huber); slow errors of velocity, heading, fixes and map are states; late data
/// are compared with where the vehicle was; and one filter per alley finds the right one from a
/// poor start. Figures: docs/papers/localisation.md.

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "controllers/estimation/row_localisation/localisation_state.h"
#include "controllers/estimation/row_localisation/range_prediction.h"
#include "engine/api/forward.h"
#include "engine/api/plant_row.h"
#include "engine/core/time.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {

struct MapLocalisationParams {
  LocalisationNoise noise;
  /// Part of the heading's error that changes every tick.
  double heading_white_std_rad = rad_from_deg(0.2);
  double gate_sigma = 3.5;  ///< of echoes; beyond it they count as false
  double fix_gate_sigma = 5.0;
  /// Of a fix's stated variance what moves slowly; the rest is white. 0: a fix states its white
  /// error alone, and `noise` tells the slow one.
  double fix_slow_share = 0.0;
  double huber_sigma = 1.5;  ///< of echoes; from here on they weigh less
  double most_along = 0.7;   ///< |normal . row|: facets that face more along the row tell nothing
  /// Whether walls that lean tell the height. Where the map's lean otherwise than the true ones,
  /// all of them are wrong the same way, which no mean of many echoes takes away.
  bool walls_tell_height = true;
  double max_range_m = 4.0;      ///< farther predictions are not used
  double least_speed_mps = 0.3;  ///< slower than this the map's error counts as changing no slower
  double false_share = 0.1;      ///< of echoes that no wall explains, for the bank's weights
  double map_shift_std_m =
      0.0;                  ///< 1 sigma of a shift of the whole map beside what its maker states
  double bank_std_m = 0.5;  ///< start with one filter per alley if it is known less well than this
  double start_lateral_std_m = 0.35;  ///< of each of those filters, across its alley
  int bank = 5;                       ///< filters at most
  double lost_share = 0.8;  ///< of echoes gated, or without a wall, over lost_time_s: the bank
                            ///< begins anew
  double lost_time_s = 2.0;
  double lost_fix_sigma = 5.0;  ///< the same where the fixes' slow error is estimated beyond this
};

class MapLocalisationLaw {
 public:
  /// Counted since the start.
  struct Counters {
    int echoes = 0, echoes_gated = 0, echoes_unexplained = 0;
    int fixes = 0, fixes_gated = 0;
    int heights = 0, heights_gated = 0;
    int refused = 0;  ///< not finite, older than what is remembered, or than the sensor's last
    int lost = 0;     ///< times the bank began anew
  };

  /// @param sensors  ranges are told by their index  @param map  lives as long as the law
  MapLocalisationLaw(const MapLocalisationParams& params, const RowMap& map,
                     const RowMeshIndex& index, std::vector<RangeSensorModel> sensors);

  /// For sensors that tell their cone with every reading.
  void set_half_angle(int sensor, double half_angle_rad) {
    sensors_[sensor].half_angle_rad = half_angle_rad;
  }
  void start(Time now, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance_m2);
  bool has_started() const { return count_ > 0; }

  /// From the last tick to this one. @param v_W, q_WB  as the inertial unit tells them now
  void predict(Time now, const Eigen::Vector3d& v_W, const Eigen::Quaterniond& q_WB);
  /// @param measured  when; no older than kMemory ticks  @param p_W  of the antenna
  /// @param p_BA  the antenna in B
  /// @param mode  of the receiver: with `fix_slow_share` each has a slow error of its own
  void correct_fix(Time measured, const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m,
                   const Eigen::Vector3d& p_BA, int mode = 0);
  /// n.p of the body's origin, n unit: a height where n is up. What is farther off than
  /// fix_gate_sigma is refused.
  void correct_plane(Time measured, const Eigen::Vector3d& normal_W, double offset_m, double std_m);
  /// @param range_m  finite; no echo tells nothing  @param period_s  between this sensor's readings
  void correct_range(Time measured, int sensor, double range_m, double period_s);

  /// Of the likeliest filter.
  const LocalisationState& state() const { return filters_[best_].state; }
  /// About the likeliest filter's position, the others counted by their weights.
  Eigen::Matrix3d position_covariance() const;
  /// Where the likeliest filter is beside the map's walls, told as if the map lay where it says:
  /// the place in W less what is thought of the map's shift.
  Eigen::Vector3d position_on_map() const;
  /// Of that against the place in W, so with all that the shift may be, whatever was learnt of it.
  Eigen::Matrix3d position_on_map_covariance() const;
  int filter_count() const { return count_; }
  double best_weight() const { return filters_[best_].weight; }
  const Counters& counters() const { return counters_; }
  /// Normalised innovation squared of the last echo that the likeliest filter took; 0 before. Its
  /// variance is that of one reading, not enlarged for what many share. Expectation 1.
  double range_nis() const { return range_nis_; }
  /// The same of the last fix, its three coordinates together. Expectation 3.
  double fix_nis() const { return fix_nis_; }

 private:
  static constexpr int kMostFilters = 8;
  static constexpr int kMemory = 256;
  struct Filter {
    LocalisationState state;
    double weight = 1.0;
    double log_gain = 0.0;  // of the measurement at hand
  };
  struct Past {
    Time time;
    Eigen::Vector3d way_W;  // dead reckoned since the start
    Eigen::Quaterniond q_WB;
  };
  struct Fix {
    Eigen::Vector3d p_W, way_W, std_m;  // of the body's origin; dead reckoned until then
  };

  bool recall(Time measured, Past& past) const;
  const PlantRow* find_row(int id) const;
  Eigen::Array3d map_shift_variance_m2() const;
  void begin_bank(const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance_m2);
  void add_filter(const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance_m2, double weight);
  /// @returns log of the likelihood, tempered
  double take_echo(Filter& filter, const Past& past, const Eigen::Vector3d& way_since_W,
                   const RangeSensorModel& sensor, double range_m, double period_s, bool is_best);
  double take_fix(Filter& filter, const Past& past, const Eigen::Vector3d& way_since_W,
                  const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m,
                  const Eigen::Vector3d& p_BA, bool is_best);
  /// Takes over what the fix states of its slow error. @returns its white part, 1 sigma
  Eigen::Vector3d split_fix(const Eigen::Vector3d& std_m, int mode);
  /// About the last fix, where there was one. The likeliest filter stays as one of the bank, so
  /// that weights decide between it and what is new.
  void begin_anew();
  void keep(const Filter& filter);
  void weigh_anew();  // without a measurement
  void weigh();
  void watch_gates(bool gated, double period_s);

  MapLocalisationParams params_;
  const RowMap& map_;
  const RowMeshIndex& index_;
  std::vector<RangeSensorModel> sensors_;
  std::array<Filter, kMostFilters> filters_;
  int count_ = 0;
  int best_ = 0;
  Eigen::Vector3d way_W_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_W_ = Eigen::Vector3d::Zero();
  Time now_;
  std::array<Past, kMemory> past_;
  int past_count_ = 0;
  int past_next_ = 0;
  Fix last_fix_;
  bool has_fix_ = false;
  int fix_mode_ = 0;  // of the last fix
  double gated_share_ = 0.0;
  std::vector<std::optional<Time>> last_range_;  // of each sensor
  Counters counters_;
  double range_nis_ = 0.0, fix_nis_ = 0.0;
};

}  // namespace vinerow::controllers
