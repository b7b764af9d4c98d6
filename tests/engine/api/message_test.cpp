/// Messages describe themselves: names, units, digest and views of every shipped message, and of
/// one that is not ours.

#include "engine/api/message.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "engine/api/messages.h"
#include "engine/api/signal.h"
#include "engine/core/error.h"
#include "tests/support/soil_sample.h"

namespace vinerow::message_test {

namespace {

using test::OtherSample;
using test::SoilSample;

/// Names and units of a message and of the records inside it.
class ListFields final : public FieldVisitor {
 public:
  void field(const FieldView& view) override {
    names.push_back(std::string(view.info.name));
    units.insert(std::string(view.info.unit));
    std::set<std::string> values;
    for (const EnumName& name : view.names) {
      EXPECT_TRUE(std::regex_match(std::string(name.name), std::regex("[A-Z][A-Z0-9_]*")));
      EXPECT_TRUE(values.insert(std::string(name.name)).second) << name.name;
    }
    if (view.visit_record == nullptr) return;
    inside.emplace_back();
    view.visit_record(nullptr, inside.back());
  }
  std::vector<std::string> names;
  std::set<std::string> units;
  std::vector<ListFields> inside;
};

void expect_good_names(const ListFields& list, const std::string& message) {
  // SI, in the spelling of ParameterSpec::unit, and pixels.
  const std::set<std::string> known = {"",  "m",  "m/s", "m/s^2", "m^2", "rad", "rad/s", "1/m",
                                       "s", "Pa", "T",   "W",     "J",   "px",  "px m"};
  for (const std::string& unit : list.units) EXPECT_TRUE(known.contains(unit)) << message << unit;
  const std::regex ros_name("[a-z]([a-z0-9]|_(?=[a-z0-9]))*");
  std::set<std::string> names;
  for (const std::string& name : list.names) {
    EXPECT_TRUE(std::regex_match(name, ros_name)) << message << " " << name;
    EXPECT_TRUE(names.insert(name).second) << message << " has two fields " << name;
    // Logs put these two before what a message lists.
    EXPECT_NE(name, "header") << message;
    EXPECT_NE(name, "body") << message;
  }
  for (const ListFields& inside : list.inside) expect_good_names(inside, message);
}

TEST(Message, EveryShippedOneHasFieldsWithNamesOfTheirOwnAndKnownUnits) {
  std::set<std::string> types;
  for_each_message_type([&]<class T>(T*) {
    EXPECT_TRUE(types.insert(T::kType).second) << T::kType;
    ListFields list;
    visit_fields(T{}, list);
    EXPECT_FALSE(list.names.empty()) << T::kType;
    expect_good_names(list, T::kType);
  });
  EXPECT_EQ(types.size(), 29u);
}

TEST(Message, LayoutsDiffer) {
  std::set<std::uint64_t> layouts;
  std::size_t count = 0;
  for_each_message_type([&]<class T>(T*) {
    layouts.insert(message_type<T>().layout);
    ++count;
  });
  EXPECT_EQ(layouts.size(), count);
  EXPECT_NE(message_type<SoilSample>().layout, message_type<OtherSample>().layout);
}

TEST(Message, ViewsPointIntoTheSignal) {
  SignalBus bus;
  auto out = bus.advertise<SoilSample>("rover/soil", "probe");
  SoilSample sample;
  sample.state = SoilSample::State::kWet;
  sample.layers = {{0.1, 0.3f}, {0.2, 0.4f}};
  sample.counts = {5, 7, 9};
  sample.raw = {-5, 6};
  sample.place = "row 3";
  sample.X_WP.p = {1, 2, 3};
  out.write(Time{1}, sample);

  struct Views final : FieldVisitor {
    void field(const FieldView& view) override { by_name.emplace(view.info.name, view); }
    std::map<std::string_view, FieldView> by_name;
  } views;
  const SignalBase& signal = *bus.find("rover/soil");
  signal.describe(views);
  const SoilSample& held = static_cast<const Signal<SoilSample>&>(signal).value();

  EXPECT_EQ(views.by_name.at("state").kind, FieldKind::kUint16);
  EXPECT_EQ(views.by_name.at("state").value<std::uint16_t>(), 7);
  ASSERT_EQ(views.by_name.at("state").names.size(), 2u);
  EXPECT_EQ(views.by_name.at("state").names[1].name, "WET");
  EXPECT_EQ(views.by_name.at("counts").shape, FieldShape::kArray);
  EXPECT_EQ(views.by_name.at("counts").value<std::uint32_t>(1), 7u);
  EXPECT_EQ(views.by_name.at("counts").data, held.counts.data());
  EXPECT_EQ(views.by_name.at("raw").shape, FieldShape::kSequence);
  EXPECT_EQ(views.by_name.at("raw").value<std::int16_t>(0), -5);
  EXPECT_EQ(views.by_name.at("place").value<std::string>(), "row 3");
  EXPECT_EQ(views.by_name.at("probe").value<Pose>().p, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(views.by_name.at("probe").data, &held.X_WP);

  const FieldView& layers = views.by_name.at("layers");
  EXPECT_EQ(layers.shape, FieldShape::kSequence);
  EXPECT_EQ(layers.record, "Layer");
  ASSERT_EQ(layers.count, 2u);
  Views inside;
  layers.visit_record(layers.at(1), inside);
  EXPECT_EQ(inside.by_name.at("depth").info.unit, "m");
  EXPECT_EQ(inside.by_name.at("depth").data, &held.layers[1].depth_m);
  EXPECT_EQ(inside.by_name.at("moisture").value<float>(), 0.4f);
}

TEST(Message, OfAPlugInIsHashedAndSearchedForNan) {
  const auto digest = [](const SoilSample& sample) {
    Hasher hasher;
    hash_fields(sample, hasher);
    return hasher.hex();
  };
  SoilSample a, b;
  a.layers = b.layers = {{0.1, 0.3f}};
  EXPECT_EQ(digest(a), digest(b));
  b.layers[0].moisture = std::nextafter(0.3f, 1.0f);
  EXPECT_NE(digest(a), digest(b));
  EXPECT_FALSE(has_nan_field(a));
  a.layers[0].depth_m = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(has_nan_field(a));
  a.layers[0].moisture = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(has_nan_field(a));
}

TEST(Message, TwoOfOneNameDoNotMeetOnASignal) {
  SignalBus bus;
  bus.advertise<SoilSample>("rover/soil", "rover.probe");
  try {
    bus.subscribe<OtherSample>("rover/soil", "rover.controller");
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "rover.controller takes signal 'rover/soil' as acme/SoilSample, but it is another "
                 "message of that name, with other fields");
  }
}

}  // namespace
}  // namespace vinerow::message_test
