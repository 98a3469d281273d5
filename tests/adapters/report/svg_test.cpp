// SPDX-License-Identifier: Apache-2.0
// Drawings are well-formed, escaped, and show what they are given.
#include "adapters/report/svg.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "adapters/report/html.hpp"
#include "adapters/report/intervals.hpp"
#include "adapters/report/lines.hpp"
#include "adapters/report/strips.hpp"

namespace kidnapwatch::adapters::report {
namespace {

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

TEST(Escaped, LeavesNoMarkup) {
  EXPECT_EQ(escaped("<a href=\"x\">'&'</a>"),
            "&lt;a href=&quot;x&quot;&gt;&#39;&amp;&#39;&lt;/a&gt;");
}

TEST(Fixed, HasAllItsDigits) {
  EXPECT_EQ(fixed(1.0, 2), "1.00");
  EXPECT_EQ(fixed(std::nan(""), 2), "–");
}

TEST(Number, HasNoNeedlessDigits) {
  EXPECT_EQ(number(1.5, 2), "1.5");
  EXPECT_EQ(number(2.0, 2), "2");
  EXPECT_EQ(number(-0.001, 2), "0");
  EXPECT_EQ(number(0.126, 2), "0.13");
  EXPECT_EQ(number(100.0, 0), "100");
  EXPECT_EQ(number(std::nan(""), 2), "–");
  EXPECT_EQ(number(std::numeric_limits<double>::infinity(), 2), "–");
}

StripFigure one_strip(std::vector<double> values) {
  return {"Figure <1>", "step",   3.0,
          "eta",        {"mean"}, {{"map", {{"a & b", std::move(values), {"0.5"}}}}}};
}

TEST(Strips, AreBlackExactlyWhereAValueIsNotPositive) {
  const std::string none = drawn(one_strip({0.1, 0.5, 1.0}));
  const std::string three = drawn(one_strip({0.0, -0.5, std::nan(""), 1.0, 0.2}));
  EXPECT_EQ(count(none, "#000000"), 1U);  // the legend's
  EXPECT_EQ(count(three, "#000000"), 4U);
}

TEST(Strips, TakeAllValuesAndNoMarkup) {
  const std::string svg = drawn(one_strip(std::vector<double>(98, 0.5)));
  EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
  EXPECT_NE(svg.find("Figure &lt;1&gt;"), std::string::npos);
  EXPECT_GE(count(svg, "<rect"), 98U);
  EXPECT_EQ(count(svg, "<svg"), count(svg, "</svg>"));
  EXPECT_NE(svg.find(">100</text>"), std::string::npos);  // the last tick: t_k = 3..100
  EXPECT_EQ(count(drawn(StripFigure{}), "</svg>"), 1U);
}

TEST(Lines, AreDrawnWithinTheirAxes) {
  const LineFigure figure{
      "ROC", {"fpr", 1e-3}, {"tpr", 0.0}, {{"one", {{0.0, 0.0}, {1e-3, 0.5}, {1.0, 1.0}}}}};
  const std::string svg = drawn(figure);
  EXPECT_EQ(count(svg, "<polyline"), 2U);  // the line, and its sample in the legend
  EXPECT_NE(svg.find("points=\"62,424 62,234 442,44\""), std::string::npos) << svg;
}

TEST(Html, EscapesTextAndKeepsFigures) {
  Html page("T < 1");
  page.heading("H & h");
  page.paragraph("p");
  page.table({{"a"}, {{"<b>"}}});
  page.figure("<svg></svg>", "c");
  const std::string html = page.str();
  EXPECT_NE(html.find("<title>T &lt; 1</title>"), std::string::npos);
  EXPECT_NE(html.find("<td>&lt;b&gt;</td>"), std::string::npos);
  EXPECT_NE(html.find("<figure><svg></svg>"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos);  // needs no other file
}

TEST(Intervals, ShowEveryValueAndLeaveOutWhatIsNotThere) {
  const IntervalFigure figure{"Found",
                              "share",
                              0.5,
                              {"one", "two"},
                              {{"far & wide", {Interval{0.25, 0.2, 0.3}, {}}},
                               {"near", {Interval{0.125, 0.1, 0.2}, Interval{0.75, 0.6, 0.9}}}}};
  const std::string svg = drawn(figure);
  for (const char* part : {"far &amp; wide", "0.250", "0.125", "0.750", "–", "▸"})
    EXPECT_NE(svg.find(part), std::string::npos) << part;
  EXPECT_EQ(count(svg, "▸"), 1U);  // only what the axis does not reach
  EXPECT_EQ(count(svg, "<svg"), count(svg, "</svg>"));
}

}  // namespace
}  // namespace kidnapwatch::adapters::report
