#include "engine/sensors/gnss_tracking.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/api/parameter_table.h"

namespace vinerow::sensors {
namespace {

using Eigen::Vector3d;

/// Length of the rays. Chosen: all obstacles to the sky of a parcel are nearer.
constexpr double kReach_m = 1'000.0;
constexpr SurfaceMask kSeen =
    kAllSurfaces & ~mask_of(SurfaceClass::kWire) & ~mask_of(SurfaceClass::kVehicle);
/// Step behind a surface before the next ray. Chosen: far above the rounding of the ray caster.
constexpr double kStep_m = 2e-3;
/// Chosen: after this number of canopy surfaces nothing remains of a signal.
constexpr int kMaxCrossings = 12;
/// Depth of a sheet of leaves without a back. Chosen: about a vine's shoot and leaves.
constexpr double kLoneLeaves_m = 0.3;
constexpr double kNoSignal_dBHz = -std::numeric_limits<double>::infinity();

std::string find_fault_in_code(const GnssSignals& p) {
  if (p.carrier_cn0_dBHz >= p.code_cn0_dBHz) return "";
  return fmt::format("carrier_cn0_dBHz = {} dB-Hz, must be >= code_cn0_dBHz = {} dB-Hz",
                     p.carrier_cn0_dBHz, p.code_cn0_dBHz);
}

std::string find_fault_in_zenith(const GnssSignals& p) {
  if (p.zenith_cn0_dBHz >= p.horizon_cn0_dBHz) return "";
  return fmt::format("zenith_cn0_dBHz = {} dB-Hz, must be >= horizon_cn0_dBHz = {} dB-Hz",
                     p.zenith_cn0_dBHz, p.horizon_cn0_dBHz);
}

}  // namespace

const ParameterTable<GnssSignals>& gnss_signal_table() {
  using P = GnssSignals;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .degrees("mask_deg", &P::mask_rad, between(0.0, 60.0),
                   "elevation mask: lower satellites are not used")
          .number("zenith_cn0_dBHz", "dB-Hz", &P::zenith_cn0_dBHz, between(0.0, 60.0),
                  "carrier-to-noise density of a satellite at the zenith")
          .number("horizon_cn0_dBHz", "dB-Hz", &P::horizon_cn0_dBHz, between(0.0, 60.0),
                  "carrier-to-noise density at the horizon, by the antenna's pattern")
          .number("usual_cn0_dBHz", "dB-Hz", &P::usual_cn0_dBHz, between(0.0, 60.0),
                  "carrier-to-noise density from which a satellite has its full weight")
          .number("code_noise_share", "", &P::code_noise_share, between(0.0, 1.0),
                  "share of noise in the variance of a code's range at the usual C/N0")
          .number("carrier_noise_share", "", &P::carrier_noise_share, between(0.0, 1.0),
                  "the same for carrier phase")
          .number("code_cn0_dBHz", "dB-Hz", &P::code_cn0_dBHz, between(0.0, 60.0),
                  "minimum for a position by code")
          .number("carrier_cn0_dBHz", "dB-Hz", &P::carrier_cn0_dBHz, between(0.0, 60.0),
                  "minimum for a position by carrier phase")
          .number("leaves_dB_per_m", "dB/m", &P::leaves_dB_per_m, between(0.0, 100.0),
                  "loss in canopy of 6 m2/m3 leaf area, in proportion where the world knows its "
                  "leaves; tree crowns have 2 in the L band")
          .number("fading_share", "", &P::fading_share, between(0.0, 2.0),
                  "standard deviation of the fading by moving leaves and antenna, as a share of "
                  "that loss")
          .number("fading_time_s", "s", &P::fading_time_s, kPositive,
                  "correlation time of the fading")
          .number("reacquisition_s", "s", &P::reacquisition_s, between(0.0, 600.0),
                  "time until a lost satellite is used again")
          .number("bridged_gap_s", "s", &P::bridged_gap_s, between(0.0, 60.0),
                  "longest gap of a signal that needs no reacquisition")
          .number("carrier_lock_s", "s", &P::carrier_lock_s, between(0.0, 600.0),
                  "time until the carrier phase of a satellite is used after any gap")
          .rule(find_fault_in_code)
          .rule(find_fault_in_zenith);
  return table;
}

GnssTracking::GnssTracking(const GnssSignals& signals, GnssSky sky, const SceneQuery& scene,
                           LeafAreaDensity leaves, double period_s, bool locked,
                           RandomStream random)
    : signals_(signals),
      sky_(std::move(sky)),
      scene_(&scene),
      leaves_(std::move(leaves)),
      period_s_(period_s),
      random_(random),
      satellites_(sky_.size()) {
  constexpr double kTrackedLong_s = 1e9;
  for (Satellite& satellite : satellites_) {
    satellite.fading = GaussMarkov(1.0, signals_.fading_time_s, period_s_);
    satellite.fading.start(random_);
    if (locked) satellite.received_s = satellite.carrier_s = kTrackedLong_s;
  }
}

double GnssTracking::leaves_m(const Vector3d& p_W, const Vector3d& direction_W) {
  double total_m = 0.0, from_m = 0.0, entered_m = 0.0, share = 1.0;
  bool inside = false;
  for (int crossing = 0; crossing < kMaxCrossings; ++crossing) {
    const auto hit =
        scene_->cast_ray(p_W + from_m * direction_W, direction_W, kReach_m - from_m, kSeen);
    if (!hit) return inside ? total_m + share * kLoneLeaves_m : total_m;
    if (hit->surface != SurfaceClass::kCanopy) return -1.0;
    const double at_m = from_m + hit->distance_m;
    if (inside) {
      total_m += share * (at_m - entered_m);
    } else {
      entered_m = at_m;
      share = leaves_.of(hit->mesh) / kUsualLeafAreaDensity_m2pm3;
    }
    inside = !inside;
    from_m = at_m + kStep_m;
  }
  return -1.0;
}

void GnssTracking::track(Satellite& satellite, double cn0_dBHz) const {
  if (cn0_dBHz >= signals_.carrier_cn0_dBHz) {
    satellite.carrier_s += period_s_;
  } else {
    satellite.carrier_s = 0.0;
  }
  if (cn0_dBHz >= signals_.code_cn0_dBHz) {
    satellite.received_s += period_s_;
    satellite.gap_s = 0.0;
  } else {
    satellite.gap_s += period_s_;
    if (satellite.gap_s > signals_.bridged_gap_s + 1e-9) satellite.received_s = 0.0;
  }
}

double GnssTracking::weight(double cn0_dBHz, double noise_share) const {
  const double noise = std::pow(10.0, (signals_.usual_cn0_dBHz - cn0_dBHz) / 10.0);
  return std::min(1.0, 1.0 / (1.0 - noise_share + noise_share * noise));
}

GnssView GnssTracking::look(double time_s, const Vector3d& p_W, bool in_outage, double jamming_dB) {
  GnssView view;
  for (std::size_t i = 0; i < satellites_.size(); ++i) {
    Satellite& satellite = satellites_[i];
    const double fading = satellite.fading.step(random_);
    const Vector3d direction_W = sky_.direction_W(i, time_s);
    const double sin_elevation = direction_W.z();
    double cn0_dBHz = kNoSignal_dBHz;
    if (!in_outage && sin_elevation >= std::sin(signals_.mask_rad)) {
      const double leaves = leaves_m(p_W, direction_W);
      if (leaves >= 0.0) {
        const double open_dBHz =
            signals_.horizon_cn0_dBHz +
            (signals_.zenith_cn0_dBHz - signals_.horizon_cn0_dBHz) * sin_elevation;
        const double loss_dB =
            leaves * signals_.leaves_dB_per_m * std::max(0.0, 1.0 + signals_.fading_share * fading);
        cn0_dBHz = open_dBHz - loss_dB - jamming_dB;
      }
    }
    track(satellite, cn0_dBHz);
    if (cn0_dBHz < signals_.code_cn0_dBHz) continue;
    if (satellite.received_s >= signals_.reacquisition_s - 1e-9) {
      view.code.add(direction_W, weight(cn0_dBHz, signals_.code_noise_share));
    }
    const bool has_phase = cn0_dBHz >= signals_.carrier_cn0_dBHz &&
                           satellite.carrier_s >= signals_.carrier_lock_s - 1e-9;
    if (has_phase) {
      view.carrier.add(direction_W, weight(cn0_dBHz, signals_.carrier_noise_share));
    }
  }
  return view;
}

}  // namespace vinerow::sensors
