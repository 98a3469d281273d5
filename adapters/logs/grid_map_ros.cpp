// SPDX-License-Identifier: Apache-2.0
// Reads maps as nav2's map_server has them: YAML and PGM.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <system_error>

#include <zlib.h>

#include "adapters/logs/grid_map.hpp"
#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::logs {
namespace {

using core::BadInput;
using core::baselines::Cell;
using core::baselines::GridMap;
using Fields = std::map<std::string, std::string, std::less<>>;

// What map_saver writes; its own free_thresh of 0.25 would take it for free.
constexpr unsigned char kUnknown = 205;
constexpr std::size_t kMostBytes = core::baselines::kMaxCells + 4096;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kAround = " \t\"'";
  const std::size_t begin = text.find_first_not_of(kAround);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kAround) - begin + 1);
}

/// "key: value" of every line that has one; the rest of a line after " #" is a comment.
Fields fields(Lines& lines) {
  Fields found;
  while (lines.next()) {
    const std::string_view text = lines.text().substr(0, lines.text().find(" #"));
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos || text.starts_with('#')) continue;
    found.emplace(trimmed(text.substr(0, colon)), trimmed(text.substr(colon + 1)));
  }
  return found;
}

std::string field(const Fields& fields, std::string_view name) {
  const auto found = fields.find(name);
  if (found == fields.end()) throw BadInput(std::string(name), "missing");
  return found->second;
}

double number(const Fields& fields, std::string_view name) {
  const std::string text = field(fields, name);
  Words words(text);
  const double value = words.finite(name);
  words.expect_end();
  return value;
}

/// "[x, y, theta]".
core::Pose origin(const Fields& fields) {
  std::string text = field(fields, "origin");
  std::ranges::replace_if(
      text, [](char c) { return c == '[' || c == ']' || c == ','; }, ' ');
  Words words(text);
  const double x_m = words.finite("origin");
  const double y_m = words.finite("origin");
  const double theta_rad = words.finite("origin");
  words.expect_end();
  if (theta_rad != 0.0) throw BadInput("origin", "a turned map cannot be read");
  return {x_m, y_m, theta_rad};
}

/// A whole file, unpacked.
std::string bytes(const std::filesystem::path& file) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> gz(gzopen(file.c_str(), "rb"), gzclose_r);
  if (!gz) throw BadInput(file.string(), "cannot be opened");
  std::string bytes;
  std::array<char, 65536> block{};
  int got = 0;
  while ((got = gzread(gz.get(), block.data(), block.size())) > 0) {
    bytes.append(block.data(), static_cast<std::size_t>(got));
    if (bytes.size() > kMostBytes) throw BadInput(file.string(), "too large");
  }
  int error = Z_OK;
  static_cast<void>(gzerror(gz.get(), &error));
  if (got < 0 || error != Z_OK) throw BadInput(file.string(), "cannot be read to its end");
  return bytes;
}

struct Image {
  long columns = 0;
  long rows = 0;
  std::string pixels;  // from the north-west corner
};

/// The next number of a PGM's header; comments run from # to the end of a line.
long header_number(std::string_view bytes, std::size_t& at) {
  constexpr std::string_view kPassedOver = "# \t\r\n";
  while (at < bytes.size() && kPassedOver.find(bytes[at]) != std::string_view::npos) {
    at = bytes[at] == '#' ? bytes.find('\n', at) : at + 1;
  }
  long value = 0;
  if (at < bytes.size()) {
    const char* const end = bytes.data() + bytes.size();
    const auto [stop, error] = std::from_chars(bytes.data() + at, end, value);
    if (error == std::errc{} && value > 0 && value <= 65536) {
      at = static_cast<std::size_t>(stop - bytes.data());
      return value;
    }
  }
  throw BadInput("image", "no PGM header");
}

Image pgm(const std::string& bytes) {
  if (!bytes.starts_with("P5")) throw BadInput("image", "not a binary PGM (P5)");
  std::size_t at = 2;
  Image image;
  image.columns = header_number(bytes, at);
  image.rows = header_number(bytes, at);
  if (header_number(bytes, at) != 255) throw BadInput("image", "not 255 levels of grey");
  const auto cells = static_cast<std::size_t>(image.columns * image.rows);
  if (cells > core::baselines::kMaxCells) throw BadInput("image", "too large");
  if (bytes.size() < at + 1 + cells) throw BadInput("image", "cut off");
  image.pixels = bytes.substr(at + 1, cells);
  return image;
}

struct Thresholds {
  double occupied;
  double free;
  bool negate;

  [[nodiscard]] Cell cell(unsigned char pixel) const {
    if (pixel == kUnknown) return Cell::unknown;
    const double light = static_cast<double>(pixel) / 255.0;
    const double dark = negate ? light : 1.0 - light;
    if (dark > occupied) return Cell::occupied;
    return dark < free ? Cell::free : Cell::unknown;
  }
};

GridMap map_of(const Fields& fields, const Image& image) {
  const core::Pose corner = origin(fields);
  const double cell_m = number(fields, "resolution");
  if (!(cell_m > 0.0)) throw BadInput("resolution", "not above 0");
  const Thresholds thresholds{number(fields, "occupied_thresh"), number(fields, "free_thresh"),
                              number(fields, "negate") != 0.0};
  GridMap map{{corner.x_m, corner.y_m, cell_m, image.columns, image.rows}, {}};
  map.cells.reserve(map.layout.cells());
  for (long row = 0; row < image.rows; ++row) {
    for (long column = 0; column < image.columns; ++column) {
      const char pixel = image.pixels[map.layout.index(column, image.rows - 1 - row)];
      map.cells.push_back(thresholds.cell(static_cast<unsigned char>(pixel)));
    }
  }
  return map;
}

std::filesystem::path image_file(const std::filesystem::path& yaml, const std::string& image) {
  const std::filesystem::path file = yaml.parent_path() / image;
  std::error_code ignored;  // of a name that is none: it cannot be opened either
  return exists(file, ignored) ? file : std::filesystem::path(file.string() + ".gz");
}

}  // namespace

bool is_ros_map(std::string_view head) {
  return head.starts_with("image:") || head.find("\nimage:") != std::string_view::npos;
}

GridMap read_ros_map(Lines& lines) {
  try {
    const Fields found = fields(lines);
    if (const auto mode = found.find("mode"); mode != found.end() && mode->second == "raw") {
      throw BadInput("mode", "raw maps cannot be read");
    }
    return map_of(found, pgm(bytes(image_file(lines.file(), field(found, "image")))));
  } catch (const BadInput& error) {
    throw BadInput(lines.file().string(), error.what());
  }
}

}  // namespace kidnapwatch::adapters::logs
