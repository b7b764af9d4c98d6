#pragma once
/// 3D laser scanner: a cloud of points for each frame.
///
/// A frame takes a whole period. The scanner moves meanwhile: it is sampled `slices` times in a
/// period (by default as many as divide it, up to 20), and within a slice its pose
/// goes evenly from the one to the other (position linearly, rotation by its matrix). Each point is
/// in S at its own instant, as drivers deliver it, with its time after the stamp, which is the
/// start of the frame.
///
/// A beam is `sub_rays` rays: one in its middle and the others on a circle of 0.7 of its half
/// width, where half of the area is inside. What they meet within one pulse length makes one echo:
/// its power is the sum, its distance the mean weighted by power. So the beam looks through gaps
/// between leaves: a strong echo of the canopy may be followed by a weak one of the post behind.
/// Power and detection: laser_optics.h. `returns: dual` gives the strongest and the last echo that
/// are detected; if they are the same, the second strongest too (Velodyne, 63-9243, p. 57).
///
/// Own and other vehicles: scan_links.h.
///
/// `organised`: clouds as Ouster's driver gives them. A row has the points of one laser, the
/// highest first; lasers that look to the side are shifted by whole columns, so that a column has
/// one azimuth. `ring` is then the row.
///
/// Reading: laser_optics.h, rounded to `resolution_m`. Intensity: 100 x the reflectance times the
/// cosine of incidence that a whole beam would need for that power, as calibrated scanners report
/// it. The truth signal is the first surface along the beam's middle.

#include <memory>

#include "engine/api/registry.h"

namespace vinerow::sensors {

PartSpec lidar_3d_spec();
/// @throws ConfigError if there is no laser, or too many pulses, or the range is empty, or a
/// column takes longer than the time to the next. Its first sample()
/// throws one if the scanner is inside of something.
std::unique_ptr<Sensor> make_lidar_3d(const ParameterSet& parameters, const SensorContext& context);

}  // namespace vinerow::sensors
