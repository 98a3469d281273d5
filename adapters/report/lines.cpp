// SPDX-License-Identifier: Apache-2.0
// Lines, axes and a legend beside them.
#include "adapters/report/lines.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace kidnapwatch::adapters::report {
namespace {

constexpr double kLeft = 62.0;  // px, all of these
constexpr double kTop = 44.0;
constexpr double kSide = 380.0;
constexpr double kBottom = 52.0;
constexpr double kLegend = 350.0;
constexpr double kLegendRow = 20.0;
constexpr std::string_view kGrid = "#dfe4ea";

// Okabe and Ito's colours, which colour-blind people tell apart.
constexpr std::array<std::string_view, 7> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                                   "#56b4e9", "#b8860b", "#1c2430"};
constexpr std::array<std::string_view, 3> kDashes{"", "7 3", "2 3"};

double share(double value, const Axis& axis) {
  if (axis.least <= 0.0) return std::clamp(value, 0.0, 1.0);
  const double decades = -std::log10(axis.least);
  return std::clamp(1.0 + std::log10(std::max(value, axis.least)) / decades, 0.0, 1.0);
}

std::vector<double> ticks(const Axis& axis) {
  if (axis.least <= 0.0) return {0.0, 0.2, 0.4, 0.6, 0.8, 1.0};
  std::vector<double> powers;
  for (double power = 1.0; power > 0.99 * axis.least; power *= 0.1) powers.push_back(power);
  return powers;
}

void draw_axes(const LineFigure& figure, Svg& svg) {
  for (const double tick : ticks(figure.x)) {
    const double x = kLeft + kSide * share(tick, figure.x);
    svg.line({x, kTop}, {x, kTop + kSide}, kGrid);
    svg.text({x, kTop + kSide + 17.0}, number(tick, 6), Anchor::middle, 11.0);
  }
  for (const double tick : ticks(figure.y)) {
    const double y = kTop + kSide * (1.0 - share(tick, figure.y));
    svg.line({kLeft, y}, {kLeft + kSide, y}, kGrid);
    svg.text({kLeft - 7.0, y + 4.0}, number(tick, 6), Anchor::end, 11.0);
  }
  svg.text({kLeft + 0.5 * kSide, kTop + kSide + 38.0}, figure.x.label, Anchor::middle);
  svg.upright_text({18.0, kTop + 0.5 * kSide}, figure.y.label);
}

}  // namespace

std::string drawn(const LineFigure& figure) {
  const double legend = kTop + kLegendRow * static_cast<double>(figure.lines.size());
  Svg svg(kLeft + kSide + kLegend, std::max(kTop + kSide + kBottom, legend), figure.title);
  svg.text({16.0, 24.0}, figure.title, Anchor::start, 15.0, "font-weight: 600");
  draw_axes(figure, svg);
  for (std::size_t i = 0; i < figure.lines.size(); ++i) {
    const auto colour = kColours[i % kColours.size()];
    const auto dash = kDashes[i / kColours.size() % kDashes.size()];
    std::vector<Xy> points;
    for (const Xy& point : figure.lines[i].points) {
      points.push_back({kLeft + kSide * share(point.x, figure.x),
                        kTop + kSide * (1.0 - share(point.y, figure.y))});
    }
    svg.polyline(points, colour, 2.0, dash);
    const double y = kTop + kLegendRow * (static_cast<double>(i) + 0.5);
    svg.polyline({{kLeft + kSide + 18.0, y}, {kLeft + kSide + 46.0, y}}, colour, 2.5, dash);
    svg.text({kLeft + kSide + 54.0, y + 4.0}, figure.lines[i].label);
  }
  return svg.str();
}

}  // namespace kidnapwatch::adapters::report
