#pragma once
/// Controllers of vehicles on wings about steady flight: straight and level at 100 m towards east,
/// on the aircraft of the reference of paper A.

#include "tests/controllers/support/aircraft_loop.h"

namespace vinerow::test {

struct WingSetup : AircraftSetup {
  WingSetup() {
    controller.type = "trmpc";
    numbers = make_reference_wing();
    physics = Duration{10'000'000};
  }
};

}  // namespace vinerow::test
