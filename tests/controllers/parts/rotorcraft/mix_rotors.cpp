// Mixes random wrenches for several vehicles and prints vehicle, wanted and made, for a check by
// another program (rotor_mixer_check.py).

#include <cmath>
#include <cstdio>

#include "controllers/parts/rotorcraft/rotor_mixer.h"
#include "engine/core/random.h"
#include "tests/controllers/support/quadrotor_sim.h"

using namespace vinerow;
using test::QuadrotorNumbers;

int main() {
  QuadrotorNumbers odd = test::make_q4t();  // centre of mass off the middle, rotors never at rest
  odd.rotors[0].x_m += 0.04;
  odd.rotors[2].y_m -= 0.03;
  odd.min_radps = 60.0;
  QuadrotorNumbers six = test::make_q4t();
  six.rotors.clear();
  for (int i = 0; i < 6; ++i) {
    const double angle = 0.3 + i * 3.14159265358979323846 / 3.0;
    six.rotors.push_back({0.4 * std::cos(angle), 0.4 * std::sin(angle), i % 2 == 0 ? 1.0 : -1.0});
  }
  RandomStream random(1, "test", "mixer");
  for (const QuadrotorNumbers& numbers :
       {test::make_q4t(), test::with_plus_layout(test::make_q4t()), test::make_m100(), odd, six}) {
    const controllers::RotorcraftModel craft =
        controllers::read_rotorcraft(test::describe(numbers), 9.80665, "test");
    controllers::RotorMixer mixer(craft, "test");
    std::vector<double> speeds(craft.rotors.size());
    std::printf("vehicle %zu %.17g %.17g %.17g %.17g\n", craft.rotors.size(),
                craft.thrust_coefficient_Ns2, craft.torque_coefficient_Nms2, craft.min_rotor_radps,
                craft.max_rotor_radps);
    for (const RotorPlace& rotor : craft.rotors) {
      std::printf("%.17g %.17g %.17g\n", rotor.p_B.x(), rotor.p_B.y(), rotor.torque_sign);
    }
    constexpr int kCases = 200;
    std::printf("cases %d\n", kCases);
    for (int i = 0; i < kCases; ++i) {
      // From gentle to far beyond the limits.
      const double size = std::pow(10.0, random.uniform(-1.5, 0.5));
      controllers::Wrench wanted;
      wanted.thrust_N = craft.max_thrust_N() * random.uniform(-0.1, 1.2);
      wanted.torque_B = {10.0 * size * random.normal(), 10.0 * size * random.normal(),
                         size * random.normal()};
      mixer.mix(wanted, speeds);
      std::printf("%.17g %.17g %.17g %.17g", wanted.thrust_N, wanted.torque_B.x(),
                  wanted.torque_B.y(), wanted.torque_B.z());
      for (const double speed : speeds) std::printf(" %.17g", speed);
      std::printf("\n");
    }
  }
}
