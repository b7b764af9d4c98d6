#pragma once
/// What is wrong with a map on purpose: gaps that are none, vines that are gone, surfaces that are
/// off.

#include <vector>

#include "engine/core/random.h"
#include "worlds/mapping/from_truth/canopy_survey.h"

namespace vinerow::mapping {

/// Joins the chains of a row: the map has vines where the truth has gaps, as an old survey. The
/// rounded ends at a gap are dropped where a chain has more cuts.
void fill_gaps(std::vector<SectionChain>& chains, const CanopySurveyOptions& options,
               RandomStream& random);

/// Cuts a stretch out of a row's chains: the map has a gap where vines may stand. What would be
/// left shorter than 0.3 m goes too.
void remove_stretch(std::vector<SectionChain>& chains, double from_m, double to_m);

/// Adds a stationary Gaussian error to the half widths of a chain, on each side by itself, with
/// correlation exp(-|ds| / l) along the row and the same over height. Between sections it is
/// straight, so that its mean square over the surface is smaller than std^2: 4/9 of it where
/// sections and levels are farther apart than l.
void add_surface_noise(SectionChain& chain, double std_m, double correlation_length_m,
                       RandomStream& random);

}  // namespace vinerow::mapping
