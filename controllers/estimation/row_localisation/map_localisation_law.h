#pragma once
/// Localisation between mapped rows by a bank of extended Kalman filters, one for each alley in
/// which the vehicle may be. Inputs: velocity and attitude of the inertial unit, satellite fixes,
/// and echoes of range sensors. Independent of signals.
///
/// Differences from paper C's filter (controllers/estimation/row_localisation/distance_filter.h):
/// - The echo itself is the measurement. Its variance contains the map's roughness, enlarged for as
///   long as the roughness stays the same along the row.
/// - The prediction contains the cone, and a wall's roughness over the stretch of row at which the
///   vehicle may be.
/// - Echoes that no wall explains are gated; doubtful ones weigh less (Huber).
/// - Slow errors of velocity, heading, fixes and map are states.
/// - Late data are compared with the position at their own time.
/// - One filter for each alley finds the right alley from a poor start.
/// Figures: docs/papers/localisation.md.

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
  /// Part of the heading error that changes at every tick.
  double heading_white_std_rad = rad_from_deg(0.2);
  double gate_sigma = 3.5;  ///< of echoes; beyond it an echo counts as false
  double fix_gate_sigma = 5.0;
  /// Share of a fix's stated variance that changes slowly; the rest is white. 0: a fix states its
  /// white error alone, and `noise` has the slow one.
  double fix_slow_share = 0.0;
  double huber_sigma = 1.5;  ///< of echoes; beyond it they weigh less
  double max_along = 0.7;    ///< |normal . row|: facets that face more along the row are not used
  /// Whether leaning walls correct the height. If the map's walls lean differently from the true
  /// ones, all echoes have the same error, which averaging does not reduce.
  bool walls_correct_height = true;
  double max_range_m = 4.0;    ///< farther predictions are not used
  double min_speed_mps = 0.3;  ///< lower bound of the speed at which the map's error changes
  double false_share = 0.1;    ///< share of echoes that no wall explains, for the bank's weights
  double map_shift_std_m =
      0.0;  ///< 1 sigma of a shift of the whole map, in addition to what the map states
  double bank_std_m =
      0.5;  ///< the start uses one filter for each alley if its deviation exceeds this
  double start_lateral_std_m =
      0.35;      ///< start deviation of each of those filters, across its alley
  int bank = 5;  ///< maximum number of filters
  double lost_share =
      0.8;  ///< the bank restarts if this share of echoes is gated or has no wall over lost_time_s
  double lost_time_s = 2.0;
  double lost_fix_sigma =
      5.0;  ///< the bank restarts if the estimated slow error of the fixes exceeds this
};

class MapLocalisationLaw {
 public:
  /// Counts since the start.
  struct Counters {
    int echoes = 0, echoes_gated = 0, echoes_unexplained = 0;
    int fixes = 0, fixes_gated = 0;
    int heights = 0, heights_gated = 0;
    int refused =
        0;         ///< not finite, or older than the remembered past or the sensor's last reading
    int lost = 0;  ///< times the bank restarted
  };

  /// @param sensors ranges refer to them by index @param map, index must outlive this
  MapLocalisationLaw(const MapLocalisationParams& params, const RowMap& map,
                     const RowMeshIndex& index, std::vector<RangeSensorModel> sensors);

  /// For sensors whose readings contain their cone.
  void set_half_angle(int sensor, double half_angle_rad) {
    sensors_[sensor].half_angle_rad = half_angle_rad;
  }
  void start(Time now, const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance_m2);
  bool has_started() const { return count_ > 0; }

  /// Propagates from the last tick to this one. @param v_W, q_WB current output of the inertial
  /// unit
  void predict(Time now, const Eigen::Vector3d& v_W, const Eigen::Quaterniond& q_WB);
  /// @param measured  time of the fix, no older than kMemory ticks  @param p_W  of the antenna
  /// @param p_BA  the antenna in B
  /// @param mode  of the receiver: with `fix_slow_share` each mode has its own slow error
  void correct_fix(Time measured, const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m,
                   const Eigen::Vector3d& p_BA, int mode = 0);
  /// n.p of the body's origin, n unit: a height if n is up. Gated by fix_gate_sigma.
  void correct_plane(Time measured, const Eigen::Vector3d& normal_W, double offset_m, double std_m);
  /// @param range_m  finite; readings without an echo are not used @param period_s  between this
  /// sensor's readings
  void correct_range(Time measured, int sensor, double range_m, double period_s);

  /// State of the likeliest filter.
  const LocalisationState& state() const { return filters_[best_].state; }
  /// Covariance about the likeliest filter's position; the other filters count with their weights.
  Eigen::Matrix3d position_covariance() const;
  /// Position of the likeliest filter relative to the map's walls, as if the map had no shift: the
  /// position in W minus the estimated shift of the map.
  Eigen::Vector3d position_on_map() const;
  /// Covariance of position_on_map() as an estimate of the position in W: it contains the full
  /// start variance of the map's shift, whatever was learnt since.
  Eigen::Matrix3d position_on_map_covariance() const;
  int filter_count() const { return count_; }
  double best_weight() const { return filters_[best_].weight; }
  const Counters& counters() const { return counters_; }
  /// Normalised innovation squared of the last echo that the likeliest filter used; 0 before. Its
  /// variance is that of one reading, without the inflation for correlated readings. Expectation 1.
  double range_nis() const { return range_nis_; }
  /// The same of the last fix, its three coordinates together. Expectation 3.
  double fix_nis() const { return fix_nis_; }

 private:
  static constexpr int kMaxFilters = 8;
  static constexpr int kMemory = 256;
  struct Filter {
    LocalisationState state;
    double weight = 1.0;
    double log_gain = 0.0;  // of the current measurement
  };
  struct Past {
    Time time;
    Eigen::Vector3d displacement_W;  // dead reckoned since the start
    Eigen::Quaterniond q_WB;
  };
  struct Fix {
    Eigen::Vector3d p_W, displacement_W, std_m;  // of the body's origin; dead reckoned until then
  };

  bool recall(Time measured, Past& past) const;
  const PlantRow* find_row(int id) const;
  Eigen::Array3d map_shift_variance_m2() const;
  void start_bank(const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance_m2);
  void add_filter(const Eigen::Vector3d& p_W, const Eigen::Matrix3d& covariance_m2, double weight);
  /// @returns tempered log-likelihood
  double take_echo(Filter& filter, const Past& past, const Eigen::Vector3d& displacement_since_W,
                   const RangeSensorModel& sensor, double range_m, double period_s, bool is_best);
  double take_fix(Filter& filter, const Past& past, const Eigen::Vector3d& displacement_since_W,
                  const Eigen::Vector3d& p_W, const Eigen::Vector3d& std_m,
                  const Eigen::Vector3d& p_BA, bool is_best);
  /// Sets the slow error from the fix's stated deviation. @returns its white part, 1 sigma
  Eigen::Vector3d split_fix(const Eigen::Vector3d& std_m, int mode);
  /// Restarts the bank around the last fix, if there was one. The likeliest filter stays in the
  /// bank, so that the weights decide between it and the new filters.
  void restart();
  void keep(const Filter& filter);
  void reweight();  // without a measurement
  void weigh();
  void watch_gates(bool gated, double period_s);

  MapLocalisationParams params_;
  const RowMap& map_;
  const RowMeshIndex& index_;
  std::vector<RangeSensorModel> sensors_;
  std::array<Filter, kMaxFilters> filters_;
  int count_ = 0;
  int best_ = 0;
  Eigen::Vector3d displacement_W_ = Eigen::Vector3d::Zero();
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
