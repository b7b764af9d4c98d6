#include "engine/api/parameter_table.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <filesystem>

#include "engine/core/error.h"
#include "engine/math/angles.h"

namespace vinerow::parameter_table_test {
namespace {

enum class Layout { kX, kPlus };
enum class End { kFirst, kLast };
constexpr std::array<Choice<Layout>, 2> kLayouts = {{{"x", Layout::kX}, {"plus", Layout::kPlus}}};

struct Leg {
  double stiffness_N_per_m = 5000.0;
  double damping_Ns_per_m = 50.0;
};
struct Cost {
  double weight = 0.5;
};
struct Search {
  Cost cost;
};
struct Fault {
  Layout kind = Layout::kX;
  double at_s = 0.0;
  std::optional<std::size_t> rotor;
};

struct Params {
  double mass_kg = 2.0;
  double tilt_rad = rad_from_deg(24.0);
  double curvature_per_m = 2.0;
  std::optional<double> drag_area_m2;
  int rows = 9;
  std::int64_t iterations = 500;
  bool is_on = true;
  std::string crs;
  std::filesystem::path file;
  std::vector<std::string> words = {"a"};
  Layout layout = Layout::kPlus;
  std::optional<End> first_wall;
  std::optional<Layout> spare_layout;
  Eigen::Vector3d inertia_kgm2 = {0.05, 0.05, 0.09};
  std::array<double, 2> pair_rad = {rad_from_deg(10.0), rad_from_deg(20.0)};
  std::vector<double> heights_m = {1.0, 2.0};
  std::vector<int> missing;
  std::optional<Eigen::Vector3d> antenna_m;
  double low_m = 1.0, high_m = 6.0;
  Leg leg{.stiffness_N_per_m = 7000.0};
  Leg other_leg{.stiffness_N_per_m = 8000.0};
  std::optional<Leg> spare_leg;
  Search search;
  std::vector<Fault> faults;
};

const ParameterTable<Leg>& leg_table() {
  static const ParameterTable<Leg> table =
      ParameterTable<Leg>()
          .number("stiffness_N_per_m", "N/m", &Leg::stiffness_N_per_m, kPositive, "along")
          .number("damping_Ns_per_m", "N s/m", &Leg::damping_Ns_per_m, between(0, 1e5), "of a leg")
          .rule([](const Leg& leg) -> std::string {
            return leg.damping_Ns_per_m < leg.stiffness_N_per_m ? "" : "the leg creeps";
          });
  return table;
}

const ParameterTable<Fault>& fault_table() {
  static const ParameterTable<Fault> table =
      ParameterTable<Fault>()
          .choice("kind", &Fault::kind, {{"rotor", Layout::kX}, {"battery", Layout::kPlus}}, "what")
          .required()
          .number("at_s", "s", &Fault::at_s, between(0, 1e9), "when")
          .required()
          .integer("rotor", &Fault::rotor, between(1, 4), "which", kCountedFromOne)
          .rule([](const Fault& fault) -> std::string {
            return fault.kind == Layout::kX && !fault.rotor ? "tell which 'rotor'" : "";
          });
  return table;
}

const ParameterTable<Params>& table() {
  using P = Params;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .number("mass_kg", "kg", &P::mass_kg, kPositive, "everything")
          .degrees("tilt_deg", &P::tilt_rad, between(1.0, 80.0), "in flight")
          .number("radius_m", "m", &P::curvature_per_m, above(0.0, 10.0), "of turns", kInverse)
          .number("drag_area_m2", "m2", &P::drag_area_m2, kNotNegative, "of the body")
          .integer("rows", &P::rows, between(1, 100), "rows")
          .integer("iterations", &P::iterations, between(0, 1e12), "of the search")
          .boolean("on", &P::is_on, "switch")
          .text("crs", &P::crs, "of the file")
          .path("file", &P::file, "to read")
          .may_be_missing()
          .texts("words", &P::words, "some of them")
          .one_of({"a", "b"})
          .choice("layout", &P::layout, kLayouts, "of the rotors")
          .choice("first_wall", &P::first_wall,
                  {{"auto", std::nullopt}, {"first", End::kFirst}, {"last", End::kLast}}, "walled")
          .choice("spare_layout", &P::spare_layout, kLayouts, "of one more machine")
          .numbers("inertia_kgm2", "kg m2", &P::inertia_kgm2, kPositive, "about the axes")
          .numbers("pair_deg", "deg", &P::pair_rad, between(-90, 90), "both", 0, kDegrees)
          .numbers("heights_m", "m", &P::heights_m, kAnyNumber, "of nozzles")
          .numbers("missing_rows", "", &P::missing, between(0, 1e6), "without canopy")
          .numbers("antenna_m", "m", &P::antenna_m, kAnyNumber, "in the body frame")
          .members("spacing_m", "m", between(0.1, 100), "least and largest", &P::low_m, &P::high_m)
          .include(&P::leg, leg_table(), {.prefix = "gear_"})
          .reword("gear_damping_Ns_per_m", "of a leg with its foot")
          .limit("gear_damping_Ns_per_m", between(0, 1e3))
          .include(&P::other_leg, leg_table(),
                   {.only = {"stiffness_N_per_m"}, .renamed = {{"stiffness_N_per_m", "stiff"}}})
          .group("spare_leg", &P::spare_leg, leg_table(), "one more")
          .number("weight", "", inside(&P::search, &Search::cost, &Cost::weight), kNotNegative,
                  "of clearance")
          .groups("faults", &P::faults, fault_table(), "what goes wrong")
          .rule([](const P& p) -> std::string {
            return p.low_m < p.high_m ? "" : "spacing_m must rise";
          });
  return table;
}

ParameterSet defaults() {
  return ParameterSet(table().specs(), "part");
}

const ParameterSpec& spec_of(const std::vector<ParameterSpec>& specs, const std::string& name) {
  for (const ParameterSpec& spec : specs) {
    if (spec.name == name) return spec;
  }
  throw ConfigError("no spec " + name);
}

std::string fault_of(const Params& params) {
  try {
    table().validate(params, "rover");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

std::string refusal(const ParameterSet& parameters) {
  try {
    table().read(parameters, "rover");
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ParameterTable, SpecsHaveNamesUnitsRangesWordsAndTheInitialisersAsDefaults) {
  const std::vector<ParameterSpec> specs = table().specs();
  EXPECT_EQ(specs.front().name, "mass_kg");
  EXPECT_EQ(specs.back().name, "faults");
  const ParameterSpec& mass = spec_of(specs, "mass_kg");
  EXPECT_EQ(mass.kind, ParameterKind::kNumber);
  EXPECT_EQ(mass.unit, "kg");
  EXPECT_EQ(mass.description, "everything");
  EXPECT_EQ(mass.min, 0.0);
  EXPECT_TRUE(mass.min_exclusive);
  EXPECT_TRUE(std::isinf(mass.max));
  EXPECT_EQ(std::get<double>(mass.default_value), 2.0);
  EXPECT_EQ(std::get<std::int64_t>(spec_of(specs, "rows").default_value), 9);
  EXPECT_EQ(std::get<bool>(spec_of(specs, "on").default_value), true);
  EXPECT_EQ(std::get<std::string>(spec_of(specs, "crs").default_value), "");
  EXPECT_EQ(std::get<std::string>(spec_of(specs, "layout").default_value), "plus");
  EXPECT_EQ(spec_of(specs, "layout").choices, (std::vector<std::string>{"x", "plus"}));
  EXPECT_EQ(std::get<std::string>(spec_of(specs, "first_wall").default_value), "auto");
  EXPECT_EQ(spec_of(specs, "inertia_kgm2").size, 3);
  EXPECT_EQ(std::get<std::vector<double>>(spec_of(specs, "inertia_kgm2").default_value),
            (std::vector<double>{0.05, 0.05, 0.09}));
  EXPECT_EQ(spec_of(specs, "heights_m").size, 0);
  EXPECT_EQ(spec_of(specs, "antenna_m").size, 3);
  EXPECT_EQ(std::get<std::vector<double>>(spec_of(specs, "spacing_m").default_value),
            (std::vector<double>{1.0, 6.0}));
  EXPECT_EQ(spec_of(specs, "words").choices, (std::vector<std::string>{"a", "b"}));
  EXPECT_FALSE(spec_of(specs, "file").must_exist);
  EXPECT_EQ(std::get<double>(spec_of(specs, "weight").default_value), 0.5);
}

TEST(ParameterTable, OptionalMembersPathsAndGroupsAreAbsentUnlessGiven) {
  for (const char* name :
       {"drag_area_m2", "file", "spare_layout", "antenna_m", "spare_leg", "faults"}) {
    EXPECT_TRUE(
        std::holds_alternative<std::monostate>(spec_of(table().specs(), name).default_value))
        << name;
  }
  const Params params = table().read(defaults(), "");
  EXPECT_FALSE(params.drag_area_m2 || params.spare_layout || params.antenna_m || params.spare_leg);
  ParameterSet given = defaults();
  given.set("drag_area_m2", 0.3).set("antenna_m", std::vector<double>{1, 2, 3});
  given.set("spare_layout", std::string("plus"));
  const Params filled = table().read(given, "");
  EXPECT_EQ(filled.drag_area_m2, 0.3);
  EXPECT_EQ(*filled.antenna_m, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(filled.spare_layout, Layout::kPlus);
}

TEST(ParameterTable, DegreesAreRoundInTheFileAndExactInTheMember) {
  // 24 deg to rad and back by plain factors is 24.000000000000004.
  const std::vector<ParameterSpec> specs = table().specs();
  EXPECT_EQ(std::get<double>(spec_of(specs, "tilt_deg").default_value), 24.0);
  EXPECT_EQ(std::get<double>(spec_of(specs, "radius_m").default_value), 0.5);
  EXPECT_EQ(std::get<std::vector<double>>(spec_of(specs, "pair_deg").default_value),
            (std::vector<double>{10.0, 20.0}));
  ParameterSet parameters = defaults();
  for (const double deg : {1.0, 1.5, 3.0, 12.0, 48.0, 57.0, 80.0}) {
    parameters.set("tilt_deg", deg);
    EXPECT_EQ(table().read(parameters, "").tilt_rad, rad_from_deg(deg));
  }
  parameters.set("radius_m", 4.0);
  EXPECT_EQ(table().read(parameters, "").curvature_per_m, 0.25);
}

TEST(ParameterTable, ReadsWhatIsGivenAndElseTheInitialisers) {
  const Params usual;
  const Params read = table().read(defaults(), "");
  EXPECT_EQ(read.mass_kg, usual.mass_kg);
  EXPECT_EQ(read.tilt_rad, usual.tilt_rad);
  EXPECT_EQ(read.layout, Layout::kPlus);
  EXPECT_EQ(read.leg.stiffness_N_per_m, 7000.0);
  EXPECT_EQ(read.other_leg.stiffness_N_per_m, 8000.0);

  ParameterSet parameters = defaults();
  parameters.set("mass_kg", 3.0).set("rows", std::int64_t{4}).set("on", false);
  parameters.set("layout", std::string("x")).set("first_wall", std::string("last"));
  parameters.set("inertia_kgm2", std::vector<double>{1, 2, 3}).set("file", std::string("a.las"));
  parameters.set("spacing_m", std::vector<double>{2, 3}).set("stiff", 10'000.0);
  parameters.set("weight", 0.25).set("words", std::vector<std::string>{"b"});
  parameters.set("missing_rows", std::vector<double>{3, 5}).set("gear_damping_Ns_per_m", 20.0);
  const Params given = table().read(parameters, "");
  EXPECT_EQ(given.mass_kg, 3.0);
  EXPECT_EQ(given.rows, 4);
  EXPECT_FALSE(given.is_on);
  EXPECT_EQ(given.layout, Layout::kX);
  EXPECT_EQ(given.first_wall, End::kLast);
  EXPECT_EQ(given.inertia_kgm2, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(given.file, "a.las");
  EXPECT_EQ(given.low_m, 2.0);
  EXPECT_EQ(given.high_m, 3.0);
  EXPECT_EQ(given.leg.damping_Ns_per_m, 20.0);
  EXPECT_EQ(given.other_leg.stiffness_N_per_m, 10'000.0);
  EXPECT_EQ(given.search.cost.weight, 0.25);
  EXPECT_EQ(given.words, std::vector<std::string>{"b"});
  EXPECT_EQ(given.missing, (std::vector<int>{3, 5}));
}

TEST(ParameterTable, IncludedRowsTakeNamesWordsRangesAndDefaultsOfTheirNewHome) {
  const std::vector<ParameterSpec> specs = table().specs();
  const ParameterSpec& stiffness = spec_of(specs, "gear_stiffness_N_per_m");
  EXPECT_EQ(std::get<double>(stiffness.default_value), 7000.0);
  EXPECT_EQ(stiffness.description, "along");
  const ParameterSpec& damping = spec_of(specs, "gear_damping_Ns_per_m");
  EXPECT_EQ(damping.description, "of a leg with its foot");
  EXPECT_EQ(damping.max, 1e3);
  EXPECT_EQ(spec_of(leg_table().specs(), "damping_Ns_per_m").max, 1e5);
  EXPECT_EQ(std::get<double>(spec_of(specs, "stiff").default_value), 8000.0);
}

TEST(ParameterTable, GroupsHaveTablesOfTheirOwn) {
  ParameterSet parameters = defaults();
  ParameterSet leg = parameters.make_group("spare_leg");
  leg.set("stiffness_N_per_m", 9.0).set("damping_Ns_per_m", 1.0);
  parameters.set("spare_leg", std::vector<ParameterSet>{leg});
  ParameterSet fault = parameters.make_group("faults");
  EXPECT_THROW(parameters.set("faults", std::vector<ParameterSet>{fault}), ConfigError);
  fault.set("kind", std::string("rotor")).set("at_s", 5.0).set("rotor", std::int64_t{3});
  parameters.set("faults", std::vector<ParameterSet>{fault});
  const Params params = table().read(parameters, "");
  ASSERT_TRUE(params.spare_leg);
  EXPECT_EQ(params.spare_leg->stiffness_N_per_m, 9.0);
  ASSERT_EQ(params.faults.size(), 1u);
  EXPECT_EQ(params.faults[0].rotor, 2u);
  EXPECT_EQ(params.faults[0].at_s, 5.0);
}

TEST(ParameterTable, AStructFilledInCodeMeetsTheSameLimitsAsAFile) {
  Params params;
  EXPECT_EQ(fault_of(params), "accepted");
  params.tilt_rad = rad_from_deg(80.0);
  EXPECT_EQ(fault_of(params), "accepted");
  params.tilt_rad = rad_from_deg(81.0);
  EXPECT_EQ(fault_of(params), "rover: tilt_deg = 81 deg, must be >= 1 deg and <= 80 deg");
  params = {};
  params.mass_kg = -2.0;
  EXPECT_EQ(fault_of(params), "rover: mass_kg = -2 kg, must be > 0 kg");
  params.mass_kg = std::nan("");
  EXPECT_EQ(fault_of(params), "rover: mass_kg = nan, must be a finite number");
  params = {};
  params.inertia_kgm2.y() = 0.0;
  EXPECT_EQ(fault_of(params), "rover: inertia_kgm2[1] = 0 kg m2, must be > 0 kg m2");
  params = {};
  params.leg.damping_Ns_per_m = 2e3;
  EXPECT_EQ(fault_of(params),
            "rover: gear_damping_Ns_per_m = 2000 N s/m, must be >= 0 N s/m and <= 1000 N s/m");
  params = {};
  params.layout = static_cast<Layout>(7);
  EXPECT_EQ(fault_of(params), "rover: layout = '(no such value)', must be one of: x, plus");
}

TEST(ParameterTable, RulesAcrossMembersHoldOnEveryWayIn) {
  Params params;
  params.low_m = 6.0;
  EXPECT_EQ(fault_of(params), "rover: spacing_m must rise");
  params = {};
  params.leg.stiffness_N_per_m = 10.0;
  EXPECT_EQ(fault_of(params), "rover: the leg creeps");
  params = {};
  params.faults.resize(2);
  params.faults[0].rotor = 0;
  EXPECT_EQ(fault_of(params), "rover: faults[1]: tell which 'rotor'");
  params.faults[1].rotor = 4;
  EXPECT_EQ(fault_of(params), "rover: faults[1]: rotor = 5, must be >= 1 and <= 4");
  ParameterSet parameters = defaults();
  parameters.set("spacing_m", std::vector<double>{6, 6});
  EXPECT_EQ(refusal(parameters), "rover: spacing_m must rise");
}

TEST(ParameterTable, WholeNumbersMustFitTheirMember) {
  ParameterSet parameters = defaults();
  parameters.set("iterations", std::int64_t{1} << 33);
  EXPECT_EQ(table().read(parameters, "").iterations, std::int64_t{1} << 33);
  parameters.set("missing_rows", std::vector<double>{1, 2.5});
  EXPECT_EQ(refusal(parameters), "rover: missing_rows[1] = 2.5, must be a whole number");
}

TEST(ParameterTable, WritesAStructAsASetThatReadsBack) {
  Params params;
  params.tilt_rad = rad_from_deg(57.0);
  params.layout = Layout::kX;
  params.spare_leg = Leg{};
  params.faults = {{Layout::kX, 3.0, 1}};
  const Params read = table().read(table().write(params, "rover"), "");
  EXPECT_EQ(read.tilt_rad, params.tilt_rad);
  EXPECT_EQ(read.layout, Layout::kX);
  EXPECT_TRUE(read.spare_leg);
  ASSERT_EQ(read.faults.size(), 1u);
  EXPECT_EQ(read.faults[0].rotor, 1u);
  params.mass_kg = 0.0;
  EXPECT_THROW(table().write(params), ConfigError);
}

TEST(ParameterTable, WordsAndValuesHaveOneMap) {
  EXPECT_STREQ(name_of(kLayouts, Layout::kPlus), "plus");
  EXPECT_STREQ(name_of(kLayouts, static_cast<Layout>(9)), "?");
}

}  // namespace
}  // namespace vinerow::parameter_table_test
