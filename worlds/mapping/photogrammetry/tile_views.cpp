#include "worlds/mapping/photogrammetry/tile_views.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vinerow::mapping {

TileViews find_tile_views(const std::vector<SurveyView>& views, const Eigen::Vector3d& centre_W,
                          double radius_m, double min_angle_rad, int max_partners) {
  TileViews tile;
  std::vector<Eigen::Vector3d> rays;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!views[i].may_show(centre_W, radius_m)) continue;
    tile.shown_in.push_back(static_cast<int>(i));
    tile.whole.push_back(views[i].shows_all(centre_W, radius_m));
    rays.push_back((centre_W - views[i].p_WS()).normalized());
  }
  const double max_cosine = std::cos(min_angle_rad);
  std::vector<std::pair<double, std::uint16_t>> order;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    order.clear();
    for (std::size_t k = 0; k < rays.size(); ++k) {
      const double cosine = rays[i].dot(rays[k]);
      if (k != i && cosine <= max_cosine)
        order.emplace_back(-cosine, static_cast<std::uint16_t>(k));
    }
    const std::size_t count = std::min(order.size(), static_cast<std::size_t>(max_partners));
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
                      order.end());
    std::vector<std::uint16_t>& partners = tile.partners.emplace_back();
    for (std::size_t k = 0; k < count; ++k) partners.push_back(order[k].second);
  }
  return tile;
}

}  // namespace vinerow::mapping
