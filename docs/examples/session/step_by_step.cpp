/// Drives a rover from outside: straight on, and slower after it has gone two metres.

#include <vinerow/session.h>

#include <cstdio>

int main(int, char** arguments) {
  using namespace vinerow;
  Session session = open_session(
      arguments[1], {}, SessionOptions().take_over<NamedValues>("rover/actuators"));
  const SignalView<Odometry> truth = session.signal<Odometry>("rover/truth");
  NamedValues wheels{{"wheel_fl_speed_radps", "wheel_fr_speed_radps", "wheel_rl_speed_radps",
                      "wheel_rr_speed_radps"},
                     {4, 4, 4, 4}};
  session.advance(Time{});
  const Eigen::Vector3d start_W = truth.value().X_WB.p;
  while (!session.over()) {
    if ((truth.value().X_WB.p - start_W).norm() > 2.0) wheels.values.assign(4, 2.0);
    session.command("rover/actuators", session.now(), wheels);
    session.advance_for(Duration{50'000'000});
  }
  const double driven_m = session.metrics().at("rover").at("distance_m");
  std::printf("drove %.2f m, digest %s\n", driven_m, session.digest().c_str());
}
