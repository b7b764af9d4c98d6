#pragma once
/// The quadrotor's equations once more, for comparison: Euler's equations in body axes with the
/// rotors' momentum, rotor speeds as states, by the classical Runge-Kutta rule. Shares no code with
/// the vehicle but the numbers. Free flight in calm air, no ground effect.

#include <Eigen/Geometry>
#include <array>

#include "vehicles/quadrotor/quadrotor_params.h"

namespace vinerow::vehicles::test {

struct ReferenceState {
  Eigen::Vector3d p = Eigen::Vector3d::Zero(), v = Eigen::Vector3d::Zero();  ///< W
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();                     ///< WB
  Eigen::Vector3d w = Eigen::Vector3d::Zero();                               ///< B
  Eigen::Vector4d rotors = Eigen::Vector4d::Zero();

  ReferenceState plus(double h, const ReferenceState& rate) const {
    ReferenceState sum = *this;
    sum.p += h * rate.p, sum.v += h * rate.v, sum.w += h * rate.w, sum.rotors += h * rate.rotors;
    sum.q.coeffs() += h * rate.q.coeffs();
    return sum;
  }
};

class ReferenceFlight {
 public:
  ReferenceFlight(const QuadrotorParams& params, const Eigen::Vector4d& wanted)
      : p_(params), wanted_(wanted) {
    const double first = params.layout == QuadrotorLayout::kX ? 45.0 : 0.0;
    for (int i = 0; i < 4; ++i) {
      const double angle = (first + 90.0 * i) * 3.14159265358979323846 / 180.0;
      hubs_[i] = {params.arm_m * std::cos(angle), params.arm_m * std::sin(angle),
                  params.rotor_height_m};
    }
  }

  ReferenceState rate(const ReferenceState& x) const {
    const double g = 9.80665,
                 hover = std::sqrt(p_.mass_kg * g / (4.0 * p_.rotor.thrust_coefficient_Ns2));
    const Eigen::Matrix3d R = x.q.normalized().toRotationMatrix();
    const Eigen::Vector3d air = -(R.transpose() * x.v);
    const double spin[4] = {+1, -1, +1, -1};  // counter-clockwise: +
    Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
    ReferenceState d;
    double h = 0.0;
    for (int i = 0; i < 4; ++i) {
      const double w = x.rotors[i];
      const double lag = wanted_[i] >= w ? p_.rotor.rise_lag_s : p_.rotor.fall_lag_s;
      d.rotors[i] = (wanted_[i] - w) / lag;
      const Eigen::Vector3d u = air - x.w.cross(hubs_[i]);
      const double c = p_.rotor_drag_Ns_per_m / 4.0 * w / hover;
      const double k = p_.inflow_drag_Ns_per_m / 4.0 * w / hover;
      const Eigen::Vector3d f(c * u.x(), c * u.y(),
                              p_.rotor.thrust_coefficient_Ns2 * w * w + k * u.z());
      force += f;
      torque += hubs_[i].cross(f);
      torque.z() -= spin[i] * (p_.rotor.torque_coefficient_Nms2 * w * w +
                               p_.rotor.inertia_kgm2 * d.rotors[i]);
      h += spin[i] * p_.rotor.inertia_kgm2 * w;
    }
    force += 0.5 * 1.225 * p_.body_drag_area_m2 * air.norm() * air;
    const Eigen::Vector3d momentum = p_.inertia_kgm2.cwiseProduct(x.w) + Eigen::Vector3d(0, 0, h);
    d.p = x.v;
    d.v = R * force / p_.mass_kg - Eigen::Vector3d(0, 0, g);
    d.w = (torque - x.w.cross(momentum)).cwiseQuotient(p_.inertia_kgm2);
    const Eigen::Quaterniond w(0.0, x.w.x(), x.w.y(), x.w.z());
    d.q.coeffs() = 0.5 * (x.q * w).coeffs();
    return d;
  }

  ReferenceState run(ReferenceState x, double time_s, int steps) const {
    const double dt = time_s / steps;
    for (int i = 0; i < steps; ++i) {
      const ReferenceState k1 = rate(x), k2 = rate(x.plus(0.5 * dt, k1));
      const ReferenceState k3 = rate(x.plus(0.5 * dt, k2)), k4 = rate(x.plus(dt, k3));
      x = x.plus(dt / 6.0, k1).plus(dt / 3.0, k2).plus(dt / 3.0, k3).plus(dt / 6.0, k4);
      x.q.normalize();
    }
    return x;
  }

 private:
  QuadrotorParams p_;
  Eigen::Vector4d wanted_;
  std::array<Eigen::Vector3d, 4> hubs_;
};

}  // namespace vinerow::vehicles::test
