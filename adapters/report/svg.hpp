// SPDX-License-Identifier: Apache-2.0
// An SVG drawing, put together shape by shape.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kidnapwatch::adapters::report {

/// `text` with & < > " ' replaced, for XML and HTML.
[[nodiscard]] std::string escaped(std::string_view text);

/// With exactly as many decimals; "–" if it is not finite.
[[nodiscard]] std::string fixed(double value, int decimals);

/// With at most as many decimals, and no needless 0; "–" if it is not finite.
[[nodiscard]] std::string number(double value, int decimals);

enum class Anchor { start, middle, end };

struct Xy {
  double x = 0.0;
  double y = 0.0;
};

/// Lengths in px from the upper left corner. Colours as in CSS.
class Svg {
 public:
  Svg(double width, double height, std::string_view title);

  void rectangle(Xy corner, double width, double height, std::string_view fill);
  void line(Xy from, Xy to, std::string_view colour, double width = 1.0);
  /// `dash` as in stroke-dasharray; empty for a solid line.
  void polyline(const std::vector<Xy>& points, std::string_view colour, double width,
                std::string_view dash);
  void text(Xy at, std::string_view text, Anchor anchor = Anchor::start, double size = 12.0,
            std::string_view style = {});
  /// Read from bottom to top.
  void upright_text(Xy at, std::string_view text, double size = 12.0);

  /// The drawing, complete.
  [[nodiscard]] std::string str() const { return body_ + "</svg>\n"; }

 private:
  std::string body_;
};

}  // namespace kidnapwatch::adapters::report
