// SPDX-License-Identifier: Apache-2.0
// The tokens of REST in a file of their own: a store that is put aside must lock nobody out.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/auth.hpp"

namespace kidnapwatch::service {

/// Any thread; several processes may use one file. A file that is not there holds no tokens.
class TokenFile {
 public:
  explicit TokenFile(std::filesystem::path file) : file_(std::move(file)) {}

  /// As they are now. Throws BadInput naming the file and the field that cannot be read.
  [[nodiscard]] std::vector<api::Token> tokens() const;

  /// Both are durable once they returned, and in force for the next request. They throw as tokens()
  /// does, and std::system_error if the file cannot be written.
  void add(const api::Token& token);
  /// False if there is no token of this id.
  [[nodiscard]] bool revoke(std::string_view id);

  /// Whose secret it is, by the file as it is now: it is small, and a revoked token must not live
  /// on in a cache.
  [[nodiscard]] std::optional<api::Caller> caller(std::string_view secret) const;

 private:
  void replace(const std::vector<api::Token>& tokens);

  const std::filesystem::path file_;
};

}  // namespace kidnapwatch::service
