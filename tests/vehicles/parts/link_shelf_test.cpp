/// Links of vehicles that are built with one file shelf, as in the resets of a session: shared by
/// equal vehicles, and by no others.

#include "vehicles/parts/link_shelf.h"

#include <gtest/gtest.h>

#include <optional>

#include "engine/core/error.h"
#include "vehicles/register_vehicles.h"

namespace vinerow::vehicles::link_shelf_test {
namespace {

using Links = std::vector<VehicleLink>;

class LinkShelf : public ::testing::TestWithParam<const char*> {
 protected:
  LinkShelf() { register_vehicles(registry_); }

  ParameterSet defaults() const {
    return ParameterSet(registry_.spec(PartKind::kVehicle, GetParam()).parameters, GetParam());
  }
  Links links_of(const ParameterSet& parameters, FileShelf* shelf) const {
    VehicleContext context;
    context.vehicle = context.part = "robot";
    context.physics_step = Duration{1'000'000};
    context.shelf = shelf;
    return registry_.make_vehicle(GetParam(), parameters, context)->links();
  }

  Registry registry_;
};

TEST_P(LinkShelf, EqualVehiclesShareTheMeshesThatAVehicleWithoutItMakes) {
  FileShelf shelf;
  const Links first = links_of(defaults(), &shelf), second = links_of(defaults(), &shelf);
  const Links alone = links_of(defaults(), nullptr);
  ASSERT_EQ(first.size(), alone.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].mesh, second[i].mesh);
    EXPECT_NE(first[i].mesh, alone[i].mesh);
    EXPECT_EQ(first[i].name, alone[i].name);
    EXPECT_EQ(first[i].mesh->vertices, alone[i].mesh->vertices);
  }
}

TEST_P(LinkShelf, VehicleWithAnyOtherNumberHasItsOwn) {
  FileShelf shelf;
  const ParameterSet usual = defaults();
  const Links plain = links_of(usual, &shelf);
  int built = 0, other_shapes = 0;
  for (const ParameterSpec& spec : usual.specs()) {
    const double* number = std::get_if<double>(&spec.default_value);
    if (!number) continue;
    std::optional<Links> links;
    ParameterSet parameters = usual;
    try {
      parameters.set(spec.name, *number == 0.0 ? 0.01 : 0.987 * *number);
      links = links_of(parameters, &shelf);
    } catch (const ConfigError&) {
      continue;  // outside its range, or it does not fit the others
    }
    ++built;
    EXPECT_NE(links->front().mesh, plain.front().mesh) << spec.name;
    const Links alone = links_of(parameters, nullptr);
    for (std::size_t i = 0; i < alone.size(); ++i) {
      EXPECT_EQ((*links)[i].mesh->vertices, alone[i].mesh->vertices) << spec.name;
      other_shapes += alone[i].mesh->vertices != plain[i].mesh->vertices;
    }
  }
  EXPECT_GT(built, 5);
  EXPECT_GT(other_shapes, 0);
}

INSTANTIATE_TEST_SUITE_P(Vehicles, LinkShelf,
                         ::testing::Values("diff_drive_rover", "four_wheel_steering_rover",
                                           "quadrotor", "fixed_wing"));

}  // namespace
}  // namespace vinerow::vehicles::link_shelf_test
