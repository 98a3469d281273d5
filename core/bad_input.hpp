// SPDX-License-Identifier: Apache-2.0
// Input that cannot be used, and the field that says why.
#pragma once

#include <stdexcept>
#include <string>

namespace kidnapwatch::core {

/// Thrown where outside input (a message, a file, a request) is unusable; what() is
/// "field: reason". Caught once, at the message or the request.
class BadInput : public std::invalid_argument {
 public:
  BadInput(std::string field, const std::string& reason)
      : std::invalid_argument(field + ": " + reason), field_(std::move(field)) {}

  [[nodiscard]] const std::string& field() const noexcept { return field_; }
  [[nodiscard]] std::string reason() const { return std::string(what()).substr(field_.size() + 2); }

 private:
  std::string field_;
};

}  // namespace kidnapwatch::core
