#include "controllers/parts/ground_drive/twist_drive.h"

#include "controllers/parts/ground_drive/ackermann_drive.h"
#include "controllers/parts/ground_drive/differential_drive.h"

namespace vinerow::controllers {

std::unique_ptr<TwistDrive> make_twist_drive(const VehicleDescription& description,
                                             const std::string& who) {
  if (description.ackermann) return std::make_unique<AckermannDrive>(description, who);
  return std::make_unique<DifferentialDrive>(description, who);
}

}  // namespace vinerow::controllers
