#pragma once
/// Deliberate errors of a map: closed gaps, missing vines, displaced surfaces.

#include <vector>

#include "engine/core/random.h"
#include "worlds/mapping/from_truth/canopy_survey.h"

namespace vinerow::mapping {

/// Joins the chains of a row, so that the map has vines in gaps, like an old survey. The rounded
/// ends at a gap are dropped if a chain has more cuts.
void fill_gaps(std::vector<SectionChain>& chains, const CanopySurveyOptions& options,
               RandomStream& random);

/// Cuts a stretch out of a row's chains, so that the map has a gap at existing vines. Remainders
/// shorter than 0.3 m are removed too.
void remove_stretch(std::vector<SectionChain>& chains, double from_m, double to_m);

/// Adds a stationary Gaussian error to the half widths of a chain, independent on each side, with
/// correlation exp(-|ds| / l) along the row and the same over height. It is linear between
/// sections, so that its mean square over the surface is below std^2: 4/9 of it if sections and
/// levels are farther apart than l.
void add_surface_noise(SectionChain& chain, double std_m, double correlation_length_m,
                       RandomStream& random);

}  // namespace vinerow::mapping
