/// Moments of a mission: who is at work when pictures are drawn, from the states that a log holds.

#include "engine/playback/phase_moments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vinerow::playback::phase_moments_test {
namespace {

using ::testing::ElementsAre;

Time at_s(double s) {
  return Time{} + duration_from_s(s);
}

/// A plane's survey from 9 to 100 s, a rover's work from 100 s to the log's end, and a phase that
/// never began.
class PhaseMoments : public ::testing::Test {
 protected:
  PhaseMoments() {
    add_phase("survey", "plane"), add_phase("spray", "rover"), add_phase("mow", "plane");
    scenario_.pictures.moments = {{"survey", 60.0, {}}, {"spray", 5.0, {}}, {"mow", 1.0, {}}};
    spans_["survey"] = {at_s(9.0), at_s(100.0)};
    spans_["spray"] = {at_s(100.0), std::nullopt};
  }
  void add_phase(const char* name, const char* vehicle) {
    scenario::PhaseConfig phase;
    phase.name = name;
    phase.vehicles = {vehicle};
    scenario_.phases.push_back(phase);
  }
  std::set<Time> times(scenario::CameraKind kind, const char* vehicle) const {
    scenario::CameraConfig camera;
    camera.kind = kind;
    camera.vehicle = vehicle;
    return moment_times(scenario_, camera, spans_);
  }

  scenario::Scenario scenario_;
  std::map<std::string, PhaseSpan> spans_;
};

TEST_F(PhaseMoments, AreThoseOfEveryPhaseThatBegan) {
  EXPECT_THAT(times(scenario::CameraKind::kFixed, ""), ElementsAre(at_s(69.0), at_s(105.0)));
  EXPECT_THAT(times(scenario::CameraKind::kTop, "rover"), ElementsAre(at_s(69.0), at_s(105.0)))
      << "the picture is of the place";
}

TEST_F(PhaseMoments, FollowNobodyWhoStandsParked) {
  EXPECT_THAT(times(scenario::CameraKind::kChase, "plane"), ElementsAre(at_s(69.0)));
  EXPECT_THAT(times(scenario::CameraKind::kChase, "rover"), ElementsAre(at_s(105.0)));
  EXPECT_THAT(times(scenario::CameraKind::kOnBoard, "rover"), ElementsAre(at_s(105.0)));
  EXPECT_EQ(times(scenario::CameraKind::kChase, "trailer").size(), 0u) << "it never works";
}

}  // namespace
}  // namespace vinerow::playback::phase_moments_test
