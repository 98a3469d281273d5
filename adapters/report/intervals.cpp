// SPDX-License-Identifier: Apache-2.0
// Dots, whiskers and the numbers beside them.
#include "adapters/report/intervals.hpp"

#include <algorithm>
#include <array>

#include "adapters/report/svg.hpp"

namespace kidnapwatch::adapters::report {
namespace {

constexpr double kMargin = 16.0;  // px, all of these
constexpr double kLabels = 150.0;
constexpr double kAxis = 470.0;
constexpr double kNote = 62.0;
constexpr double kTop = 84.0;
constexpr double kLine = 11.0;  // for each series of a row
constexpr double kRowGap = 9.0;
constexpr double kBottom = 46.0;
constexpr double kDot = 7.0;
constexpr std::string_view kGrid = "#dfe4ea";
constexpr int kTicks = 5;

// Okabe and Ito's colours, which colour-blind people tell apart.
constexpr std::array<std::string_view, 4> kColours{"#0072b2", "#d55e00", "#009e73", "#cc79a7"};

double row_height(const IntervalFigure& figure) {
  return kLine * static_cast<double>(figure.series.size()) + kRowGap;
}

double x_of(double value, const IntervalFigure& figure) {
  return kMargin + kLabels + kAxis * std::min(value / figure.reach, 1.0);
}

void draw_legend(const IntervalFigure& figure, Svg& svg) {
  double x = kMargin;
  for (std::size_t i = 0; i < figure.series.size(); ++i) {
    svg.rectangle({x, 41.0}, kDot + 2.0, kDot + 2.0, kColours.at(i % kColours.size()));
    svg.text({x + 15.0, 50.0}, figure.series[i], Anchor::start, 12.0);
    x += 42.0 + 7.2 * static_cast<double>(figure.series[i].size());
  }
}

void draw_axis(const IntervalFigure& figure, double bottom, Svg& svg) {
  for (int i = 0; i <= kTicks; ++i) {
    const double value = figure.reach * i / kTicks;
    const double x = x_of(value, figure);
    svg.line({x, kTop - 8.0}, {x, bottom}, kGrid);
    svg.text({x, bottom + 16.0}, number(value, 3), Anchor::middle, 11.0);
  }
  svg.text({x_of(0.5 * figure.reach, figure), bottom + 35.0}, figure.x_label, Anchor::middle, 12.0);
}

void draw(const Interval& one, double y, std::string_view colour, const IntervalFigure& figure,
          Svg& svg) {
  svg.line({x_of(one.low, figure), y}, {x_of(one.high, figure), y}, colour, 1.5);
  const double x = x_of(one.value, figure);
  if (one.value > figure.reach) {
    svg.text({x + 3.0, y + 4.0}, "▸", Anchor::start, 12.0);
  } else {
    svg.rectangle({x - 0.5 * kDot, y - 0.5 * kDot}, kDot, kDot, colour);
  }
}

void draw_row(const IntervalRow& row, double y, const IntervalFigure& figure, Svg& svg) {
  const double middle = y + 0.5 * kLine * static_cast<double>(figure.series.size());
  svg.text({kMargin + kLabels - 10.0, middle + 4.0}, row.label, Anchor::end, 12.0);
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    const double note_x =
        kMargin + kLabels + kAxis + kMargin + kNote * (static_cast<double>(i) + 0.85);
    svg.text({note_x, middle + 4.0}, row.values[i] ? fixed(row.values[i]->value, 3) : "–",
             Anchor::end, 12.0, "font-variant-numeric: tabular-nums");
    if (row.values[i])
      draw(*row.values[i], y + kLine * (static_cast<double>(i) + 0.5),
           kColours.at(i % kColours.size()), figure, svg);
  }
}

}  // namespace

std::string drawn(const IntervalFigure& figure) {
  const double bottom = kTop + row_height(figure) * static_cast<double>(figure.rows.size());
  const double notes = kNote * static_cast<double>(figure.series.size());
  Svg svg(3.0 * kMargin + kLabels + kAxis + notes, bottom + kBottom, figure.title);
  svg.text({kMargin, 24.0}, figure.title, Anchor::start, 15.0, "font-weight: 600");
  draw_legend(figure, svg);
  draw_axis(figure, bottom, svg);
  for (std::size_t i = 0; i < figure.series.size(); ++i) {
    const double x = kMargin + kLabels + kAxis + kMargin + kNote * (static_cast<double>(i) + 0.85);
    svg.rectangle({x - kDot - 2.0, kTop - 20.0}, kDot + 2.0, kDot + 2.0,
                  kColours.at(i % kColours.size()));
  }
  for (std::size_t i = 0; i < figure.rows.size(); ++i)
    draw_row(figure.rows[i], kTop + row_height(figure) * static_cast<double>(i), figure, svg);
  return svg.str();
}

}  // namespace kidnapwatch::adapters::report
