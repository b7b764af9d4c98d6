#include "controllers/estimation/odometry/gps_pose.h"

#include <optional>

#include "controllers/estimation/parts/heading_source.h"
#include "controllers/estimation/parts/mounting.h"
#include "engine/api/parameter_table.h"

namespace vinerow::controllers {
namespace {

struct GpsPoseParams {
  std::string gps = "gps";              ///< signal
  std::optional<Eigen::Vector3d> p_BA;  ///< antenna in B; absent: as mounted
  bool extrapolate = false;
  HeadingParams heading;
};

const ParameterTable<GpsPoseParams>& gps_pose_table() {
  using P = GpsPoseParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("gps", &P::gps, "signal of the satellite receiver")
          .numbers("antenna_m", "m", &P::p_BA, between(-100.0, 100.0),
                   "position of the antenna in B (x, y, z), subtracted from the fix; default: "
                   "where the receiver is mounted")
          .boolean("extrapolate", &P::extrapolate,
                   "extrapolate the fix with its velocity until the next one")
          .include(&P::heading, heading_table());
  return table;
}

class GpsPose final : public Estimator {
 public:
  GpsPose(const GpsPoseParams& params, const EstimatorContext& context)
      : gps_name_(params.gps),
        extrapolate_(params.extrapolate),
        heading_(params.heading, context),
        p_BA_(antenna_of(context, params.gps, params.p_BA)) {}

  void connect(Ports& ports) override {
    gps_ = ports.read<GnssFix>(gps_name_);
    heading_.connect(ports);
    estimate_ = ports.write<Odometry>("estimate");
  }

  void step(Time now) override {
    const bool is_new = gps_.is_newer_than(seen_fix_) && gps_.value().valid;
    if (is_new) {
      fix_ = gps_.value();
      fix_time_ = gps_.stamp();
    }
    heading_.step(is_new ? &fix_ : nullptr);
    if (!heading_.ready() || !fix_.valid) return;  // no estimate before the first fix

    const Eigen::Quaterniond& q_WB = heading_.q_WB();
    Odometry estimate;
    estimate.X_WB.q = q_WB;
    estimate.X_WB.p = fix_.p_W - q_WB * p_BA_;
    if (extrapolate_) estimate.X_WB.p += (now - fix_time_).s() * fix_.v_W;
    estimate.w_WB_B = heading_.w_WB_B();
    estimate.v_WB_B = q_WB.conjugate() * fix_.v_W - estimate.w_WB_B.cross(p_BA_);
    estimate.position_variance_m2 = fix_.std_m.cwiseAbs2();
    estimate_.write(now, estimate);
  }

 private:
  std::string gps_name_;
  bool extrapolate_;
  HeadingSource heading_;
  Eigen::Vector3d p_BA_;
  GnssFix fix_;
  Time fix_time_;
  std::uint64_t seen_fix_ = 0;
  SignalReader<GnssFix> gps_;
  SignalWriter<Odometry> estimate_;
};

}  // namespace

PartSpec gps_pose_spec() {
  PartSpec spec;
  spec.name = "gps_pose";
  spec.description =
      "Uses the last satellite fix as the position, unfiltered (Martelli, Mocera, Soma 2024, "
      "location error), and the heading of a gyro, corrected by the course.";
  gps_pose_table().add_to(spec);
  spec.default_rate_Hz = 40.0;
  spec.reads = {"<gps>", "<imu>", "truth (start; heading: truth)"};
  spec.writes = {"estimate"};
  return spec;
}

std::unique_ptr<Estimator> make_gps_pose(const ParameterSet& parameters,
                                         const EstimatorContext& context) {
  return std::make_unique<GpsPose>(gps_pose_table().read(parameters, context.part + " (gps_pose)"),
                                   context);
}

}  // namespace vinerow::controllers
