// Prints the tables of docs/papers/localisation.md: localisation_study [seeds [table ...]]

#include <fmt/format.h>

#include <cstdlib>
#include <numbers>

#include "tests/controllers/estimation/row_localisation/localisation_lab.h"
#include "tests/controllers/estimation/row_localisation/map_localisation_lab.h"

namespace vinerow::test {
namespace {

constexpr double kDeg = std::numbers::pi / 180.0;
using Params = controllers::DistanceFilterParams;

int seeds = 60;

void print(const std::string& name, const LabScore& score) {
  fmt::print(
      "{:<44} lat {:.4f}  lon {:.4f}  nees {:6.2f}  cov {:.3f}  set {:.4f}  mean {:+.3f} {:+.3f}  "
      "lost {}/{}\n",
      name, score.lateral_m, score.longitudinal_m, score.nees, score.coverage, score.containment,
      score.lateral_mean_m, score.longitudinal_mean_m, score.lost, score.seeds);
  std::fflush(stdout);
}

void run(const std::string& name, const LabSetup& setup, const Params& params, bool has_map = true,
         const std::function<bool(const LabSample&)>& counts = {}) {
  print(name, study(setup, seeds, distance_filter(params, has_map), counts));
}

Params with(controllers::InertialReading reading, controllers::DistanceFusion fusion,
            double k = 3.0) {
  Params params = reading_params(reading);
  params.fusion = fusion;
  params.set_scale = k;
  return params;
}

constexpr auto kR1 = controllers::InertialReading::kPositionFix;
constexpr auto kR2 = controllers::InertialReading::kRandomWalk;
constexpr auto kR3 = controllers::InertialReading::kVelocity;

/// Assumptions about the world that the reference does not state, and their effect.
void assumptions() {
  const Params ekf = with(kR3, controllers::DistanceFusion::kRangeEkf);
  run("as it is", {}, ekf);
  LabSetup setup;
  setup.height_std_m = 0.0;
  run("no height told", setup, ekf);
  setup = {};
  setup.world.symmetric = false;
  run("the sides of a row differ", setup, ekf);
  for (const double yaw : {0.3, 1.0}) {
    setup = {};
    setup.yaw_radps = yaw;
    run(fmt::format("yaw wanders at {} rad/s", yaw), setup, ekf);
  }
}

/// Section 2 of the reference: four sensors, R3.
void modes() {
  const LabSetup setup;
  run("no map", setup, with(kR3, controllers::DistanceFusion::kRangeEkf), false);
  for (const double k : {1.0, 3.0}) {
    run(fmt::format("replace k={}", k), setup, with(kR3, controllers::DistanceFusion::kReplace, k));
  }
  for (const double k : {1.0, 3.0}) {
    run(fmt::format("joint k={}", k), setup, with(kR3, controllers::DistanceFusion::kJoint, k));
  }
  for (const double k : {1.0, 3.0}) {
    Params params = with(kR3, controllers::DistanceFusion::kJoint, k);
    params.printed_square_root = true;
    run(fmt::format("joint, printed root k={}", k), setup, params);
  }
  run("increment_matrix k=3", setup, with(kR3, controllers::DistanceFusion::kIncrementMatrix));
  run("increment k=3", setup, with(kR3, controllers::DistanceFusion::kIncrement));
  run("scalar", setup, with(kR3, controllers::DistanceFusion::kScalar));
  run("truncated", setup, with(kR3, controllers::DistanceFusion::kTruncated));
  run("range_ekf", setup, with(kR3, controllers::DistanceFusion::kRangeEkf));
  Params white = with(kR3, controllers::DistanceFusion::kRangeEkf);
  white.inflation = 1.0;
  run("range_ekf r=1", setup, white);
}

void readings() {
  const LabSetup setup;
  run("no map R1", setup, with(kR1, controllers::DistanceFusion::kRangeEkf), false);
  run("no map R2", setup, with(kR2, controllers::DistanceFusion::kRangeEkf), false);
  run("no map R3", setup, with(kR3, controllers::DistanceFusion::kRangeEkf), false);
  run("R1 range_ekf", setup, with(kR1, controllers::DistanceFusion::kRangeEkf));
  for (const double k : {3.0, 1.0}) {
    run(fmt::format("R1 joint k={}", k), setup, with(kR1, controllers::DistanceFusion::kJoint, k));
  }
  run("R1 replace k=3", setup, with(kR1, controllers::DistanceFusion::kReplace));
  run("R1 increment k=3", setup, with(kR1, controllers::DistanceFusion::kIncrement));
  for (const double k : {1.0, 3.0}) {
    Params params = with(kR1, controllers::DistanceFusion::kJoint, k);
    params.printed_square_root = true;
    run(fmt::format("R1 joint, printed root k={}", k), setup, params);
  }
  Params closest = with(kR1, controllers::DistanceFusion::kJoint);
  closest.association = controllers::EchoAssociation::kClosestSegment;
  run("R1 joint k=3, closest segment", setup, closest);
}

const std::vector<std::pair<std::string, std::vector<double>>> kLayouts = {
    {"1 at 45", {-45}},
    {"2 at 90", {90, -90}},
    {"2 at 45", {45, -45}},
    {"4 at X", {45, 135, -135, -45}},
    {"4 at +", {0, 90, 180, -90}},
    {"8, arms +-15", {30, 60, 120, 150, -30, -60, -120, -150}}};

LabSetup with_layout(LabSetup setup, const std::vector<double>& angles_deg) {
  setup.sensor_angles_rad.clear();
  for (const double a : angles_deg) setup.sensor_angles_rad.push_back(a * kDeg);
  return setup;
}

void sensors() {
  LabSetup fit;
  fit.world.wall_std_m = 0.15;
  fit.world.surface_std_m = 0.01;
  for (const double k : {1.0, 2.0, 3.0}) {
    for (const auto& [name, angles] : kLayouts) {
      run(fmt::format("R1 fit, joint_each k={}, {}", k, name), with_layout(fit, angles),
          with(kR1, controllers::DistanceFusion::kJointEach, k));
    }
  }
  run("R1 fit, no map", fit, with(kR1, controllers::DistanceFusion::kRangeEkf), false);
  run("R1 fit, range_ekf, 4 at X", fit, with(kR1, controllers::DistanceFusion::kRangeEkf));
  run("R3 fit, range_ekf, 4 at X", fit, with(kR3, controllers::DistanceFusion::kRangeEkf));
  for (const auto& [name, angles] : kLayouts) {
    run("R3 nominal, range_ekf, " + name, with_layout({}, angles),
        with(kR3, controllers::DistanceFusion::kRangeEkf));
  }
}

void world() {
  for (const double wall : {0.0, 0.07, 0.15}) {
    LabSetup setup;
    setup.world.wall_std_m = wall;
    run(fmt::format("sigma_v {}", wall), setup, with(kR3, controllers::DistanceFusion::kRangeEkf));
  }
  for (const double surface : {0.01, 0.03, 0.05, 0.10}) {
    LabSetup setup;
    setup.world.surface_std_m = surface;
    run(fmt::format("sigma_m {}", surface), setup,
        with(kR3, controllers::DistanceFusion::kRangeEkf));
  }
  LabSetup unknown;
  unknown.world.surface_std_m = 0.10;
  unknown.world.stated_surface_std_m = 0.03;
  run("sigma_m 0.1, stated 0.03", unknown, with(kR3, controllers::DistanceFusion::kRangeEkf));
  for (const double speed : {0.75, 1.5, 3.0, 10.0}) {
    LabSetup setup;
    setup.speed_mps = speed;
    setup.world.length_m = 20.0 + 60.0 * speed + 10.0;
    run(fmt::format("speed {}", speed), setup, with(kR3, controllers::DistanceFusion::kRangeEkf));
  }
}

void echoes() {
  const Params ekf = with(kR3, controllers::DistanceFusion::kRangeEkf);
  Params closest = ekf;
  closest.association = controllers::EchoAssociation::kClosestSegment;
  run("closest segment", {}, closest);
  LabSetup cone;
  cone.cone_rad = 15 * kDeg;
  run("cone, ray model, 1 at 45", with_layout(cone, {-45}), ekf);
  run("cone, ray model, 2 at 90", with_layout(cone, {90, -90}), ekf);
  run("cone, ray model, 4 at X", cone, ekf);
  cone.filter_fan_rays = 7;
  run("cone, fan of 7, 4 at X", cone, ekf);
  LabSetup missed;
  missed.missed_share = 0.3;
  run("missed 30 %", missed, ekf);
  Params huber = ekf, open = ekf;
  huber.huber_sigma = 1.5;
  open.gate_sigma = 0.0;
  for (const double share : {0.05, 0.20}) {
    LabSetup setup;
    setup.false_share = share;
    run(fmt::format("false {}, gate", share), setup, ekf);
    run(fmt::format("false {}, gate + Huber", share), setup, huber);
    run(fmt::format("false {}, no gate", share), setup, open);
    run(fmt::format("false {}, joint k=3", share), setup,
        with(kR3, controllers::DistanceFusion::kJoint));
  }
  LabSetup yaw;
  yaw.heading_std_rad = 2 * kDeg;
  run("yaw error 2 deg", yaw, ekf);
  for (const double start : {0.26, 0.5, 1.0}) {
    LabSetup setup;
    setup.start_std_m = start;
    run(fmt::format("start {} m", start), setup, ekf);
  }
  LabSetup all = cone;
  all.missed_share = 0.3;
  all.false_share = 0.2;
  all.fix_time_s = 60.0;
  all.fix_age = 20;
  run("all together, gate", all, ekf);
  Params wary = huber;
  wary.fix_inflation = 600.0;
  run("all together, gate + Huber, fixes x 600", all, wary);
}

void latency() {
  const Params ekf = with(kR3, controllers::DistanceFusion::kRangeEkf);
  for (const bool has_stamps : {false, true}) {
    const std::string how = has_stamps ? "with stamps" : "without stamps";
    for (const int age : {3, 5}) {
      LabSetup setup;
      setup.range_age = age;
      setup.has_stamps = has_stamps;
      run(fmt::format("echoes {} ms late, {}", 10 * age, how), setup, ekf);
      setup.speed_mps = 10.0;
      setup.world.length_m = 640.0;
      run(fmt::format("echoes {} ms late at 10 m/s, {}", 10 * age, how), setup, ekf);
    }
    LabSetup setup;
    setup.fix_age = 20;
    setup.has_stamps = has_stamps;
    run("fixes 0.2 s late, no map, " + how, setup, ekf, false);
    run("fixes 0.2 s late, " + how, setup, ekf);
  }
  LabSetup turn;
  turn.in_turn = true;
  run("sensors fired in turn", turn, ekf);
  LabSetup slow;
  slow.fix_time_s = 60.0;
  run("fixes correlated 60 s, no map", slow, ekf, false);
  run("fixes correlated 60 s", slow, ekf);
  Params wary = ekf;
  wary.fix_inflation = 600.0;
  run("fixes correlated 60 s, variance x 600", slow, wary);
}

/// Windows behind which the vehicle passes gaps: -2 .. +3 m about the first end.
std::vector<double> gap_places() {
  return {12, 25, 38, 51, 64, 77};
}
std::vector<Gap> make_gaps() {
  std::vector<Gap> gaps;
  for (const double s : gap_places()) {
    gaps.push_back({static_cast<int>(gaps.size() % 2) + 1, s, s + 1.0});
  }
  return gaps;
}
bool is_near_gap(const LabSample& sample) {
  for (const double s : gap_places()) {
    if (sample.s_m > s - 2.0 && sample.s_m < s + 3.0) return true;
  }
  return false;
}

void robustness() {
  const Params ekf = with(kR3, controllers::DistanceFusion::kRangeEkf);
  const Params increment = with(kR3, controllers::DistanceFusion::kIncrement);
  const Params joint = with(kR3, controllers::DistanceFusion::kJoint);
  Params open = ekf;
  open.gate_sigma = 0.0;
  LabSetup outage;
  outage.outage_from_s = 30.0;
  outage.outage_to_s = 40.0;
  const auto inside = [](const LabSample& b) { return b.time_s >= 30.0 && b.time_s < 40.0; };
  run("outage, no map", outage, ekf, false, inside);
  run("outage, range_ekf", outage, ekf, true, inside);
  run("outage, increment", outage, increment, true, inside);
  run("outage, joint", outage, joint, true, inside);
  run("outage, range_ekf, 1 sensor", with_layout(outage, {-45}), ekf, true, inside);
  for (const int where : {0, 1, 2}) {
    LabSetup setup;
    if (where != 1) setup.world.true_gaps = make_gaps();
    if (where != 0) setup.world.map_gaps = make_gaps();
    const std::string name = where == 0   ? "gap in truth"
                             : where == 1 ? "gap in map"
                                          : "gap in both";
    run(name + ", range_ekf", setup, ekf, true, is_near_gap);
    run(name + ", increment", setup, increment, true, is_near_gap);
    run(name + ", joint", setup, joint, true, is_near_gap);
    run(name + ", range_ekf without gate", setup, open, true, is_near_gap);
  }
  LabSetup bias;
  for (const auto& [name, offset] :
       {std::pair<std::string, Eigen::Vector3d>{"lateral", {0.025, 0.0433013, 0}},
        {"longitudinal", {0.0433013, -0.025, 0}},
        {"vertical", {0, 0, 0.05}}}) {
    bias.world.map_offset_W = offset;
    run("map bias 5 cm " + name, bias, ekf);
  }
}

/// The filter of ours on the same flights.
void better() {
  const auto print_row = [](const std::string& name, const LabSetup& setup,
                            const controllers::MapLocalisationParams& params = {},
                            bool on_map = false,
                            const std::function<bool(const LabSample&)>& counts = {}) {
    print(name, study(setup, seeds, map_localisation(params, on_map), counts));
  };
  print_row("nominal", {});
  LabSetup setup;
  setup.height_std_m = 0.0;
  print_row("no height told", setup);
  setup = {};
  setup.cone_rad = 15.0 * kDeg;
  setup.filter_fan_rays = 7;
  print_row("cone", setup);
  LabSetup hard = setup;
  hard.missed_share = 0.3;
  hard.false_share = 0.2;
  hard.fix_time_s = 60.0;
  hard.fix_age = 20;
  setup = {};
  setup.false_share = 0.2;
  print_row("false 20 %", setup);
  print_row("cone, missed, false, correlated and late fixes", hard);
  setup = {};
  setup.outage_from_s = 30.0;
  setup.outage_to_s = 40.0;
  print_row("outage", setup, {}, false,
            [](const LabSample& b) { return b.time_s >= 30.0 && b.time_s < 40.0; });
  for (const bool in_truth : {true, false}) {
    setup = {};
    (in_truth ? setup.world.true_gaps : setup.world.map_gaps) = make_gaps();
    print_row(in_truth ? "gaps in truth" : "gaps in the map", setup);
  }
  setup = {};
  setup.world.map_offset_W = {0.025, 0.0433013, 0};
  controllers::MapLocalisationParams shifted;
  shifted.map_shift_std_m = 0.05;
  print_row("map bias 5 cm, its shift a state", setup, shifted);
  print_row("the same, place on the map", setup, shifted, true);
  print_row("no bias, its shift a state", {}, shifted);
  for (const double fix_time_s : {0.0, 60.0}) {
    int wrong = 0, all = 0;
    for (const int alleys_off : {-1, 0, 1}) {
      setup = {};
      setup.start_std_m = 1.0;
      setup.start_vertical_std_m = 0.1;
      setup.duration_s = 23.0;
      setup.start_alleys_off = alleys_off;
      setup.fix_time_s = fix_time_s;
      for (int seed = 1; seed <= 100; ++seed, ++all) {
        double worst_m = 0.0;
        for (const LabSample& sample : fly(setup, seed, map_localisation()).samples) {
          if (sample.time_s >= 20.0) worst_m = std::max(worst_m, std::abs(sample.lateral_m));
        }
        wrong += worst_m >= 1.0;
      }
    }
    fmt::print("start 1 m, fixes correlated {} s: wrong alley {} of {}\n", fix_time_s, wrong, all);
  }
}

int main_study(int argc, char** argv) {
  const std::vector<std::pair<std::string, void (*)()>> tables = {
      {"assumptions", assumptions}, {"modes", modes},           {"readings", readings},
      {"sensors", sensors},         {"world", world},           {"echoes", echoes},
      {"latency", latency},         {"robustness", robustness}, {"better", better}};
  if (argc > 1) seeds = std::atoi(argv[1]);
  for (const auto& [name, print_table] : tables) {
    bool wanted = argc <= 2;
    for (int i = 2; i < argc; ++i) wanted |= name == argv[i];
    if (!wanted) continue;
    fmt::print("\n## {}\n", name);
    print_table();
  }
  return 0;
}

}  // namespace
}  // namespace vinerow::test

int main(int argc, char** argv) {
  return vinerow::test::main_study(argc, argv);
}
