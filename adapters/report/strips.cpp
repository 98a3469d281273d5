// SPDX-License-Identifier: Apache-2.0
// Strips, their axis and the legend of their colours.
#include "adapters/report/strips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "adapters/report/svg.hpp"

namespace kidnapwatch::adapters::report {
namespace {

constexpr double kLabels = 190.0;  // px, all of these
constexpr double kStrip = 560.0;
constexpr double kNote = 78.0;
constexpr double kMargin = 16.0;
constexpr double kTop = 62.0;
constexpr double kRow = 20.0;
constexpr double kGap = 3.0;
constexpr double kGroupHead = 26.0;
constexpr double kAxis = 44.0;
constexpr double kTickEvery = 10.0;
constexpr std::string_view kGrey = "#5b6675";

/// From pale yellow over green to deep teal: lightness falls all the way, black stays apart.
std::string colour(double value) {
  if (!(value > 0.0)) return "#000000";
  struct Rgb {
    double r, g, b;
  };
  constexpr std::array<Rgb, 4> kStops{
      {{255, 246, 196}, {168, 221, 160}, {67, 172, 152}, {14, 104, 122}}};
  const double at = std::min(value, 1.0) * static_cast<double>(kStops.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kStops.size() - 2);
  const double share = at - static_cast<double>(low);
  const auto mixed = [&](double Rgb::*part) {
    return static_cast<int>(
        std::lround((1.0 - share) * (kStops[low].*part) + share * (kStops[low + 1].*part)));
  };
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", mixed(&Rgb::r), mixed(&Rgb::g), mixed(&Rgb::b));
  return text;
}

std::size_t longest(const StripFigure& figure) {
  std::size_t cells = 1;
  for (const auto& group : figure.groups) {
    for (const auto& strip : group.strips) cells = std::max(cells, strip.values.size());
  }
  return cells;
}

double height(const StripFigure& figure) {
  double rows = kTop + kAxis;
  for (const auto& group : figure.groups) {
    rows += kGroupHead + kRow * static_cast<double>(group.strips.size());
  }
  return rows;
}

void draw_strip(const Strip& strip, double y, double cell, Svg& svg) {
  svg.text({kMargin + kLabels - 10.0, y + 13.0}, strip.label, Anchor::end, 12.0);
  for (std::size_t i = 0; i < strip.values.size(); ++i) {
    svg.rectangle({kMargin + kLabels + cell * static_cast<double>(i), y}, cell + 0.25, kRow - kGap,
                  colour(strip.values[i]));
  }
  for (std::size_t i = 0; i < strip.notes.size(); ++i) {
    svg.text({kMargin + kLabels + kStrip + kNote * (static_cast<double>(i) + 0.85), y + 13.0},
             strip.notes[i], Anchor::end, 12.0, "font-variant-numeric: tabular-nums");
  }
}

void draw_axis(const StripFigure& figure, double y, double cell, std::size_t cells, Svg& svg) {
  const double last_x = figure.first_x + static_cast<double>(cells - 1);
  for (double x = std::ceil(figure.first_x / kTickEvery) * kTickEvery; x <= last_x;
       x += kTickEvery) {
    const double at = kMargin + kLabels + cell * (x - figure.first_x + 0.5);
    svg.line({at, y}, {at, y + 5.0}, kGrey);
    svg.text({at, y + 18.0}, number(x, 0), Anchor::middle, 11.0);
  }
  svg.text({kMargin + kLabels + 0.5 * kStrip, y + 36.0}, figure.x_label, Anchor::middle, 12.0);
}

void draw_legend(const StripFigure& figure, Svg& svg) {
  constexpr double kSteps = 60.0;
  constexpr double kWidth = 150.0;
  const double x = kMargin + kLabels;
  for (double i = 0.0; i < kSteps; i += 1.0) {
    svg.rectangle({x + 62.0 + kWidth * i / kSteps, 38.0}, kWidth / kSteps + 0.25, 10.0,
                  colour((i + 0.5) / kSteps));
  }
  svg.rectangle({x, 38.0}, 14.0, 10.0, "#000000");
  svg.text({x + 19.0, 47.0}, "≤ 0", Anchor::start, 11.0);
  svg.text({x + 54.0, 47.0}, "0", Anchor::middle, 11.0);
  svg.text({x + 62.0 + kWidth + 6.0, 47.0}, "1   " + figure.scale_label, Anchor::start, 11.0);
}

}  // namespace

std::string drawn(const StripFigure& figure) {
  const double notes = kNote * static_cast<double>(figure.columns.size());
  Svg svg(2.0 * kMargin + kLabels + kStrip + notes, height(figure), figure.title);
  svg.text({kMargin, 24.0}, figure.title, Anchor::start, 15.0, "font-weight: 600");
  draw_legend(figure, svg);
  for (std::size_t i = 0; i < figure.columns.size(); ++i) {
    svg.text({kMargin + kLabels + kStrip + kNote * (static_cast<double>(i) + 0.85), 47.0},
             figure.columns[i], Anchor::end, 11.0);
  }
  const std::size_t cells = longest(figure);
  const double cell = kStrip / static_cast<double>(cells);
  double y = kTop;
  for (const StripGroup& group : figure.groups) {
    svg.text({kMargin, y + 17.0}, group.title, Anchor::start, 12.5, "font-weight: 600");
    y += kGroupHead;
    for (const Strip& strip : group.strips) {
      draw_strip(strip, y, cell, svg);
      y += kRow;
    }
  }
  draw_axis(figure, y, cell, cells, svg);
  return svg.str();
}

}  // namespace kidnapwatch::adapters::report
