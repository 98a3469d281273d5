// SPDX-License-Identifier: Apache-2.0
// Bounded reading of text, by zlib, which reads plain files too.
#include "adapters/logs/lines.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include <zlib.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

using core::BadInput;

constexpr std::size_t kBlock = std::size_t{64} << 10U;
constexpr std::size_t kMostBroken = 10'000;

template <typename Number>
Number parsed(std::string_view word, std::string_view field) {
  Number value{};
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error != std::errc{} || stop != end) throw BadInput(std::string(field), "not a number");
  return value;
}

}  // namespace

void Lines::Close::operator()(gzFile_s* gz) const { gzclose_r(gz); }

Lines::Lines(const std::filesystem::path& file, LineLimits limits)
    : file_(file), limits_(limits), gz_(gzopen(file.c_str(), "rb")) {
  if (!gz_) throw BadInput(file.string(), std::strerror(errno));
}

Lines::~Lines() = default;

std::string Lines::where() const {
  return number_ == 0 ? file_.string() : file_.string() + ":" + std::to_string(number_);
}

std::string_view Lines::head() {
  if (buffer_.empty()) fill();
  return buffer_;
}

/// Reads the next block into buffer_; false at the end of the file.
bool Lines::fill() {
  buffer_.resize(kBlock);
  const int got = gzread(gz_.get(), buffer_.data(), static_cast<unsigned>(kBlock));
  int error = Z_OK;
  const char* const message = gzerror(gz_.get(), &error);
  if (got < 0) throw BadInput(where(), error == Z_ERRNO ? std::strerror(errno) : message);
  if (got == 0 && error == Z_BUF_ERROR) throw BadInput(where(), "the compressed file is cut off");
  buffer_.resize(static_cast<std::size_t>(got));
  used_ = 0;
  read_ += buffer_.size();
  if (read_ > limits_.whole_text) throw BadInput(where(), "too long a text");
  return got > 0;
}

bool Lines::next() {
  line_.clear();
  bool any = false;
  while (used_ < buffer_.size() || fill()) {
    if (!any) ++number_;
    any = true;
    const std::string_view rest = std::string_view(buffer_).substr(used_);
    const std::size_t end = rest.find('\n');
    const std::string_view piece = rest.substr(0, end);
    line_.append(piece.substr(0, limits_.longest_line - line_.size()));
    used_ += std::min(piece.size() + 1, rest.size());
    if (end != std::string_view::npos) break;
  }
  if (line_.ends_with('\r')) line_.pop_back();
  return any;
}

std::string_view Words::word(std::string_view field) {
  constexpr std::string_view kBlank = " \t\r\v\f";
  const std::size_t begin = rest_.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) throw BadInput(std::string(field), "missing");
  rest_.remove_prefix(begin);
  const std::string_view found = rest_.substr(0, rest_.find_first_of(kBlank));
  rest_.remove_prefix(found.size());
  return found;
}

double Words::number(std::string_view field) { return parsed<double>(word(field), field); }

double Words::finite(std::string_view field) {
  const double value = number(field);
  if (!std::isfinite(value)) throw BadInput(std::string(field), "not finite");
  return value;
}

core::Pose Words::pose(std::string_view field) {
  const double x_m = number(field);
  const double y_m = number(field);
  return {x_m, y_m, number(field)};
}

std::size_t Words::beam_count(std::string_view field) {
  const auto count = parsed<std::size_t>(word(field), field);
  if (count < 1 || count > core::kMaxBeams) throw BadInput(std::string(field), "not 1 to 65536");
  return count;
}

std::vector<float> Words::ranges(std::size_t count) {
  std::vector<float> ranges_m;
  ranges_m.reserve(std::min(count, rest_.size() / 2 + 1));  // a false count reserves nothing
  while (ranges_m.size() < count) ranges_m.push_back(static_cast<float>(number("ranges")));
  return ranges_m;
}

void Words::skip(std::size_t words, std::string_view field) {
  for (std::size_t i = 0; i < words; ++i) static_cast<void>(word(field));
}

void Words::expect_end() {
  if (rest_.find_first_not_of(" \t\r\v\f") != std::string_view::npos) {
    throw BadInput("line", "more words than expected");
  }
}

void read_lines(Lines& lines, Log& log, const std::function<void(std::string_view)>& read) {
  while (lines.next()) {
    try {
      read(lines.text());
    } catch (const BadInput& error) {
      if (log.skipped_lines++ == 0) log.first_skipped = lines.where() + ": " + error.what();
      if (log.skipped_lines < kMostBroken) continue;
      throw BadInput(lines.where(), "too many broken lines, the first: " + log.first_skipped);
    }
  }
}

}  // namespace kidnapwatch::adapters::logs
