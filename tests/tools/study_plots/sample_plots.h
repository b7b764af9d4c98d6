#pragma once
/// Plots of an invented study, of every kind: what tests check and people look at.

#include <string>

namespace vinerow::study::testing {

/// A page with all of them, well formed as XML. The same bytes every time.
std::string sample_page();

}  // namespace vinerow::study::testing
