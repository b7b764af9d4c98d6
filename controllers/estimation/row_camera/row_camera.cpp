#include "controllers/estimation/row_camera/row_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "controllers/estimation/parts/estimator_events.h"
#include "controllers/estimation/parts/mounting.h"
#include "controllers/estimation/parts/trace.h"
#include "controllers/estimation/parts/wheel_speed.h"
#include "controllers/estimation/row_camera/net_labels.h"
#include "controllers/estimation/row_camera/row_camera_filter.h"
#include "controllers/estimation/row_camera/row_marks.h"
#include "controllers/estimation/row_localisation/row_ground.h"
#include "engine/api/map.h"
#include "engine/api/messages/sensors.h"
#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "engine/core/random.h"
#include "engine/core/suggest.h"
#include "engine/math/angles.h"

namespace vinerow::controllers {
namespace {

struct RowCameraParams {
  std::string camera = "camera", imu = "imu", wheels = "encoders";
  RowMarksParams marks;
  NetLabelsParams net;
  RowCameraFilterParams filter;

  bool has_net() const { return !net.model.empty(); }
  bool reads_labels() const {
    return marks.source == RowMarksParams::Source::kLabels && !has_net();
  }
};

std::string fault_of(const RowCameraParams& params) {
  const bool is_unused =
      params.has_net() && params.marks.source == RowMarksParams::Source::kColours;
  return is_unused ? "model finds labels, but marks: colours uses none; remove one of them" : "";
}

const ParameterTable<RowCameraParams>& row_camera_table() {
  using P = RowCameraParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .text("camera", &P::camera,
                "sensor of type camera; marks: labels without a model needs its `semantic: true`")
          .text("imu", &P::imu, "signal of the inertial unit, whose rate about z is used")
          .text("wheels", &P::wheels, "signal of the wheel speeds")
          .include(&P::marks, row_marks_table())
          .include(&P::net, net_labels_table())
          .include(&P::filter, row_camera_filter_table())
          .rule(&fault_of);
  return table;
}

/// State at a time, for pictures that come late. The heading is not wrapped between entries.
struct PastState {
  RowCameraFilter::State x = RowCameraFilter::State::Zero();
};
PastState interpolate(const PastState& older, const PastState& newer, double share) {
  PastState between = newer;
  between.x = older.x + share * (newer.x - older.x);
  between.x[2] = older.x[2] + share * wrap_angle(newer.x[2] - older.x[2]);
  return between;
}

const SensorMounting& camera_of(const std::string& name, const EstimatorContext& context) {
  std::vector<std::string> cameras;
  for (const SensorMounting& sensor : context.sensors) {
    if (sensor.type != "camera") continue;
    if (sensor.name == name) return sensor;
    cameras.push_back(sensor.name);
  }
  throw ConfigError(
      fmt::format("{} (row_camera): camera = '{}', but the vehicle has no such camera "
                  "(cameras: {})",
                  context.part, name, cameras.empty() ? "none" : join(cameras)));
}

std::vector<Polyline> lines_of(const EstimatorContext& context) {
  std::vector<Polyline> lines;
  for (const PlantRow& row : context.map->rows) {
    std::vector<Eigen::Vector2d> points;
    for (const Eigen::Vector3d& p : row.line_W) points.push_back(p.head<2>());
    lines.emplace_back(std::move(points));
  }
  if (lines.empty()) {
    throw ConfigError(context.part + " (row_camera) needs a map with rows; this one has none");
  }
  return lines;
}

class RowCamera final : public Estimator {
 public:
  RowCamera(const RowCameraParams& params, const EstimatorContext& context)
      : params_(params),
        period_s_(context.period.s()),
        wheel_speed_(*context.vehicle_description, context.part + " (row_camera)"),
        marks_(params.marks, camera_of(params.camera, context).X_BS,
               context.vehicle_description->height_above_ground_m),
        filter_(params.filter, lines_of(context)),
        ground_(*context.map),
        height_m_(context.vehicle_description->height_above_ground_m),
        random_(context.random("start")),
        q_BI_(mounting_of(context, params.imu).q) {
    if (params.has_net()) net_.emplace(params.net, context.part + " (row_camera)");
  }

  void connect(Ports& ports) override {
    truth_ = ports.read<Odometry>("truth");
    imu_ = ports.read<ImuSample>(params_.imu);
    wheels_ = ports.read<NamedValues>(params_.wheels);
    picture_ = ports.read<Picture>(params_.camera + (params_.reads_labels() ? "_semantic" : ""));
    info_ = ports.read<CameraInfo>(params_.camera + "_info");
    estimate_ = ports.write<Odometry>("estimate");
    if (net_) labels_ = ports.write_in_frame_of<Picture>(params_.camera, "net_labels");
    events_.connect(ports);
  }

  void step(Time now) override {
    if (!filter_.ready()) {
      start();
    } else {
      filter_.predict(speed_mps(), rate_radps(), period_s_);
    }
    trace_.add(now, {filter_.state()});
    take_picture(now);
    write(now);
    events_.write(now);
  }

