#pragma once
/// A message of somebody else's plug-in.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/api/message.h"
#include "engine/math/pose.h"

namespace vinerow::test {

struct Layer {
  static constexpr const char* kType = "Layer";
  double depth_m = 0.0;
  float moisture = 0.0f;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"depth", "m"}, self.depth_m);
    f({"moisture", "", "share of the pores that hold water"}, self.moisture);
  }
};

struct SoilSample {
  static constexpr const char* kType = "acme/SoilSample";
  static constexpr MessageFrame kFrame = MessageFrame::kWorld;
  enum class State : std::uint16_t { kDry = 1, kWet = 7 };
  bool taken = false;
  State state = State::kDry;
  Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
  std::vector<Layer> layers;
  std::vector<std::int16_t> raw;
  std::array<std::uint32_t, 3> counts{};
  std::string place;
  Pose X_WP;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"taken"}, self.taken);
    f({"state"}, self.state);
    f({"position", "m"}, self.p_W);
    f({"layers"}, self.layers);
    f({"raw"}, self.raw);
    f({"counts"}, self.counts);
    f({"place"}, self.place);
    f({"probe", "", "of its tip", true}, self.X_WP);
  }
};

inline std::span<const EnumName> enum_names(SoilSample::State) {
  static constexpr EnumName kNames[] = {enum_name(SoilSample::State::kDry, "DRY"),
                                        enum_name(SoilSample::State::kWet, "WET")};
  return kNames;
}

// The same name with other fields: another plug-in's.
struct OtherSample {
  static constexpr const char* kType = "acme/SoilSample";
  double depth_m = 0.0;

  template <class Self, class F>
  static void fields(Self& self, F&& f) {
    f({"depth", "m"}, self.depth_m);
  }
};

}  // namespace vinerow::test
