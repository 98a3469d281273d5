// SPDX-License-Identifier: Apache-2.0
// Bearer tokens: who calls, and what they may do. Secrets are known by their hash alone.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/codecs/json.hpp"
#include "core/stamp.hpp"

namespace kidnapwatch::api {

/// Each may do what the one before may.
enum class Role {
  viewer,     ///< read
  operator_,  ///< and change what becomes of incidents
  admin,      ///< and the configuration
};

[[nodiscard]] std::string_view name(Role role);
/// The inverse of name(). Throws BadInput naming `role` for any other text.
[[nodiscard]] Role role(std::string_view text);

/// Who sent a request.
struct Caller {
  std::string name;  ///< of the token, for the audit; without tokens the client's address
  Role role = Role::admin;
  std::vector<std::string> robots;  ///< the only ones that it may know of; empty: all

  [[nodiscard]] bool may_see(std::string_view robot) const;

  friend bool operator==(const Caller&, const Caller&) = default;
};

/// What is kept of a token.
struct Token {
  std::string id;  ///< to revoke it by
  Caller caller;
  core::Stamp created;
  std::string sha256;  ///< of the secret, in hex

  friend bool operator==(const Token& a, const Token& b) { return a.id == b.id; }
};

struct NewToken {
  Token token;
  std::string secret;  ///< 256 random bits as text; never seen again
};

/// Throws BadInput naming `name` or `robot` for one that cannot be.
[[nodiscard]] NewToken new_token(Caller caller, core::Stamp now);

/// Whose secret it is. Takes as long for a wrong secret as for a right one.
[[nodiscard]] std::optional<Caller> caller_of(std::span<const Token> tokens,
                                              std::string_view secret);

/// {"tokens":[...]}, and back. Throws BadInput naming the field that cannot be used.
[[nodiscard]] adapters::codecs::Json json(std::span<const Token> tokens);
[[nodiscard]] std::vector<Token> tokens(const adapters::codecs::Json& json);

}  // namespace kidnapwatch::api
