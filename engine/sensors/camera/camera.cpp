#include "engine/sensors/camera/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "engine/api/messages/commands.h"
#include "engine/api/world_model.h"
#include "engine/core/error.h"
#include "engine/sensors/blindness.h"
#include "engine/sensors/camera/depth_reading.h"
#include "engine/sensors/camera/imager.h"
#include "engine/sensors/camera/lens.h"
#include "engine/sensors/camera/scene_look.h"
#include "engine/sensors/camera/view_caster.h"
#include "engine/sensors/mounted_sensor.h"

namespace vinerow::sensors {
namespace {

enum class Content { kColour, kMono, kBlue, kGreen, kRed, kRedEdge, kNir, kDepth };

struct CameraParams {
  Content picture = Content::kColour;
  LensParams lens;
  ViewSettings view;
  ImagerParams imager;
  DepthParams depth_reading;
  double stereo_baseline_m = 0.0;
  bool depth = false;
  bool normals = false;
  bool semantic = false;
  bool instance = false;
};

/// Time that a picture takes.
double busy_of(const CameraParams& params) {
  return params.view.readout_s + params.imager.exposure_s;
}

const ParameterTable<CameraParams>& camera_table() {
  using P = CameraParams;
  static const ParameterTable<P> table =
      ParameterTable<P>()
          .choice("picture", &P::picture,
                  {{"colour", Content::kColour},
                   {"mono", Content::kMono},
                   {"blue", Content::kBlue},
                   {"green", Content::kGreen},
                   {"red", Content::kRed},
                   {"red_edge", Content::kRedEdge},
                   {"nir", Content::kNir},
                   {"depth", Content::kDepth}},
                  "what the sensor's own signal has; bands: 475, 560, 668, 717 and 840 nm")
          .include(&P::lens, lens_table())
          .integer(
              "samples", [](P& p) -> int& { return p.view.samples; }, between(1, 64),
              "rays of a pixel; more than one: smooth edges and motion blur")
          .number(
              "readout_s", "s", [](P& p) -> double& { return p.view.readout_s; }, between(0.0, 1.0),
              "from the first to the last row (rolling shutter); 0: global")
          .boolean(
              "shadows", [](P& p) -> bool& { return p.view.shadows; },
              "true: surfaces shade each other")
          .include(&P::imager, imager_table())
          .include(&P::depth_reading, depth_table())
          .number("stereo_baseline_m", "m", &P::stereo_baseline_m, between(0.0, 10.0),
                  "right camera of a stereo pair: distance from the left one, for <name>_info")
          .boolean("depth", &P::depth, "true: signal <name>_depth")
          .boolean("normals", &P::normals, "true: signal <name>_normals")
          .boolean("semantic", &P::semantic, "true: signal <name>_semantic")
          .boolean("instance", &P::instance, "true: signal <name>_instance");
  return table;
}

Channel channel_of(Content content) {
  switch (content) {
    case Content::kMono:
      return Channel::kMono;
    case Content::kBlue:
      return Channel::kBlue;
    case Content::kGreen:
      return Channel::kGreen;
    case Content::kRed:
      return Channel::kRed;
    case Content::kRedEdge:
      return Channel::kRedEdge;
    case Content::kNir:
      return Channel::kNir;
    default:
      return Channel::kColour;
  }
}

ViewSettings view_settings(const CameraParams& params) {
  ViewSettings settings = params.view;
  settings.channels = params.picture == Content::kDepth    ? 0
                      : params.picture == Content::kColour ? 3
                                                           : 1;
  return settings;
}

Picture make_picture(const Lens& lens, Picture::Format format) {
  Picture picture;
  picture.width = lens.info().width;
  picture.height = lens.info().height;
  picture.format = format;
  picture.data.resize(std::size_t{picture.width} * picture.height *
                      Picture::bytes_per_pixel(format));
  return picture;
}

void set_mm(Picture& picture, std::size_t pixel, std::uint16_t mm) {
  picture.data[2 * pixel] = static_cast<std::uint8_t>(mm & 0xffu);
  picture.data[2 * pixel + 1] = static_cast<std::uint8_t>(mm >> 8);
}

/// An exposure that the camera chooses itself ends before the next picture begins.
ImagerParams within_period(const CameraParams& params, double period_s) {
  ImagerParams imager = params.imager;
  const double longest_s = period_s - params.view.readout_s;
  if (longest_s > 0.0) {
    imager.exposure_max_s = std::min(imager.exposure_max_s, longest_s);
    imager.exposure_min_s = std::min(imager.exposure_min_s, longest_s);
  }
  return imager;
}

class Camera final : public MountedSensor<Picture>, public LooksOut {
 public:
  Camera(const ParameterSet& parameters, const SensorContext& context)
      : Camera(camera_table().read(parameters, context.part), parameters, context) {}
  Camera(const CameraParams& params, const ParameterSet& parameters, const SensorContext& context)
      : MountedSensor(parameters, context),
        is_depth_camera_(params.picture == Content::kDepth),
        lens_(make_lens(params.lens, context.part)),
        look_(*context.world, channel_of(params.picture)),
        caster_(lens_, view_settings(params), *context.world, context.light(), look_),
        imager_(within_period(params, context.period.s()), lens_.width(), lens_.height(),
                std::max(1, view_settings(params).channels), look_.white(),
                context.random("pattern")),
        depth_reading_(params.depth_reading, lens_.info().fx_px),
        vehicles_(context.vehicles),
        vehicle_name_(context.vehicle),
        noise_(context.random("noise")),
        depth_noise_(context.random("depth")),
        info_(lens_.info()),
        info_readings_(reading_table().read(parameters, context.part), with_name(context, "_info"),
                       false) {
    info_.tx_px_m = -info_.fx_px * params.stereo_baseline_m + 0.0;
    info_readings_.prefill(info_);
    if (!is_depth_camera_) {
      exposure_readings_.emplace(reading_table().read(parameters, context.part),
                                 with_name(context, "_exposure"), false);
      exposure_readings_->prefill(exposure_);
    }
    picture_ = make_picture(lens_, params.picture == Content::kColour ? Picture::Format::kRgb8
                                   : is_depth_camera_                 ? Picture::Format::kDepth16
                                                                      : Picture::Format::kMono16);
    truth_ = picture_;
    readings_.prefill(picture_);
    const auto add = [&](bool is_wanted, const char* name, Picture::Format format, auto fill) {
      if (!is_wanted) return;
      layers_.push_back({make_picture(lens_, format),
                         Readings<Picture>(reading_table().read(parameters, context.part),
                                           with_name(context, name), false),
                         fill});
      layers_.back().readings.prefill(layers_.back().picture);
    };
    add(params.depth, "_depth", Picture::Format::kDepth16, &Camera::fill_depth);
    add(params.normals, "_normals", Picture::Format::kRgb8, &Camera::fill_normals);
    add(params.semantic, "_semantic", Picture::Format::kMono8, &Camera::fill_semantic);
    add(params.instance, "_instance", Picture::Format::kRgb8, &Camera::fill_instance);
    const double busy_s = busy_of(params);
    if (busy_s > context.period.s()) {
      throw ConfigError(
          fmt::format("{}: readout_s + exposure_s = {:g} s, must be <= its period of {:g} s",
                      context.part, busy_s, context.period.s()));
    }
    constexpr std::uint32_t kMostThings = 1u << 24;
    if (params.instance && ThingNumbers(context.world->meshes).end() + 256u > kMostThings) {
      throw ConfigError(fmt::format(
          "{}: instance: the world has more things than the {} that its pictures can number",
          context.part, kMostThings));
    }
  }

