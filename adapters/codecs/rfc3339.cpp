// SPDX-License-Identifier: Apache-2.0
// Reading and writing of RFC 3339, section 5.6.
#include "adapters/codecs/rfc3339.hpp"

#include <array>
#include <chrono>
#include <cstdio>

#include "core/bad_input.hpp"

namespace kidnapwatch::adapters::codecs {
namespace {

using namespace std::chrono;

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// What is left of the text, taken from the front.
class Scanner {
 public:
  Scanner(std::string_view text, const std::string& field) : rest_(text), field_(field) {}

  [[noreturn]] void refuse() const {
    throw core::BadInput(field_,
                         "must be an RFC 3339 date-time such as 2026-01-31T12:00:00Z, "
                         "in the years 1678 to 2261");
  }

  int number(std::size_t digits, int min, int max) {
    int value = 0;
    for (std::size_t i = 0; i < digits; ++i) {
      value = 10 * value + digit();
    }
    if (value < min || value > max) {
      refuse();
    }
    return value;
  }

  /// Takes one of `allowed` (upper case); letters may be lower case.
  char one_of(std::string_view allowed) {
    const char c = static_cast<char>(next() & ~(is_letter() ? 0x20 : 0));
    if (allowed.find(c) == std::string_view::npos) {
      refuse();
    }
    rest_.remove_prefix(1);
    return c;
  }

  /// ".5" as nanoseconds, 0 if there is no fraction.
  nanoseconds fraction() {
    if (next() != '.') {
      return nanoseconds{0};
    }
    rest_.remove_prefix(1);
    int ns = digit();
    for (int digits = 1; digits < 9; ++digits) {
      ns = 10 * ns + (is_digit(next()) ? digit() : 0);
    }
    return nanoseconds{ns};
  }

  void end() const {
    if (!rest_.empty()) {
      refuse();
    }
  }

 private:
  [[nodiscard]] char next() const { return rest_.empty() ? '\0' : rest_.front(); }
  [[nodiscard]] bool is_letter() const {
    return (next() >= 'a' && next() <= 'z') || (next() >= 'A' && next() <= 'Z');
  }

  int digit() {
    if (!is_digit(next())) {
      refuse();
    }
    const int value = next() - '0';
    rest_.remove_prefix(1);
    return value;
  }

  std::string_view rest_;
  const std::string& field_;
};

sys_days date(Scanner& scanner) {
  const year y{scanner.number(4, 1678, 2261)};
  scanner.one_of("-");
  const month m{static_cast<unsigned>(scanner.number(2, 1, 12))};
  scanner.one_of("-");
  const day d{static_cast<unsigned>(scanner.number(2, 1, 31))};
  if (!(y / m / d).ok()) {
    scanner.refuse();
  }
  return y / m / d;
}

nanoseconds time_of_day(Scanner& scanner) {
  const hours h{scanner.number(2, 0, 23)};
  scanner.one_of(":");
  const minutes min{scanner.number(2, 0, 59)};
  scanner.one_of(":");
  const seconds s{scanner.number(2, 0, 59)};
  return h + min + s + scanner.fraction();
}

minutes offset(Scanner& scanner) {
  const char sign = scanner.one_of("Z+-");
  if (sign == 'Z') {
    return minutes{0};
  }
  const hours h{scanner.number(2, 0, 23)};
  scanner.one_of(":");
  const minutes ahead = h + minutes{scanner.number(2, 0, 59)};
  return sign == '-' ? -ahead : ahead;
}

}  // namespace

std::string rfc3339(core::Stamp stamp) {
  const auto today = floor<days>(stamp);
  const year_month_day date{today};
  const hh_mm_ss time{stamp - today};
  std::array<char, 40> text{};
  const int length = std::snprintf(
      text.data(), text.size(), "%04d-%02u-%02uT%02d:%02d:%02d.%09dZ",
      static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
      static_cast<unsigned>(date.day()), static_cast<int>(time.hours().count()),
      static_cast<int>(time.minutes().count()), static_cast<int>(time.seconds().count()),
      static_cast<int>(time.subseconds().count()));
  return {text.data(), static_cast<std::size_t>(length)};
}

core::Stamp stamp_from_rfc3339(std::string_view text, const std::string& field) {
  Scanner scanner(text, field);
  const sys_days day = date(scanner);
  scanner.one_of("T");
  const nanoseconds time = time_of_day(scanner);
  const minutes ahead = offset(scanner);
  scanner.end();
  return core::Stamp{day} + time - ahead;
}

}  // namespace kidnapwatch::adapters::codecs
