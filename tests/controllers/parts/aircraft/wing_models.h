#pragma once
/// A small flying wing at 12 m/s, sampled at 0.05 s: models, limits, weights and gains that a
/// prototype in other code found and printed to four decimals.

#include <numbers>

#include "controllers/parts/solvers/tube_form.h"
#include "controllers/parts/solvers/tube_sets.h"

namespace vinerow::test {

inline constexpr double kDeg = std::numbers::pi / 180.0;

/// With the LQR's gain, the "relaxed" limits and gusts of 1 m/s.
struct Wing : controllers::TubeModel {
  controllers::TubeCost cost;
  Eigen::MatrixXd K_lmi;
  Eigen::VectorXd tight_states, tight_inputs;  ///< limits in the "full scale" reading

  Eigen::MatrixXd closed() const { return A + B * K; }
  controllers::Polytope constraints() const {
    return controllers::Polytope::box(state_limit)
        .intersection(controllers::Polytope::box(input_limit).linear_preimage(K));
  }
  Wing with_tight_limits() const {
    Wing wing = *this;
    wing.state_limit = tight_states;
    wing.input_limit = tight_inputs;
    return wing;
  }
  Wing with_lmi_gain() const {
    Wing wing = *this;
    wing.K = K_lmi;
    return wing;
  }
  Wing in_gusts(double gust_mps) const {
    Wing wing = *this;
    wing.gust.setConstant(gust_mps);
    return wing;
  }
};

inline Wing make_wing(int inputs, int gusts) {
  Wing wing;
  for (Eigen::MatrixXd* matrix : {&wing.A, &wing.cost.Q}) matrix->setZero(5, 5);
  wing.B.setZero(5, inputs);
  wing.E.setZero(5, gusts);
  wing.K.setZero(inputs, 5);
  wing.K_lmi = wing.K;
  wing.cost.R.setZero(inputs, inputs);
  wing.gust.setOnes(gusts);
  for (Eigen::VectorXd* limit : {&wing.state_limit, &wing.tight_states}) limit->setZero(5);
  for (Eigen::VectorXd* limit : {&wing.input_limit, &wing.tight_inputs}) limit->setZero(inputs);
  return wing;
}

/// States u m/s, w m/s, q rad/s, theta rad, h m; inputs throttle and elevator rad.
inline Wing longitudinal_wing() {
  Wing wing = make_wing(2, 2);
  // clang-format off
  wing.A << .9739,  .0496, -.0649, -.4818, 0,
           -.0215,  .6433,  .3848, -.0451, 0,
            .0614, -.3532,  .6485, -.0027, 0,
            .0016, -.0100,  .0416,  1,     0,
            .0073, -.0431,  .0023,  .5997, 1;
  wing.B << .5764, .2057, -.0082, -2.0268, .0183, -5.0291, .0003, -.1361, .0021, .0138;
  wing.E << .0261, -.0496, .0215, .3567, -.0614, .3532, -.0016, .0100, -.0009, -.0065;
  wing.K << -.1192, -.0085, .0047, -.0048, -.0243,
            -.0101, -.0418, .0597,  .7366,  .0246;
  wing.K_lmi << -.1332, -.0002, .0036, -.1387, -.0285,
                -.0097, -.0482, .0830,  .8680,  .0280;
  // clang-format on
  wing.cost.Q.diagonal() << 1 / .36, 1.0, 1 / (60 * 60 * kDeg * kDeg), 1 / (36 * kDeg * kDeg), .25;
  wing.cost.R.diagonal() << 100.0, 1 / (16 * kDeg * kDeg);
  wing.state_limit << 2.4, 3.0, 150.0 * kDeg, 20.0 * kDeg, 15.0;
  wing.input_limit << 0.25, 10.0 * kDeg;
  wing.tight_states << 1.2, 2.4, 90.0 * kDeg, 15.0 * kDeg, 15.0;
  wing.tight_inputs << 0.2, 5.0 * kDeg;
  wing.state_names = {"speed along x", "speed along z", "pitch rate", "pitch", "altitude"};
  wing.input_names = {"throttle", "elevator"};
  return wing;
}

/// States v m/s, p rad/s, r rad/s, phi rad, psi rad; input aileron rad.
inline Wing lateral_wing() {
  Wing wing = make_wing(1, 1);
  // clang-format off
  wing.A << .9398,  .0756, -.5548,  .4745, 0,
           -.4098,  .5872,  .2817, -.1097, 0,
            .0564, -.0325,  .9531,  .0132, 0,
           -.0111,  .0389,  .0127,  .9981, 0,
            .0014, -.0009,  .0494,  .0002, 1;
  wing.B << .2902, 5.2140, -.2609, .1413, -.0057;
  wing.E << .0602, .4098, -.0564, .0111, -.0014;
  wing.K << -.0290, -.0429, -.1258, -.5042, -.4278;
  wing.K_lmi << -.0932, -.0653, -.3090, -.9131, -.6794;
  // clang-format on
  wing.cost.Q.diagonal() << 1 / 2.25, 1 / (90 * 90 * kDeg * kDeg), 1 / (60 * 60 * kDeg * kDeg),
      1 / (144 * kDeg * kDeg), 1 / (64 * kDeg * kDeg);
  wing.cost.R.diagonal() << 1 / (16 * kDeg * kDeg);
  wing.state_limit << 5.0, 250.0 * kDeg, 120.0 * kDeg, 45.0 * kDeg, 30.0 * kDeg;
  wing.input_limit << 12.0 * kDeg;
  wing.tight_states << 3.0, 120.0 * kDeg, 60.0 * kDeg, 30.0 * kDeg, 18.0 * kDeg;
  wing.tight_inputs << 5.0 * kDeg;
  wing.state_names = {"sideslip speed", "roll rate", "yaw rate", "roll", "heading"};
  wing.input_names = {"aileron"};
  return wing;
}

}  // namespace vinerow::test