  void connect(Ports& ports) override {
    MountedSensor::connect(ports);
    info_readings_.connect(ports);
    if (exposure_readings_) exposure_readings_->connect(ports);
    for (Layer& layer : layers_) layer.readings.connect(ports);
  }

  void deliver(Time now) override {
    MountedSensor::deliver(now);
    info_readings_.deliver();
    if (exposure_readings_) exposure_readings_->deliver();
    for (Layer& layer : layers_) layer.readings.deliver();
  }

  void check_view(const Pose& X_WB) override { begin(X_WB * X_BS_); }

  void step(Time now) override {
    const CameraMotion motion = CameraMotion::of_body(body(), X_BS_);
    if (!has_looked_) begin(motion.X_WS);
    caster_.cast(motion, imager_.exposure_s(), view_);
    if (is_depth_camera_) {
      for (std::size_t i = 0; i < view_.depth_m.size(); ++i) {
        set_mm(picture_, i, depth_reading_.reading_mm(view_.depth_m[i], depth_noise_));
        set_mm(truth_, i, depth_reading_.exact_mm(view_.depth_m[i]));
      }
    } else {
      imager_.expose(view_.radiance, noise_, picture_, truth_);
    }
    readings_.push_or_silence(now, picture_, truth_);
    info_readings_.push_or_silence(now, info_, info_);
    if (exposure_readings_) {
      exposure_.values = {imager_.exposure_s(), imager_.gain()};
      exposure_readings_->push_or_silence(now, exposure_, exposure_);
    }
    for (Layer& layer : layers_) {
      (this->*layer.fill)(layer.picture);
      layer.readings.push_or_silence(now, layer.picture, layer.picture);
    }
  }

