#pragma once
/// Camera: pictures as an image sensor reads them, with depth, normals and labels of each pixel.
///
/// Everything is cast ray by ray on the world's surfaces as light meets them (view_caster.h), with
/// the lens of lens.h, the light of scene_look.h and the noise of imager.h. No graphics driver
/// takes part, and the bytes are the same on every machine.
///
/// `picture` is what the signal of the sensor's name has: colours (RGB8, sRGB), one band (MONO16,
/// linear) or depth (MONO16, mm). Further signals, the layers as parameters request them:
///   <name>_info      CameraInfo of all pictures, with their stamps; lost together with them
///   <name>_exposure  NamedValues: exposure_s, gain of the picture; not of depth alone
///   <name>_depth     MONO16, mm along the axis; 0: none (with the errors of depth_reading.h)
///   <name>_normals   RGB8: (n + 1) / 2 x 255 in the optical frame; 0, 0, 0: nothing is seen
///   <name>_semantic  MONO8: Label
///   <name>_instance  RGB8: number of the thing (thing_numbers.h), red + 256 green + 65536 blue
/// Labels and numbers have no error: they are what a perfect recognition would give.

#include <memory>
#include <string>

#include "engine/api/registry.h"

namespace vinerow::sensors {

/// Facts of a camera before a run.
struct CameraNature {
  bool takes_depth_alone = false;
  bool has_distortion = false;
  double readout_s = 0.0;  ///< from the first row to the last
  double busy_s = 0.0;     ///< of a picture, its exposure and readout: the shortest period
};
/// @param owner  of the parameters, for errors  @throws ConfigError "rover.sensors.front: ..."
CameraNature camera_nature(const ParameterSet& parameters, const std::string& owner);

PartSpec camera_spec();
/// @throws ConfigError if the lens folds, a picture takes longer than the period, or the world has
/// too many things to be numbered
std::unique_ptr<Sensor> make_camera(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
