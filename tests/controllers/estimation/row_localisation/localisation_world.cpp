#include "tests/controllers/estimation/row_localisation/localisation_world.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vinerow::test {
namespace {

constexpr double kFirst_m = -10.0;
constexpr double kErrorStep_m = 0.03;
constexpr double kLevels_m[4] = {0.5, 1.0, 1.5, 2.0};
constexpr double kHalfWidths_m[4] = {0.24, 0.31, 0.29, 0.18};

}  // namespace

LocalisationWorld::LocalisationWorld(const LocalisationWorldSetup& setup, std::uint64_t seed)
    : setup_(setup),
      along_W_(std::cos(setup.azimuth_rad), std::sin(setup.azimuth_rad), 0.0),
      left_W_(-std::sin(setup.azimuth_rad), std::cos(setup.azimuth_rad), 0.0) {
  RandomStream shape(seed, "world", "sections"), error(seed, "world", "surface");
  for (int row = 0; row < setup_.rows; ++row) sections_.push_back(draw_row(row, shape));
  const auto count = static_cast<std::size_t>(setup_.length_m / kErrorStep_m) + 2;
  const double keep = std::exp(-kErrorStep_m / setup_.correlation_length_m);
  for (int wall = 0; wall < 2 * setup_.rows; ++wall) {
    std::vector<double> values{setup_.surface_std_m * error.normal()};
    while (values.size() < count) {
      values.push_back(keep * values.back() +
                       setup_.surface_std_m * std::sqrt(1.0 - keep * keep) * error.normal());
    }
    errors_.push_back(std::move(values));
  }
  map_ = make_map(setup_.map_gaps, setup_.map_offset_W);
  truth_ = make_map(setup_.true_gaps, Eigen::Vector3d::Zero());
  map_index_ = std::make_unique<controllers::RowMeshIndex>(map_);
  truth_index_ = std::make_unique<controllers::RowMeshIndex>(truth_);
}

Eigen::Vector3d LocalisationWorld::place(double s, double t, double h) const {
  Eigen::Vector3d p = s * along_W_ + t * left_W_;
  p.z() = setup_.grade_along * s + setup_.grade_across * t + h;
  return p;
}

std::vector<LocalisationWorld::Section> LocalisationWorld::draw_row(int row,
                                                                    RandomStream& random) const {
  std::vector<Section> sections;
  const double last = kFirst_m + setup_.length_m;
  for (double s = kFirst_m;;) {
    Section section;
    section.s = std::min(s, last);
    const double centre = row_t(row) + setup_.centre_std_m * random.normal();
    double half[4] = {};
    for (int side = 0; side < 2; ++side) {
      if (side == 0 || !setup_.symmetric) {
        const double wall = setup_.wall_std_m * random.normal();
        for (int level = 0; level < 4; ++level) {
          half[level] =
              std::max(0.03, kHalfWidths_m[level] + wall + setup_.level_std_m * random.normal());
        }
      }
      for (int level = 0; level < 4; ++level) {
        section.t[side][level] = centre + (side == 1 ? half[level] : -half[level]);
      }
    }
    sections.push_back(section);
    if (s >= last) return sections;
    s += random.uniform(setup_.section_min_m, setup_.section_max_m);
  }
}

LocalisationWorld::Section LocalisationWorld::section_at(int row, double s) const {
  const auto& sections = sections_[row];
  const auto after = std::upper_bound(sections.begin(), sections.end() - 1, s,
                                      [](double at, const Section& b) { return at < b.s; });
  const Section& b = *std::max(after, sections.begin() + 1);
  const Section& a = *(std::max(after, sections.begin() + 1) - 1);
  const double share = std::clamp((s - a.s) / (b.s - a.s), 0.0, 1.0);
  Section section;
  section.s = s;
  for (int side = 0; side < 2; ++side) {
    for (int level = 0; level < 4; ++level) {
      section.t[side][level] = a.t[side][level] + share * (b.t[side][level] - a.t[side][level]);
    }
  }
  return section;
}

double LocalisationWorld::wall_t(int row, int side, double s, double h) const {
  const Section section = section_at(row, s);
  const double level = std::clamp((h - kLevels_m[0]) / 0.5, 0.0, 3.0);
  const int below = std::min(2, static_cast<int>(level));
  const double* t = section.t[side > 0 ? 1 : 0];
  return t[below] + (level - below) * (t[below + 1] - t[below]);
}

