// SPDX-License-Identifier: Apache-2.0
// A page that needs no other file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kidnapwatch::adapters::report {

struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

/// Text is escaped; only figures are taken as they are.
class Html {
 public:
  explicit Html(std::string_view title);

  void heading(std::string_view text);
  void paragraph(std::string_view text);
  void table(const Table& table);
  /// `svg` comes from drawn().
  void figure(std::string_view svg, std::string_view caption);

  [[nodiscard]] std::string str() const { return body_ + "</main></body></html>\n"; }

 private:
  std::string body_;
};

}  // namespace kidnapwatch::adapters::report
