#pragma once
/// Steering law from lateral and heading error to the two axle angles.
///
/// Source: paper A (Mammarella et al. 2022), eq. 24-26: a virtual wheel at the centre of mass is
/// steered by gamma (it acts on the lateral error d_e, positive left), and the vehicle turns by the
/// curvature kappa (it acts on the heading error theta_e = theta - theta_ref). Two forms:
///
///   corrected  gamma = -K_s d_e, kappa = kappa_ref - K_theta theta_e,
///              tan dF = (sin g + a kappa) / cos g,  tan dR = (sin g - b kappa) / cos g
///   printed    kappa = -K_theta theta_e,  tan dR = (b kappa - sin g) / cos g
///
/// The printed rear angle has the wrong sign: it holds only for a rear angle counted clockwise, and
/// otherwise tracking diverges. Without kappa_ref every turn leaves a steady heading error
/// kappa_ref / K_theta. In the corrected form small errors obey, per metre driven,
/// d_e' = theta_e - K_s d_e and theta_e' = -K_theta theta_e: poles -K_s and -K_theta.
///
/// Beyond the paper: `course_share` c adds -c theta_e to gamma, so that a heading error moves the
/// centre off the path less (c = 1: not at all); the poles stay. The estimated slip
/// (slip_learning.h) is subtracted from both commands.

#include "controllers/four_wheel_steering/axle_geometry.h"

namespace vinerow::controllers {

enum class SteeringForm { kCorrected, kPrinted };

struct SteeringParams {
  SteeringForm form = SteeringForm::kCorrected;
  double lateral_gain_radpm = 2.0;  ///< K_s, rad per m of lateral error
  double heading_gain_per_m = 3.0;  ///< K_theta, curvature per rad of heading error
  double course_share = 0.0;        ///< c
  double max_axle_rad = 0.4;
};

struct SteeringInput {
  double lateral_error_m = 0.0;       ///< d_e, positive: left of the path
  double heading_error_rad = 0.0;     ///< theta_e
  double reference_per_m = 0.0;       ///< kappa_ref
  double slip_rad = 0.0;              ///< direction of travel minus that of the axle angles
  double slip_curvature_per_m = 0.0;  ///< the same for the curvature
};

struct SteeringCommand {
  AxleAngles axles;
  double steer_rad = 0.0;        ///< gamma after limiting (corrected form)
  double curvature_per_m = 0.0;  ///< kappa after limiting (corrected form)
};

/// The axle angles, within +-max_axle_rad.
/// If both commands together exceed the limit, the corrected form keeps the curvature (up to the
/// largest possible) and gives gamma the remainder: in the end the heading determines the path of
/// the vehicle. The printed form clamps each angle separately.
SteeringCommand steer(const AxleGeometry& geometry, const SteeringParams& params,
                      const SteeringInput& input);

/// Largest curvature of the track that the axle limit allows, 1/m.
double calc_largest_curvature(const AxleGeometry& geometry, double max_axle_rad);

}  // namespace vinerow::controllers
