// SPDX-License-Identifier: Apache-2.0
// `token`: who may use REST. Takes effect at once, with no restart.
#include <chrono>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "adapters/codecs/rfc3339.hpp"
#include "service/commands/commands.hpp"
#include "service/commands/settings_flags.hpp"
#include "service/token_file.hpp"

namespace kidnapwatch::service {
namespace {

constexpr const char* kFile = "http.tokens_file";

TokenFile token_file(const SettingsFlags& flags) {
  return TokenFile(flags.load().settings.http_tokens_file);
}

struct NewTokenFlags {
  std::string name;
  std::string role = "viewer";
  std::vector<std::string> robots;
};

int create(const SettingsFlags& flags, const NewTokenFlags& wanted) {
  const auto made =
      api::new_token({.name = wanted.name, .role = api::role(wanted.role), .robots = wanted.robots},
                     std::chrono::system_clock::now());
  token_file(flags).add(made.token);
  std::cerr << "token " << made.token.id << " was created; this is the only time it is shown:\n";
  std::cout << made.secret << '\n';
  return kOk;
}

int list(const SettingsFlags& flags) {
  for (const auto& token : token_file(flags).tokens()) {
    std::cout << token.id << "  " << adapters::codecs::rfc3339(token.created) << "  "
              << api::name(token.caller.role) << "  " << token.caller.name;
    for (const auto& robot : token.caller.robots) {
      std::cout << "  " << robot;
    }
    std::cout << '\n';
  }
  return kOk;
}

int revoke(const SettingsFlags& flags, const std::string& id) {
  if (token_file(flags).revoke(id)) {
    std::cerr << "token " << id << " is revoked\n";
    return kOk;
  }
  std::cerr << "kidnapwatch: no token has the id " << id << '\n';
  return kFailed;
}

}  // namespace

void add_token(CLI::App& app, Command& chosen) {
  auto* token = app.add_subcommand("token", "Create, list and revoke the tokens of REST");
  token->require_subcommand(1);
  token->footer("Example: kidnapwatch token create --name dashboard --role viewer");
  const auto flags = std::make_shared<SettingsFlags>();

  auto* made = token->add_subcommand("create", "Make a token and show it, once");
  const auto wanted = std::make_shared<NewTokenFlags>();
  made->add_option("--name", wanted->name, "Whose it is, for the audit")->required();
  made->add_option("--role", wanted->role, "viewer, operator or admin")->capture_default_str();
  made->add_option("--robot", wanted->robots, "The only robots that it shows; may be repeated");
  flags->add_to(*made, kFile);
  made->callback([=, &chosen] { chosen = [=] { return create(*flags, *wanted); }; });

  auto* listed = token->add_subcommand("list", "Show all, without their secrets");
  const auto list_flags = std::make_shared<SettingsFlags>();
  list_flags->add_to(*listed, kFile);
  listed->callback([=, &chosen] { chosen = [=] { return list(*list_flags); }; });

  auto* revoked = token->add_subcommand("revoke", "End a token, at once");
  const auto revoke_flags = std::make_shared<SettingsFlags>();
  const auto id = std::make_shared<std::string>();
  revoked->add_option("ID", *id, "As `token list` shows it")->required();
  revoke_flags->add_to(*revoked, kFile);
  revoked->callback([=, &chosen] { chosen = [=] { return revoke(*revoke_flags, *id); }; });
}

}  // namespace kidnapwatch::service
