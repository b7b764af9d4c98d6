#include "tools/pictures/map_truth.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vinerow::tools {

std::string comparison_text(const mapping::MapComparison& c, const mapping::CloudMap& map,
                            const mapping::CloudTruth& truth) {
  std::string out = "against the truth\n";
  out +=
      fmt::format("  rows found     {} of {}{}\n", c.found(), c.rows.size(),
                  c.extra_rows.empty() ? ""
                                       : fmt::format(", and {} false rows: {}", c.extra_rows.size(),
                                                     fmt::join(c.extra_rows, ", ")));
  out +=
      fmt::format("  direction      {:+.4f} deg of {:.4f} deg\n", c.bearing_deg, truth.bearing_deg);
  out += fmt::format("  spacing        {:+.4f} m of {:.4f} m\n", c.spacing_m, truth.spacing_m);
  out += fmt::format("  row ends       {:.3f} m mean error, {:.3f} m maximum\n", c.mean_end_m(),
                     c.worst_end_m());
  out += fmt::format("  volume         {:+.2f} % of {:.2f} m3; canopy seen {:+.2f} %\n",
                     100.0 * c.volume_share, truth.volume_m3, 100.0 * c.seen_volume_share);
  out += fmt::format("  containment    {:.2f} % within 1 cm\n", 100.0 * map.report.containment);
  out += fmt::format("  {:>4} {:>6} {:>9} {:>8} {:>8} {:>8} {:>7} {:>7} {:>7} {:>8} {:>9}\n", "row",
                     "mapped", "bearing", "first", "last", "length", "base", "top", "width",
                     "volume", "gaps");
  out += fmt::format("  {:>4} {:>6} {:>9} {:>8} {:>8} {:>8} {:>7} {:>7} {:>7} {:>8} {:>9}\n", "",
                     "as", "deg", "m", "m", "m", "m", "m", "m", "%", "of true");
  for (const mapping::RowComparison& r : c.rows) {
    if (r.mapped_row < 0) {
      out += fmt::format("  {:>4} {:>6}\n", r.true_row, "none");
      continue;
    }
    out += fmt::format(
        "  {:>4} {:>6} {:>+9.4f} {:>8.3f} {:>8.3f} {:>+8.3f} {:>+7.3f} {:>+7.3f} {:>+7.3f} "
        "{:>+8.2f} {:>9}\n",
        r.true_row, r.mapped_row, r.bearing_deg, r.first_m, r.last_m, r.length_m, r.base_m, r.top_m,
        r.width_m, 100.0 * r.volume_share, fmt::format("{} of {}", r.gaps, r.true_gaps));
  }
  return out;
}

}  // namespace vinerow::tools