 private:
  /// As a person knows the place where the vehicle is put down.
  void start() {
    const Odometry& truth = truth_.value();
    const RowCameraFilterParams& filter = params_.filter;
    Eigen::Vector3d start(truth.X_WB.p.x(), truth.X_WB.p.y(), yaw_from_quaternion(truth.X_WB.q));
    start.x() += filter.start_std_m * random_.normal();
    start.y() += filter.start_std_m * random_.normal();
    start.z() += filter.start_yaw_std_rad * random_.normal();
    filter_.start(start);
    z_m_ = truth.X_WB.p.z();
  }

  double speed_mps() {
    const double speed = wheels_.has_value() ? wheel_speed_.read_mps(wheels_.value()) : 0.0;
    return std::isfinite(speed) ? speed : 0.0;
  }
  double rate_radps() const { return imu_.has_value() ? (q_BI_ * imu_.value().w_WS_S).z() : 0.0; }

  void take_picture(Time now) {
    if (!marks_.has_camera() && info_.has_value()) marks_.set_camera(info_.value());
    if (!marks_.has_camera() || !picture_.is_newer_than(seen_)) return;
    const PastState past = trace_.at(picture_.stamp());
    const int used = filter_.correct(marks_in(usable_picture(), past.x), past.x);
    if (used >= kFew) {
      last_seen_ = now;
      is_lost_ = false;
    } else if (!is_lost_ && now - last_seen_ > kLong) {
      is_lost_ = true;
      events_.report_event(Event::Level::kWarning,
                           "no row has been seen for 5 s: dead reckoning alone");
    }
  }

  const std::vector<RowMark>& marks_in(const Picture& picture, const RowCameraFilter::State& past) {
    return params_.marks.source == RowMarksParams::Source::kLabels
               ? marks_.find_feet(picture)
               : marks_.find_strips(picture, past.head<3>(), filter_.rows());
  }

  /// What the marks are found in.
  const Picture& usable_picture() {
    const Picture& seen = picture_.value();
    if (!params_.reads_labels() && seen.format != Picture::Format::kRgb8) {
      throw ConfigError(fmt::format("{} needs a camera with picture: colour, which '{}' is not",
                                    net_ ? "model" : "marks: colours", params_.camera));
    }
    if (!net_) return seen;
    const Picture& labels = net_->find(seen);
    labels_.write(picture_.stamp(), labels);
    return labels;
  }

  void write(Time now) {
    const RowCameraFilter::State& x = filter_.state();
    if (const auto plane = ground_.at({x[0], x[1], z_m_}); plane && plane->normal_W.z() > 0.5) {
      z_m_ = (plane->offset_m - plane->normal_W.head<2>().dot(x.head<2>())) / plane->normal_W.z() +
             height_m_;
    }
    Odometry estimate;
    estimate.X_WB.p = {x[0], x[1], z_m_};
    estimate.X_WB.q = quaternion_from_rpy({0.0, 0.0, x[2]});
    estimate.v_WB_B = {speed_mps(), 0.0, 0.0};
    estimate.w_WB_B = {0.0, 0.0, rate_radps() - x[3]};
    estimate.position_variance_m2.head<2>() = filter_.covariance().diagonal().head<2>();
    estimate.position_covariance_m2.x() = filter_.covariance()(0, 1);
    estimate.yaw_std_rad = std::sqrt(std::max(filter_.covariance()(2, 2), 0.0));
    estimate_.write(now, estimate);
  }

  static constexpr int kFew = 3;  // marks
  static constexpr Duration kLong{5'000'000'000};

  RowCameraParams params_;
  double period_s_;
  WheelSpeed wheel_speed_;
  RowMarks marks_;
  std::optional<NetLabels> net_;
  RowCameraFilter filter_;
  RowGround ground_;
  double height_m_;
  RandomStream random_;
  Eigen::Quaterniond q_BI_;  ///< of the inertial unit
  double z_m_ = 0.0;
  RecentTrace<PastState> trace_;
  std::uint64_t seen_ = 0;
  Time last_seen_;
  bool is_lost_ = false;
  SignalReader<Odometry> truth_;
  SignalReader<ImuSample> imu_;
  SignalReader<NamedValues> wheels_;
  SignalReader<Picture> picture_;
  SignalReader<CameraInfo> info_;
  SignalWriter<Odometry> estimate_;
  SignalWriter<Picture> labels_;  // what the net found
  EstimatorEvents events_;
};

}  // namespace

PartSpec row_camera_spec() {
  PartSpec spec;
  spec.name = "row_camera";
  spec.description =
      "Place and heading between mapped rows from a camera's picture (feet of trunks and posts, "
      "whose labels may come from a neural network, or bare strips of soil), wheels and a rate "
      "gyro; no satellites.";
  row_camera_table().add_to(spec);
  spec.default_rate_Hz = 40.0;
  spec.reads = {"<camera>_semantic or <camera>", "<camera>_info", "<imu>", "<wheels>",
                "truth (start)"};
  spec.writes = {"estimate", "net_labels"};
  return spec;
}

std::unique_ptr<Estimator> make_row_camera(const ParameterSet& parameters,
                                           const EstimatorContext& context) {
  return std::make_unique<RowCamera>(
      row_camera_table().read(parameters, context.part + " (row_camera)"), context);
}

}  // namespace vinerow::controllers
