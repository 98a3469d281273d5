// SPDX-License-Identifier: Apache-2.0
// The distance transform of a grid, and rays cast with its help.
#include "core/baselines/distance_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace kidnapwatch::core::baselines {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The lower envelope of parabolas (x - at)^2 + height: what a line of cells is worth.
class Envelope {
 public:
  /// values[i] becomes the minimum over j of (i - j)^2 + values[j].
  void apply(std::vector<double>& values) {
    roots_.clear();
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] < kInfinity) add({static_cast<double>(i), values[i], -kInfinity});
    }
    if (roots_.empty()) return;
    std::size_t lowest = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto at = static_cast<double>(i);
      while (lowest + 1 < roots_.size() && roots_[lowest + 1].from <= at) ++lowest;
      const double off = at - roots_[lowest].at;
      values[i] = off * off + roots_[lowest].height;
    }
  }

 private:
  struct Parabola {
    double at;
    double height;
    double from;  // where it begins to be the lowest
  };

  void add(Parabola next) {
    while (!roots_.empty()) {
      next.from = crossing(roots_.back(), next);
      if (next.from > roots_.back().from) break;
      roots_.pop_back();
      next.from = -kInfinity;
    }
    roots_.push_back(next);
  }

  static double crossing(const Parabola& a, const Parabola& b) {
    return ((b.height + b.at * b.at) - (a.height + a.at * a.at)) / (2.0 * (b.at - a.at));
  }

  std::vector<Parabola> roots_;
};

/// A ray's way from cell to cell; lengths in cells.
class Walk {
 public:
  Walk(const GridLayout& layout, const Pose& ray)
      : x_((ray.x_m - layout.origin_x_m) / layout.cell_m),
        y_((ray.y_m - layout.origin_y_m) / layout.cell_m),
        along_x_(std::cos(ray.theta_rad)),
        along_y_(std::sin(ray.theta_rad)) {
    leap(0.0);
  }

  [[nodiscard]] long column() const { return column_; }
  [[nodiscard]] long row() const { return row_; }
  [[nodiscard]] double walked() const { return walked_; }
  /// How far the ray has walked when it leaves this cell.
  [[nodiscard]] double end() const { return std::min(end_x(), end_y()); }

  void leap(double length) {
    walked_ += length;
    column_ = static_cast<long>(std::floor(x_ + walked_ * along_x_));
    row_ = static_cast<long>(std::floor(y_ + walked_ * along_y_));
  }

  /// On to the cell that the ray comes to next.
  void step() {
    walked_ = std::max(walked_, end());
    if (end_x() < end_y()) {
      column_ += along_x_ > 0.0 ? 1 : -1;
    } else {
      row_ += along_y_ > 0.0 ? 1 : -1;
    }
  }

 private:
  [[nodiscard]] double end_x() const { return border(column_, x_, along_x_); }
  [[nodiscard]] double end_y() const { return border(row_, y_, along_y_); }
  static double border(long cell, double from, double along) {
    if (along == 0.0) return kInfinity;
    return (static_cast<double>(along > 0.0 ? cell + 1 : cell) - from) / along;
  }

  double x_;
  double y_;
  double along_x_;
  double along_y_;
  double walked_ = 0.0;
  long column_ = 0;
  long row_ = 0;
};

}  // namespace

DistanceField distance_field(const GridMap& map) {
  const GridLayout& layout = map.layout;
  std::vector<double> squares(layout.cells(), kInfinity);  // in cells
  Envelope envelope;
  std::vector<double> line(static_cast<std::size_t>(layout.rows));
  for (long column = 0; column < layout.columns; ++column) {
    for (long row = 0; row < layout.rows; ++row) {
      const bool wall = map.at(column, row) == Cell::occupied;
      line[static_cast<std::size_t>(row)] = wall ? 0.0 : kInfinity;
    }
    envelope.apply(line);
    for (long row = 0; row < layout.rows; ++row) {
      squares[layout.index(column, row)] = line[static_cast<std::size_t>(row)];
    }
  }
  DistanceField field{layout, {}};
  field.metres.reserve(layout.cells());
  for (long row = 0; row < layout.rows; ++row) {
    const auto begin = squares.begin() + row * layout.columns;
    line.assign(begin, begin + layout.columns);
    envelope.apply(line);
    for (const double square : line) {
      field.metres.push_back(static_cast<float>(layout.cell_m * std::sqrt(square)));
    }
  }
  return field;
}

double cast_ray(const DistanceField& field, const Pose& ray, double reach_m) {
  const GridLayout& layout = field.layout;
  const double reach = reach_m / layout.cell_m;
  Walk walk(layout, ray);
  while (walk.walked() < reach && layout.contains(walk.column(), walk.row())) {
    const float away_m = field.metres[layout.index(walk.column(), walk.row())];
    if (away_m == 0.0F) {
      if (walk.walked() == 0.0) return 0.0;
      const double middle = 0.5 * (walk.walked() + walk.end());
      return middle < reach ? middle * layout.cell_m : kInfinity;
    }
    // Half a diagonal from the centre to here, and another from the wall's centre to its corner.
    const double empty = static_cast<double>(away_m) / layout.cell_m - std::numbers::sqrt2 - 1e-3;
    if (empty > 1.0) {
      walk.leap(std::min(empty, reach));
    } else {
      walk.step();
    }
  }
  return kInfinity;
}

}  // namespace kidnapwatch::core::baselines
