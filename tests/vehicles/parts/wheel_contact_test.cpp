#include "vehicles/parts/wheel_contact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

namespace vinerow::vehicles::wheel_contact_test {
namespace {

using Eigen::Vector3d;

struct Hit {
  double distance_m;
  Vector3d normal_W;
};

/// Plane through a point.
struct Plane {
  Vector3d p, n;
  std::optional<Hit> operator()(const Vector3d& from, const Vector3d& dir, double reach) const {
    const double distance = n.dot(p - from) / n.dot(dir);
    if (distance < 0.0 || distance > reach) return std::nullopt;
    return Hit{distance, n};
  }
};

/// Level ground with a step up at x >= edge.
struct StepGround {
  double edge, height;
  std::optional<Hit> operator()(const Vector3d& from, const Vector3d& dir, double reach) const {
    const double level = from.x() >= edge ? height : 0.0;
    const double distance = (from.z() - level) / -dir.z();
    if (distance > reach) return std::nullopt;
    return Hit{distance, Vector3d::UnitZ()};
  }
};

WheelDisc upright_disc(double hub_z) {
  return {{0, 0, hub_z}, Vector3d::UnitX(), Vector3d::UnitY(), Vector3d::UnitZ(), 0.2, -0.1, 3};
}

TEST(WheelContact, DiscOnAnInclinedPlaneIsTangent) {
  for (const double slope : {-0.5, -0.2, 0.0, 0.3, 0.7}) {
    const Plane plane{{0, 0, 0.05}, Vector3d(-std::sin(slope), 0, std::cos(slope))};
    const WheelDisc disc = upright_disc(0.2);
    const WheelContact contact = find_wheel_contact(disc, plane);
    ASSERT_TRUE(contact.touches);
    // The raised hub is exactly one radius from the plane, and the contact lies on it.
    const Vector3d hub = disc.hub_W + contact.travel_m * Vector3d::UnitZ();
    EXPECT_NEAR(plane.n.dot(hub - plane.p), 0.2, 1e-12) << slope;
    EXPECT_NEAR(plane.n.dot(contact.p_W - plane.p), 0.0, 1e-12) << slope;
    EXPECT_NEAR((contact.p_W - hub).norm(), 0.2, 1e-12) << slope;
  }
}

TEST(WheelContact, SideSlopeLiftsTheThinDiscByItsEdgeOnly) {
  const double slope = 0.3;
  const Plane plane{{0, 0, 0}, Vector3d(0, -std::sin(slope), std::cos(slope))};
  const WheelContact contact = find_wheel_contact(upright_disc(0.2), plane);
  ASSERT_TRUE(contact.touches);
  EXPECT_NEAR(contact.travel_m, 0.0, 1e-12);  // the lowest point of the disc is on the plane
  EXPECT_NEAR(contact.p_W.norm(), 0.0, 1e-12);
}

TEST(WheelContact, EdgeOfAStepPushesTowardsTheHub) {
  // The edge 0.1 m ahead, 0.05 m high: the disc would reach it at height r - sqrt(r^2 - s^2).
  const WheelContact contact = find_wheel_contact(upright_disc(0.2), StepGround{0.1, 0.05});
  ASSERT_TRUE(contact.touches);
  EXPECT_GT(contact.travel_m, 0.0);
  EXPECT_LT(contact.normal_W.x(), -0.5);  // backwards: a step brakes
  EXPECT_NEAR(contact.normal_W.norm(), 1.0, 1e-12);
  const WheelContact before = find_wheel_contact(upright_disc(0.2), StepGround{0.25, 0.05});
  EXPECT_NEAR(before.travel_m, 0.0, 1e-12);  // not there yet
}

TEST(WheelContact, StepIsClimbedAlongTheDiscsArc) {
  // The hub over an edge at distance s: height h + sqrt(r^2 - s^2), i.e. h + rise - r of travel.
  for (const double step : {0.01, 0.03, 0.1}) {
    for (double x = -0.3; x < 0.1; x += 0.002) {
      WheelDisc disc = upright_disc(0.2);
      disc.hub_W.x() = x;
      const double travel = find_wheel_contact(disc, StepGround{0.0, step}).travel_m;
      // The edge is known to 0.9 r / 32 and taken on its far side, never too near.
      const auto travel_at = [&](double distance) {
        return std::max(0.0, step + std::sqrt(std::max(0.0, 0.04 - distance * distance)) - 0.2);
      };
      const double edge = std::max(0.0, -x);
      if (edge > 0.18) {
        EXPECT_NEAR(travel, 0.0, 1e-12);
        continue;
      }
      EXPECT_LE(travel, travel_at(edge) + 1e-12) << "x " << x << " step " << step;
      EXPECT_GE(travel, travel_at(edge + 0.18 / 32) - 1e-12) << "x " << x << " step " << step;
    }
  }
}

TEST(WheelContact, KinkInTheGroundIsExact) {
  // Level, then up by 20 degrees from x = 0 on: the disc touches both planes at the tangent radius.
  struct Kink {
    std::optional<Hit> operator()(const Vector3d& from, const Vector3d&, double reach) const {
      const double slope = std::tan(0.35);
      const double level = from.x() > 0.0 ? slope * from.x() : 0.0;
      const Vector3d n = from.x() > 0.0 ? Vector3d(-slope, 0, 1).normalized() : Vector3d::UnitZ();
      if (from.z() - level > reach) return std::nullopt;
      return Hit{from.z() - level, n};
    }
  };
  for (const double x : {-0.15, -0.05, -0.02, 0.02, 0.1}) {
    WheelDisc disc = upright_disc(0.2);
    disc.hub_W.x() = x;
    const WheelContact contact = find_wheel_contact(disc, Kink{});
    // Height of the hub: the higher of resting on either plane.
    const double on_slope = std::tan(0.35) * x + 0.2 / std::cos(0.35) - 0.2;
    EXPECT_NEAR(contact.travel_m, std::max(0.0, on_slope), 1e-9) << x;
  }
}

TEST(WheelContact, HangsFreeWhenTheGroundIsOutOfReach) {
  const WheelContact contact =
      find_wheel_contact(upright_disc(0.35), Plane{{0, 0, 0}, Vector3d::UnitZ()});
  EXPECT_FALSE(contact.touches);
  EXPECT_EQ(contact.travel_m, -0.1);
}

}  // namespace
}  // namespace vinerow::vehicles::wheel_contact_test
