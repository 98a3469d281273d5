// SPDX-License-Identifier: Apache-2.0
// Shapes as SVG elements.
#include "adapters/report/svg.hpp"

#include <cmath>
#include <cstdio>

namespace kidnapwatch::adapters::report {
namespace {

std::string_view name(Anchor anchor) {
  if (anchor == Anchor::middle) return "middle";
  return anchor == Anchor::end ? "end" : "start";
}

/// ` name="1.5"`
std::string attribute(std::string_view name, double value) {
  return " " + std::string(name) + "=\"" + number(value, 2) + "\"";
}

std::string attribute(std::string_view name, std::string_view value) {
  return " " + std::string(name) + "=\"" + escaped(value) + "\"";
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      case '\'':
        result += "&#39;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string fixed(double value, int decimals) {
  if (!std::isfinite(value)) return "–";
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string number(double value, int decimals) {
  std::string result = fixed(value, decimals);
  if (result.find('.') != std::string::npos) {
    result.erase(result.find_last_not_of('0') + 1);
    if (result.back() == '.') result.pop_back();
  }
  return result == "-0" ? "0" : result;
}

Svg::Svg(double width, double height, std::string_view title)
    : body_("<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" viewBox=\"0 0 " +
            number(width, 2) + " " + number(height, 2) + "\"" + attribute("width", width) +
            attribute("height", height) +
            " font-family=\"system-ui, 'DejaVu Sans', sans-serif\" fill=\"#1c2430\">\n<title>" +
            escaped(title) + "</title>\n") {
  rectangle({0.0, 0.0}, width, height, "#ffffff");
}

void Svg::rectangle(Xy corner, double width, double height, std::string_view fill) {
  body_ += "<rect" + attribute("x", corner.x) + attribute("y", corner.y) +
           attribute("width", width) + attribute("height", height) + attribute("fill", fill) +
           "/>\n";
}

void Svg::line(Xy from, Xy to, std::string_view colour, double width) {
  body_ += "<line" + attribute("x1", from.x) + attribute("y1", from.y) + attribute("x2", to.x) +
           attribute("y2", to.y) + attribute("stroke", colour) + attribute("stroke-width", width) +
           "/>\n";
}

void Svg::polyline(const std::vector<Xy>& points, std::string_view colour, double width,
                   std::string_view dash) {
  std::string path;
  for (const Xy& point : points) {
    path += (path.empty() ? "" : " ") + number(point.x, 2) + "," + number(point.y, 2);
  }
  body_ += "<polyline fill=\"none\" stroke-linejoin=\"round\"" + attribute("points", path) +
           attribute("stroke", colour) + attribute("stroke-width", width) +
           (dash.empty() ? "" : attribute("stroke-dasharray", dash)) + "/>\n";
}

void Svg::text(Xy at, std::string_view text, Anchor anchor, double size, std::string_view style) {
  body_ += "<text" + attribute("x", at.x) + attribute("y", at.y) + attribute("font-size", size) +
           attribute("text-anchor", name(anchor)) +
           (style.empty() ? "" : attribute("style", style)) + ">" + escaped(text) + "</text>\n";
}

void Svg::upright_text(Xy at, std::string_view text, double size) {
  body_ += "<text text-anchor=\"middle\"" + attribute("font-size", size) +
           attribute("transform",
                     "translate(" + number(at.x, 2) + " " + number(at.y, 2) + ") rotate(-90)") +
           ">" + escaped(text) + "</text>\n";
}

}  // namespace kidnapwatch::adapters::report
