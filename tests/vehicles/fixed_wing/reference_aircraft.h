#pragma once
/// The flying wing once more, for comparison: the table of the reference of paper A, section 1, in
/// aviation axes (north east down, forward right down) with Euler angles, by the classical
/// Runge-Kutta rule. Beard, McLain 2012, eq. 3.14-3.17, 4.9, 4.10, 4.15. Shares no code and no
/// number with the vehicle.

#include <Eigen/Dense>
#include <cmath>
#include <functional>

namespace vinerow::vehicles::test {

/// Wind as north, east, down at a time, m/s.
using WindNed = std::function<Eigen::Vector3d(double time_s)>;

class ReferenceAircraft {
 public:
  /// north east down | u v w over ground | phi theta psi | p q r | throttle, left, right elevon
  using State = Eigen::Matrix<double, 15, 1>;

  ReferenceAircraft(const Eigen::Vector3d& wanted, WindNed wind, double gravity = 9.80665)
      : wanted_(wanted), wind_(std::move(wind)), g_(gravity) {}

  /// Body to north-east-down.
  static Eigen::Matrix3d rotation(double phi, double theta, double psi) {
    return (Eigen::AngleAxisd(psi, Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(theta, Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(phi, Eigen::Vector3d::UnitX()))
        .toRotationMatrix();
  }

  State rate(double t, const State& x) const {
    const double phi = x[6], theta = x[7], psi = x[8], p = x[9], q = x[10], r = x[11];
    const Eigen::Matrix3d R = rotation(phi, theta, psi);
    const Eigen::Vector3d v = x.segment<3>(3), air = v - R.transpose() * wind_(t);
    const Eigen::Vector3d w(p, q, r);

    const double rho = 1.225, S = 0.27, b = 0.9, c = 0.311, m = 1.2;
    const double V = air.norm(), alpha = std::atan2(air.z(), air.x()), slip = air.y() / V;
    const double plane = std::hypot(air.x(), air.z()) / V;
    const double Q = 0.5 * rho * V * V * S;
    const double left = x[13], right = x[14], de = 0.5 * (right + left), da = 0.5 * (left - right);
    // Stall: eq. 4.10.
    const double M = 50.0, a0 = 22.5 * 3.14159265358979323846 / 180.0;
    const double e1 = std::exp(-M * (alpha - a0)), e2 = std::exp(M * (alpha + a0));
    const double s = (1.0 + e1 + e2) / ((1.0 + e1) * (1.0 + e2));
    const double k = 1.0 - 0.7 * s;
    const double sa = std::sin(alpha), ca = std::cos(alpha), side = sa < 0 ? -1.0 : 1.0;
    const double CL = (1 - s) * (0.05 + 3.50 * alpha) + s * 2 * side * sa * sa * ca +
                      4.2 * c * q / (2 * V) + 0.806 * k * de;
    const double CD = 0.025 + (1 - s) * CL * CL / (3.14159265358979323846 * 0.85 * b * b / S) +
                      s * 2 * side * sa * sa * sa + 0.15 * 0.5 * (left * left + right * right);
    const double Cm =
        (1 - s) * (0.035 - 0.309 * alpha) - s * 0.25 * 2 * side * sa * sa - 0.32 * k * de;
    const double P = p * b / (2 * V), Rn = r * b / (2 * V);
    const Eigen::Vector3d force(
        Q * plane * (-CD * ca + CL * sa) + 0.5 * rho * 0.0314 * (625.0 * x[12] * x[12] - V * V),
        Q * (-0.327 * slip - 0.145 * P + 0.244 * Rn), Q * plane * (-CD * sa - CL * ca));
    const Eigen::Vector3d moment(Q * b * (-0.188 * slip - 0.384 * P + 0.152 * Rn + 0.194 * k * da),
                                 Q * c * (Cm * plane - 1.145 * c * q / (2 * V)),
                                 Q * b * (0.029 * slip - 0.047 * P - 0.036 * Rn - 0.0095 * k * da));
    Eigen::Matrix3d J;
    J << 0.031, 0, -0.0005, 0, 0.019, 0, -0.0005, 0, 0.048;

    State d;
    d.segment<3>(0) = R * v;
    d.segment<3>(3) = force / m + R.transpose() * Eigen::Vector3d(0, 0, g_) - w.cross(v);
    d[6] = p + std::tan(theta) * (q * std::sin(phi) + r * std::cos(phi));
    d[7] = q * std::cos(phi) - r * std::sin(phi);
    d[8] = (q * std::sin(phi) + r * std::cos(phi)) / std::cos(theta);
    d.segment<3>(9) = J.inverse() * (moment - w.cross(J * w));
    d[12] = (wanted_[0] - x[12]) / 0.10;
    d[13] = (wanted_[1] - x[13]) / 0.04;
    d[14] = (wanted_[2] - x[14]) / 0.04;
    return d;
  }

  State run(State x, double t, double time_s, int steps) const {
    const double h = time_s / steps;
    for (int i = 0; i < steps; ++i, t += h) {
      const State k1 = rate(t, x), k2 = rate(t + 0.5 * h, x + 0.5 * h * k1);
      const State k3 = rate(t + 0.5 * h, x + 0.5 * h * k2), k4 = rate(t + h, x + h * k3);
      x += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
    return x;
  }

  Eigen::Vector3d wanted_;  ///< throttle, left, right elevon; may be changed between runs

 private:
  WindNed wind_;
  double g_;
};

}  // namespace vinerow::vehicles::test
