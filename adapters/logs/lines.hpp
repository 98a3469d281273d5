// SPDX-License-Identifier: Apache-2.0
// Text files, gzipped or not, line by line and word by word, within bounds.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/logs/log.hpp"

struct gzFile_s;

namespace kidnapwatch::adapters::logs {

struct LineLimits {
  std::size_t longest_line = std::size_t{1} << 20U;  ///< bytes; the rest of a longer one is dropped
  std::size_t whole_text = std::size_t{512}
                           << 20U;  ///< bytes, unpacked: a small file can hold more
};

class Lines {
 public:
  /// Throws BadInput naming the file if it cannot be opened.
  explicit Lines(const std::filesystem::path& file, LineLimits limits = {});
  ~Lines();
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  /// The text's beginning, at most 64 KiB, to tell the format by. Before the first next().
  [[nodiscard]] std::string_view head();

  /// Moves on to the next line; false at the end. Throws BadInput naming file and line if the file
  /// cannot be read, is cut off or is longer than the limit.
  [[nodiscard]] bool next();

  /// The line, without its end ("\n" or "\r\n"), until the next call of next().
  [[nodiscard]] std::string_view text() const { return line_; }

  /// "file:line" of the current line; the file alone before the first.
  [[nodiscard]] std::string where() const;
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

 private:
  struct Close {
    void operator()(gzFile_s* gz) const;
  };
  bool fill();

  std::filesystem::path file_;
  LineLimits limits_;
  std::unique_ptr<gzFile_s, Close> gz_;
  std::string buffer_;
  std::size_t used_ = 0;  // of buffer_
  std::size_t read_ = 0;  // in all
  std::string line_;
  std::size_t number_ = 0;
};

/// The words of a line, between blanks. Throws BadInput naming `field` where there is no such word.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}

  [[nodiscard]] std::string_view word(std::string_view field);
  /// Any floating-point number, infinite or NaN as well.
  [[nodiscard]] double number(std::string_view field);
  [[nodiscard]] double finite(std::string_view field);
  /// x, y and theta, in m and rad; not necessarily finite.
  [[nodiscard]] core::Pose pose(std::string_view field);
  /// 1..core::kMaxBeams.
  [[nodiscard]] std::size_t beam_count(std::string_view field);
  [[nodiscard]] std::vector<float> ranges(std::size_t count);
  void skip(std::size_t words, std::string_view field);
  /// Throws unless all words were taken.
  void expect_end();

 private:
  std::string_view rest_;
};

/// Hands all further lines to `read`; counts those for which it throws BadInput in `log`, and gives
/// up with BadInput at the 10'000th.
void read_lines(Lines& lines, Log& log, const std::function<void(std::string_view)>& read);

}  // namespace kidnapwatch::adapters::logs
