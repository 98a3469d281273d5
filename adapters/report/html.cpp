// SPDX-License-Identifier: Apache-2.0
// HTML, escaped, with its style in its head.
#include "adapters/report/html.hpp"

#include "adapters/report/svg.hpp"

namespace kidnapwatch::adapters::report {
namespace {

constexpr std::string_view kStyle = R"(
body { margin: 0; background: #f3f5f7; color: #1c2430;
       font: 16px/1.55 system-ui, 'DejaVu Sans', sans-serif; }
main { max-width: 1100px; margin: 0 auto; padding: 24px 32px 64px; background: #fff; }
h1 { font-size: 1.7rem; line-height: 1.25; }
h2 { font-size: 1.25rem; margin-top: 2.4rem; padding-top: .8rem; border-top: 1px solid #dfe4ea; }
p { max-width: 75ch; }
table { border-collapse: collapse; margin: 1rem 0; font-size: .875rem; }
th, td { padding: .4rem .7rem; text-align: left; vertical-align: top;
         border-bottom: 1px solid #dfe4ea; font-variant-numeric: tabular-nums; }
th { background: #f3f5f7; }
figure { margin: 1.6rem 0; overflow-x: auto; }
figure svg { max-width: 100%; height: auto; }
figcaption { color: #46505e; font-size: .875rem; max-width: 85ch; }
)";

}  // namespace

Html::Html(std::string_view title)
    : body_(
          "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
          "<meta name=\"viewport\" content=\"width=device-width\"><title>" +
          escaped(title) + "</title><style>" + std::string(kStyle) +
          "</style></head><body><main>\n<h1>" + escaped(title) + "</h1>\n") {}

void Html::heading(std::string_view text) { body_ += "<h2>" + escaped(text) + "</h2>\n"; }

void Html::paragraph(std::string_view text) { body_ += "<p>" + escaped(text) + "</p>\n"; }

void Html::table(const Table& table) {
  body_ += "<table><thead><tr>";
  for (const auto& cell : table.head) body_ += "<th>" + escaped(cell) + "</th>";
  body_ += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    body_ += "<tr>";
    for (const auto& cell : row) body_ += "<td>" + escaped(cell) + "</td>";
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table>\n";
}

void Html::figure(std::string_view svg, std::string_view caption) {
  body_ += "<figure>" + std::string(svg) + "<figcaption>" + escaped(caption) +
           "</figcaption></figure>\n";
}

}  // namespace kidnapwatch::adapters::report
