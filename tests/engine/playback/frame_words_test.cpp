#include "engine/playback/frame_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vinerow::playback::frame_words_test {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::string title(const std::string& name, const std::string& description) {
  scenario::Scenario scenario;
  scenario.name = name;
  scenario.description = description;
  return picture_title(scenario);
}

TEST(FrameWords, TheTitleIsWhatTheDescriptionSaysFirst) {
  EXPECT_EQ(title("x", "A rover turns on wet soil"), "A rover turns on wet soil");
  EXPECT_EQ(title("x", "a rover turns. It does so twice."), "A rover turns");
  EXPECT_EQ(title("x", "Paper C in open loop - five estimators side by side"),
            "Paper C in open loop");
  EXPECT_EQ(title("x", "An old map: vines that it lacks\nand more"), "An old map");
}

TEST(FrameWords, ATitleTooLongForAPictureGivesWayToTheNameInWords) {
  const std::string longer =
      "A fixed wing surveys a small vineyard; its pictures become a map; on it a quadrotor scouts";
  EXPECT_EQ(title("cooperative_small", longer), "Cooperative small");
  EXPECT_EQ(title("cooperative_small", ""), "Cooperative small");
  EXPECT_EQ(title("", ""), "");
}

TEST(FrameWords, TheClockDoesNotRoundUpToSixtySeconds) {
  EXPECT_EQ(clock_text(Time{}), "00:00.0");
  EXPECT_EQ(clock_text(Time{59'960'000'000}), "00:59.9");
  EXPECT_EQ(clock_text(Time{333'202'500'000}), "05:33.2");
  EXPECT_EQ(clock_text(Time{6'000'000'000'000}), "100:00.0");
}

TEST(FrameWords, PhasesThatRunAreNamedInTheScenariosOrder) {
  scenario::Scenario scenario;
  for (const char* name : {"survey", "build_map", "spray"}) {
    scenario.phases.emplace_back().name = name;
  }
  const std::map<std::string, PhaseSpan> spans = {{"spray", {Time{10}, std::nullopt}},
                                                  {"build_map", {Time{10}, Time{20}}}};
  EXPECT_THAT(phases_at(scenario, spans, Time{15}), ElementsAre("build map", "spray"));
  EXPECT_THAT(phases_at(scenario, spans, Time{25}), ElementsAre("spray"));
  EXPECT_THAT(phases_at(scenario, spans, Time{5}), IsEmpty());
}

TEST(FrameWords, WhatAFrameShowsIsReadAsItWasWritten) {
  const std::map<std::string, double> shares = {{"drone", 0.00125}, {"rover", 0.25}};
  EXPECT_EQ(parse_seen(seen_text(shares)), shares);
  EXPECT_THAT(parse_seen(""), IsEmpty());
  EXPECT_THAT(parse_seen("rover much"), IsEmpty()) << "written by others";
}

}  // namespace
}  // namespace vinerow::playback::frame_words_test