 private:
  struct Layer {
    Picture picture;
    Readings<Picture> readings;
    void (Camera::*fill)(Picture&);
  };

  static SensorContext with_name(SensorContext context, const char* end) {
    context.name += end;
    return context;
  }

  void begin(const Pose& X_WS_now) {
    has_looked_ = true;
    if (vehicles_) caster_.set_vehicles(vehicles_(), vehicle_name_);
    const std::string reason = caster_.blindness(X_WS_now);
    if (reason.empty()) return;
    throw ConfigError(fmt::format("the camera {}: change its position_m", reason));
  }

  void fill_depth(Picture& picture) {
    for (std::size_t i = 0; i < view_.depth_m.size(); ++i) {
      set_mm(picture, i, depth_reading_.reading_mm(view_.depth_m[i], depth_noise_));
    }
  }

  void fill_normals(Picture& picture) {
    for (std::size_t i = 0; i < view_.normal_C.size(); ++i) {
      const Eigen::Vector3f& n = view_.normal_C[i];
      for (int k = 0; k < 3; ++k) {
        picture.data[3 * i + static_cast<std::size_t>(k)] =
            n.isZero() ? std::uint8_t{0}
                       : static_cast<std::uint8_t>(std::lround(127.5f * (n[k] + 1.0f)));
      }
    }
  }

  void fill_semantic(Picture& picture) {
    for (std::size_t i = 0; i < view_.label.size(); ++i) {
      picture.data[i] = static_cast<std::uint8_t>(view_.label[i]);
    }
  }

  void fill_instance(Picture& picture) {
    for (std::size_t i = 0; i < view_.thing.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        picture.data[3 * i + k] = static_cast<std::uint8_t>(view_.thing[i] >> (8 * k));
      }
    }
  }

  bool is_depth_camera_;
  Lens lens_;
  SceneLook look_;
  ViewCaster caster_;
  Imager imager_;
  DepthReading depth_reading_;
  std::function<VehicleScene&()> vehicles_;
  std::string vehicle_name_;
  bool has_looked_ = false;
  QuickNormals noise_, depth_noise_;
  View view_;
  Picture picture_, truth_;
  CameraInfo info_;
  Readings<CameraInfo> info_readings_;
  NamedValues exposure_{{"exposure_s", "gain"}, {0.0, 0.0}};  ///< of the last picture
  std::optional<Readings<NamedValues>> exposure_readings_;
  std::vector<Layer> layers_;
};

}  // namespace

CameraNature camera_nature(const ParameterSet& parameters, const std::string& owner) {
  const CameraParams params = camera_table().read(parameters, owner);
  const std::vector<double>& k = params.lens.distortion;
  return {params.picture == Content::kDepth,
          params.lens.lens == CameraInfo::Lens::kFisheye ||
              std::any_of(k.begin(), k.end(), [](double value) { return value != 0.0; }),
          params.view.readout_s, busy_of(params)};
}

PartSpec camera_spec() {
  PartSpec spec = mounted_sensor_spec<Picture>(
      "camera",
      "camera: pictures with lens, exposure and noise of an image sensor, in colour, bands or "
      "depth, with depth, normals and labels of each pixel",
      10.0, camera_table());
  spec.writes.push_back(std::string("<name>_info: ") + CameraInfo::kType);
  spec.writes.push_back(std::string("<name>_exposure: ") + NamedValues::kType);
  for (const char* layer : {"depth", "normals", "semantic", "instance"}) {
    spec.writes.push_back(fmt::format("<name>_{}: {}", layer, Picture::kType));
  }
  return spec;
}

std::unique_ptr<Sensor> make_camera(const ParameterSet& parameters, const SensorContext& context) {
  return std::make_unique<Camera>(parameters, context);
}

}  // namespace vinerow::sensors
