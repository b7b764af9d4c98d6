#pragma once
/// Image sensor of a camera: from light to numbers, with the noise of EMVA standard 1288.
///
/// Photons: luminance L of a scene gives the image plane the illuminance E = t pi L / (4 N^2) with
/// the f-number N and the share t that the lens leaves at the place (vignetting). In the exposure
/// time a pixel of area A gets E A time x 4.09e15 photons / (m2 lx s) (1 lx = 1/683 W/m2 at 555
/// nm), of which the quantum efficiency becomes electrons. The sun above the atmosphere has 128
/// klx.
///
/// Noise (EMVA 1288, release 4.0 linear, linear model): the electrons vary with their own number
/// (shot noise, here normal), plus the reading's read_noise_e. Pixels differ: a constant of dsnu_e
/// and a gain of prnu. The sum is clipped at full_well_e, amplified by the gain, and rounded to
/// `bits`. Colours are amplified for white, as their noise; they are not interpolated from a
/// mosaic.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/api/messages/camera.h"
#include "engine/api/parameter_table_fwd.h"
#include "engine/core/random.h"

namespace vinerow::sensors {

struct ImagerParams {
  double exposure_s = 0.0;
  double exposure_min_s = 2e-5;
  double exposure_max_s = 0.01;
  double gain_max = 16.0;
  double brightness = 0.18;
  double f_number = 2.8;
  double pixel_um = 3.45;
  double quantum_efficiency = 0.6;
  double full_well_e = 10500.0;
  double read_noise_e = 2.5;
  double dsnu_e = 1.0;
  double prnu = 0.01;
  int bits = 12;
  double corner_light = 1.0;
  bool noise = true;
};

/// `exposure_s` to `noise`.
const ParameterTable<ImagerParams>& imager_table();

/// Standard normal numbers, five from one of the stream: quantiles of 4096 equal shares.
class QuickNormals {
 public:
  explicit QuickNormals(RandomStream random);
  float next();
  /// Uniform in [0, 1), in steps of 1/4096.
  float next_share();
  /// Number of one of the shares; next() is its quantile().
  std::uint32_t draw();
  static float quantile(std::uint32_t share);

 private:
  RandomStream random_;
  std::uint64_t bits_ = 0;
  int left_ = 0;
};

class Imager {
 public:
  /// @param channels  3, or 1 for a band
  /// @param white     radiance of each channel that is shown as grey, and sets the unit
  /// @param pattern   draws the differences between pixels
  Imager(const ImagerParams& params, int width, int height, int channels,
         const Eigen::Vector3f& white, RandomStream pattern);

  /// Exposure at which a pixel that gets all light takes a share of its range, without gain.
  static double calc_exposure_s(const ImagerParams& params, double radiance, double share);

  /// Exposure time of the last picture, s; before the first the longest.
  double exposure_s() const { return exposure_s_; }
  /// Gain of the last picture; 1 before the first and with a fixed exposure.
  double gain() const { return gain_; }

  /// @param radiance  channels of each pixel, relative (scene_look.h)
  /// @param reading   with noise  @param truth  the same exposure without
  void expose(std::span<const float> radiance, QuickNormals& noise, Picture& reading,
              Picture& truth);

 private:
  void meter(std::span<const float> radiance);
  void expose_pixel(std::size_t pixel, std::span<const float> radiance, Picture& reading,
                    Picture& truth) const;
  void develop(std::size_t pixel, int channel, double share_of_range, Picture& picture) const;

  ImagerParams params_;
  int width_, height_, channels_;
  std::array<double, 3> balance_{};  ///< factor of each channel that makes white grey
  double electrons_per_s_ = 0.0;     ///< of a pixel for radiance 1
  double exposure_s_ = 0.0, gain_ = 1.0;
  std::vector<float> light_;              ///< share that the lens leaves at each pixel
  std::vector<float> offsets_e_, gains_;  ///< of each pixel
  std::vector<std::uint16_t> draws_;      ///< for the noise of each value of a picture
  /// Of each channel: what the picture shows for each number of the converter.
  std::vector<std::vector<std::uint16_t>> values_;
};

}  // namespace vinerow::sensors
