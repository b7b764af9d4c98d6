/// One suite for every registered payload.

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <tuple>

#include "engine/core/hash.h"
#include "tests/support/no_alloc.h"
#include "tests/vehicles/payloads/payload_rig.h"

namespace vinerow::vehicles::payloads_conformance_test {
namespace {

using namespace test;

WorldModel windy_rows() {
  WorldModel world = make_box_rows({{.y_m = 1.25}, {.y_m = -1.25}, {.y_m = 3.75}});
  world.wind.mean_speed_mps = 3.0;
  world.wind.turbulence = 1.0;
  world.wind.shelter_attenuation = 1.2;
  return world;
}

class PayloadConformance : public ::testing::TestWithParam<std::string> {
 protected:
  const PartSpec& spec() const { return vehicle_registry().spec(PartKind::kPayload, GetParam()); }
};

/// Hash of all its outputs, at every tick and at the end.
std::string digest_of(const std::string& type, std::uint64_t seed) {
  PayloadRig rig(type, windy_rows(), {}, seed);
  Hasher hasher;
  for (double x = -1.0; x < 12.0; x += rig.period.s()) {
    rig.tick(x, 0.1, 0.0, 1.0);
    rig.bus.find("rover/p")->hash_into(hasher);
  }
  for (const CanopyPatch& patch : rig.patches()) hasher.add(patch.amount);
  for (const auto& [name, value] : rig.payload->results()) hasher.add(value);
  return hasher.hex();
}

TEST_P(PayloadConformance, SameSeedSameBits) {
  EXPECT_EQ(digest_of(GetParam(), 1), digest_of(GetParam(), 1));
  // A camera's rays are fixed; droplets are drawn.
  EXPECT_EQ(digest_of(GetParam(), 1) != digest_of(GetParam(), 2), GetParam() == "sprayer");
}

TEST_P(PayloadConformance, ReadsAndWritesWhatItSays) {
  PayloadRig rig(GetParam(), windy_rows());
  const auto is_declared = [](const std::vector<std::string>& declared, const std::string& name) {
    return std::any_of(declared.begin(), declared.end(),
                       [&](const std::string& d) { return d.find(name) != std::string::npos; });
  };
  int written = 0;
  for (const auto& signal : rig.bus.signals()) {
    const std::string local = signal->name().substr(signal->name().find('/') + 1);
    if (signal->first_reader() == "rover.p") {
      EXPECT_TRUE(is_declared(spec().reads, local)) << signal->name();
    }
    if (signal->writer() == "rover.p") {
      ++written;
      EXPECT_TRUE(local == "p" || local == "p_event") << signal->name();
      EXPECT_TRUE(is_declared(spec().writes, local == "p" ? "<name>" : "<name>_event"));
    }
  }
  EXPECT_GE(written, 1);
}

TEST_P(PayloadConformance, TellsWhatItIs) {
  EXPECT_GT(spec().default_rate_Hz, 0.0);
  EXPECT_GT(spec().description.size(), 20u);
  std::set<std::string> names;
  for (const ParameterSpec& parameter : spec().parameters) {
    EXPECT_TRUE(names.insert(parameter.name).second) << parameter.name;
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
  }
}

TEST_P(PayloadConformance, AStepAllocatesNothingAndWritesNoNan) {
  PayloadRig rig(GetParam(), windy_rows());
  rig.pass(-1.0, 2.0, 0.1, 1.0);  // signals get their memory with the first values
  const vinerow::test::AllocationCounter counter;
  rig.pass(2.0, 16.0, 0.1, 1.0);
  EXPECT_EQ(counter.count(), 0u);
  EXPECT_FALSE(rig.bus.find("rover/p")->has_nan());
}

TEST_P(PayloadConformance, WithoutAnyEstimateItWaits) {
  PayloadRig rig(GetParam(), windy_rows());
  for (int i = 0; i < 5; ++i) {
    rig.payload->step(rig.now);
    rig.now = rig.now + rig.period;
  }
  for (const CanopyPatch& patch : rig.patches()) EXPECT_EQ(patch.amount, 0.0);
  for (const auto& [name, value] : rig.payload->results()) {
    EXPECT_FALSE(std::isinf(value)) << name;
  }
}

TEST_P(PayloadConformance, DoesSomethingToTheCanopyAndTellsItTwiceTheSame) {
  PayloadRig rig(GetParam(), windy_rows());
  rig.pass(-1.0, 21.0, 0.0, 1.0);
  const CanopyCoverage* coverage = rig.payload->coverage();
  ASSERT_NE(coverage, nullptr);
  EXPECT_FALSE(coverage->quantity.empty());
  EXPECT_FALSE(coverage->unit.empty());
  EXPECT_GT(coverage->wanted, 0.0);
  EXPECT_GT(coverage->step_m, 0.0);
  EXPECT_GT(coverage->band_m, 0.0);
  double area_m2 = 0.0, amount = 0.0;
  using Key = std::tuple<int, int, int, int>;
  Key last{-1, 0, 0, 0};
  for (const CanopyPatch& patch : coverage->patches) {
    const Key key{patch.row, -patch.side, patch.along, patch.band};
    EXPECT_LT(last, key);
    last = key;
    EXPECT_GT(patch.area_m2, 0.0);
    EXPECT_GE(patch.amount, 0.0);
    EXPECT_TRUE(std::isfinite(patch.amount));
    EXPECT_TRUE(patch.p_W.allFinite());
    area_m2 += patch.area_m2;
    amount += patch.amount;
  }
  EXPECT_GT(amount, 0.0);
  double expected_m2 = 0.0;
  for (const MeshInstance& instance : rig.world.meshes) expected_m2 += area_of(instance);
  EXPECT_NEAR(area_m2, expected_m2, 1e-9 * expected_m2);
  const auto once = rig.payload->results(), again = rig.payload->results();
  EXPECT_EQ(once, again);
  for (const auto& [name, value] : once) {
    EXPECT_TRUE(std::isfinite(value)) << name;
    // Shares are shares.
    if (name.find("_share") != std::string::npos) {
      EXPECT_GE(value, 0.0) << name;
      EXPECT_LE(value, 1.0 + 1e-12) << name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, PayloadConformance,
                         ::testing::ValuesIn(vehicle_registry().names(PartKind::kPayload)),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace vinerow::vehicles::payloads_conformance_test
