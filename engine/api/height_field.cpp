#include "engine/api/height_field.h"

#include <algorithm>
#include <cmath>

namespace vinerow {
namespace {

struct CellPoint {
  int i, j;     // sample of the cell's lower left corner
  double u, v;  // position inside the cell, 0..1
};

CellPoint locate(const HeightField& field, double x, double y) {
  const double gx = std::clamp((x - field.corner_W.x()) / field.cell_m, 0.0, field.columns - 1.0);
  const double gy = std::clamp((y - field.corner_W.y()) / field.cell_m, 0.0, field.rows - 1.0);
  const int i = std::min(static_cast<int>(gx), field.columns - 2);
  const int j = std::min(static_cast<int>(gy), field.rows - 2);
  return {i, j, gx - i, gy - j};
}

struct Corners {
  double h00, h10, h01, h11;
};

Corners corners(const HeightField& field, const CellPoint& c) {
  const std::size_t base = static_cast<std::size_t>(c.j) * field.columns + c.i;
  return {field.heights_m[base], field.heights_m[base + 1], field.heights_m[base + field.columns],
          field.heights_m[base + field.columns + 1]};
}

}  // namespace

double HeightField::height_m(double x, double y) const {
  const CellPoint c = locate(*this, x, y);
  const auto [h00, h10, h01, h11] = corners(*this, c);
  // Lower right triangle (u >= v): 00, 10, 11; upper left triangle: 00, 11, 01.
  return c.u >= c.v ? h00 + c.u * (h10 - h00) + c.v * (h11 - h10)
                    : h00 + c.v * (h01 - h00) + c.u * (h11 - h01);
}

Eigen::Vector3d HeightField::normal_W(double x, double y) const {
  if (!contains(x, y)) return Eigen::Vector3d::UnitZ();
  const CellPoint c = locate(*this, x, y);
  const auto [h00, h10, h01, h11] = corners(*this, c);
  const double dx = (c.u >= c.v ? h10 - h00 : h11 - h01) / cell_m;
  const double dy = (c.u >= c.v ? h11 - h10 : h01 - h00) / cell_m;
  return Eigen::Vector3d(-dx, -dy, 1.0).normalized();
}

}  // namespace vinerow