void LocalisationWorld::add_piece(RowMesh& mesh, int row, double from_m, double to_m,
                                  const Eigen::Vector3d& offset_W) const {
  std::vector<Section> sections{section_at(row, from_m)};
  for (const Section& section : sections_[row]) {
    if (section.s > from_m + 1e-3 && section.s < to_m - 1e-3) sections.push_back(section);
  }
  sections.push_back(section_at(row, to_m));
  TriangleMesh& hull = mesh.mesh_W;
  const auto first = static_cast<std::uint32_t>(hull.vertices.size());
  for (const Section& section : sections) {
    // Up the left wall, over the top, down the right one.
    for (int j = 0; j < 8; ++j) {
      const int side = j < 4 ? 1 : 0, level = j < 4 ? j : 7 - j;
      const Eigen::Vector3d p_W =
          place(section.s, section.t[side][level], kLevels_m[level]) + offset_W;
      hull.vertices.push_back(p_W.cast<float>());
    }
  }
  const auto end = first + 8 * static_cast<std::uint32_t>(sections.size() - 1);
  for (std::uint32_t ring = first; ring < end; ring += 8) {
    for (std::uint32_t j = 0; j < 8; ++j) {
      const std::uint32_t a = ring + j, d = ring + (j + 1) % 8;
      hull.triangles.push_back({a, d, d + 8});
      hull.triangles.push_back({a, d + 8, a + 8});
    }
  }
  for (std::uint32_t j = 1; j < 7; ++j) {
    hull.triangles.push_back({first, first + j + 1, first + j});
    hull.triangles.push_back({end, end + j, end + j + 1});
  }
}

RowMap LocalisationWorld::make_map(const std::vector<Gap>& gaps,
                                   const Eigen::Vector3d& offset_W) const {
  RowMap map;
  const double last = kFirst_m + setup_.length_m;
  for (int row = 0; row < setup_.rows; ++row) {
    PlantRow plants;
    plants.id = row;
    plants.line_W = {place(kFirst_m, row_t(row), 0) + offset_W,
                     place(last, row_t(row), 0) + offset_W};
    map.rows.push_back(plants);
    RowMesh mesh;
    mesh.row = row;
    std::vector<Gap> own;
    for (const Gap& gap : gaps) {
      if (gap.row == row) own.push_back(gap);
    }
    std::sort(own.begin(), own.end(),
              [](const Gap& a, const Gap& b) { return a.from_m < b.from_m; });
    double from = kFirst_m;
    for (const Gap& gap : own) {
      add_piece(mesh, row, from, gap.from_m, offset_W);
      from = gap.to_m;
    }
    add_piece(mesh, row, from, last, offset_W);
    map.meshes.push_back(std::move(mesh));
    if (row + 1 == setup_.rows) break;
    const double t = row_t(row) + 0.5 * setup_.spacing_m;
    map.alleys.push_back({row, {place(kFirst_m, t, 0), place(last, t, 0)}, setup_.spacing_m});
  }
  map.accuracy.surface_std_m =
      setup_.stated_surface_std_m < 0.0 ? setup_.surface_std_m : setup_.stated_surface_std_m;
  map.accuracy.correlation_length_m = setup_.correlation_length_m;
  return map;
}

double LocalisationWorld::surface_error(int row, int side, double s) const {
  const std::vector<double>& values = errors_[2 * row + side];
  const double at = std::clamp((s - kFirst_m) / kErrorStep_m, 0.0, values.size() - 1.001);
  const auto i = static_cast<std::size_t>(at);
  return values[i] + (at - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

double LocalisationWorld::true_range(const Eigen::Vector3d& p_W, const Eigen::Vector3d& dir_W,
                                     double max_range_m) const {
  const auto hit = truth_index_->cast_ray(p_W, dir_W, max_range_m + 0.5);
  if (!hit) return std::numeric_limits<double>::infinity();
  const Eigen::Vector3d at_W = p_W + hit->distance_m * dir_W;
  const int side = hit->normal_W.dot(left_W_) > 0.0 ? 1 : 0;
  // The true wall lies e further out along its normal.
  const double e = surface_error(hit->row, side, at_W.dot(along_W_));
  const double slope = std::max(0.1, -hit->normal_W.dot(dir_W));
  const double range = hit->distance_m - e / slope;
  return range > max_range_m ? std::numeric_limits<double>::infinity() : std::max(0.0, range);
}

}  // namespace vinerow::test
