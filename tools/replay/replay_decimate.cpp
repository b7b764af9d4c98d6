#include "tools/replay/replay_decimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "engine/core/check.h"

namespace vinerow::tools {

TriangleMesh cluster_vertices(const TriangleMesh& mesh, double cell_m) {
  VINEROW_DEMAND(cell_m > 0.0);
  const bool coloured = mesh.colours.size() == mesh.vertices.size();
  TriangleMesh out;
  std::vector<std::uint32_t> cluster(mesh.vertices.size());
  std::vector<float> members;
  std::map<std::array<long, 3>, std::uint32_t> cells;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3d scaled = mesh.vertices[i].cast<double>() / cell_m;
    const std::array<long, 3> key = {std::lround(std::floor(scaled.x())),
                                     std::lround(std::floor(scaled.y())),
                                     std::lround(std::floor(scaled.z()))};
    const auto [place, is_new] =
        cells.try_emplace(key, static_cast<std::uint32_t>(out.vertices.size()));
    if (is_new) {
      out.vertices.push_back(Eigen::Vector3f::Zero());
      if (coloured) out.colours.push_back(Eigen::Vector3f::Zero());
      members.push_back(0.0f);
    }
    cluster[i] = place->second;
    // Running mean: sums of large coordinates would lose digits.
    const float share = 1.0f / (members[place->second] += 1.0f);
    Eigen::Vector3f& mean = out.vertices[place->second];
    mean += share * (mesh.vertices[i] - mean);
    if (coloured) {
      Eigen::Vector3f& colour = out.colours[place->second];
      colour += share * (mesh.colours[i] - colour);
    }
  }
  std::set<std::array<std::uint32_t, 3>> known;
  for (const auto& t : mesh.triangles) {
    if (std::max({t[0], t[1], t[2]}) >= mesh.vertices.size()) continue;
    std::array<std::uint32_t, 3> corners = {cluster[t[0]], cluster[t[1]], cluster[t[2]]};
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    if (known.insert(corners).second) out.triangles.push_back(corners);
  }
  return out;
}

TriangleMesh thin_cards(const TriangleMesh& mesh, int keep_every) {
  VINEROW_DEMAND(keep_every >= 1);
  if (keep_every == 1) return mesh;
  const float growth = std::sqrt(static_cast<float>(keep_every));
  TriangleMesh out;
  std::size_t card = 0;
  for (std::size_t begin = 0; begin < mesh.triangles.size(); ++card) {
    // The vertices of a card's triangles are one range that no other card uses.
    auto [first, last] =
        std::minmax({mesh.triangles[begin][0], mesh.triangles[begin][1], mesh.triangles[begin][2]});
    std::size_t end = begin + 1;
    for (; end < mesh.triangles.size(); ++end) {
      const auto& t = mesh.triangles[end];
      if (std::min({t[0], t[1], t[2]}) > last || std::max({t[0], t[1], t[2]}) < first) break;
      first = std::min({first, t[0], t[1], t[2]});
      last = std::max({last, t[0], t[1], t[2]});
    }
    if (card % static_cast<std::size_t>(keep_every) == 0 && last < mesh.vertices.size()) {
      Eigen::Vector3f middle = Eigen::Vector3f::Zero();
      for (std::uint32_t i = first; i <= last; ++i) middle += mesh.vertices[i];
      middle /= static_cast<float>(last - first + 1);
      const auto shift = static_cast<std::uint32_t>(out.vertices.size());
      for (std::uint32_t i = first; i <= last; ++i) {
        out.vertices.push_back(middle + growth * (mesh.vertices[i] - middle));
        if (!mesh.normals.empty()) out.normals.push_back(mesh.normals[i]);
        if (!mesh.uvs.empty()) out.uvs.push_back(mesh.uvs[i]);
        if (!mesh.colours.empty()) out.colours.push_back(mesh.colours[i]);
      }
      for (std::size_t k = begin; k < end; ++k) {
        const auto& t = mesh.triangles[k];
        out.triangles.push_back({t[0] - first + shift, t[1] - first + shift, t[2] - first + shift});
      }
    }
    begin = end;
  }
  return out;
}

namespace {

int samples_with(int samples, int stride) {
  return (samples - 2) / stride + 2;
}

float sample(const HeightField& field, int i, int j) {
  i = std::min(i, field.columns - 1);
  j = std::min(j, field.rows - 1);
  return field.heights_m[static_cast<std::size_t>(j) * field.columns + i];
}

}  // namespace

int stride_for(const HeightField& field, int max_samples) {
  VINEROW_DEMAND(max_samples >= 9);
  int stride = 1;
  while (static_cast<std::int64_t>(samples_with(field.columns, stride)) *
             samples_with(field.rows, stride) >
         max_samples) {
    ++stride;
  }
  return stride;
}

HeightField thin_height_field(const HeightField& field, int stride) {
  VINEROW_DEMAND(stride >= 1);
  HeightField out;
  out.columns = samples_with(field.columns, stride);
  out.rows = samples_with(field.rows, stride);
  out.cell_m = stride * field.cell_m;
  out.corner_W = field.corner_W;
  for (int j = 0; j < out.rows; ++j) {
    for (int i = 0; i < out.columns; ++i) {
      out.heights_m.push_back(sample(field, i * stride, j * stride));
    }
  }
  return out;
}

HeightField crop_height_field(const HeightField& field, const Eigen::Vector2i& first,
                              const Eigen::Vector2i& last) {
  VINEROW_DEMAND(first.x() >= 0 && first.y() >= 0 && last.x() < field.columns &&
                 last.y() < field.rows && first.x() < last.x() && first.y() < last.y());
  HeightField out;
  out.columns = last.x() - first.x() + 1;
  out.rows = last.y() - first.y() + 1;
  out.cell_m = field.cell_m;
  out.corner_W = field.corner_W + field.cell_m * first.cast<double>();
  for (int j = first.y(); j <= last.y(); ++j) {
    for (int i = first.x(); i <= last.x(); ++i) out.heights_m.push_back(sample(field, i, j));
  }
  return out;
}

}  // namespace vinerow::tools
