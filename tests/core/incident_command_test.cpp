// SPDX-License-Identifier: Apache-2.0
// The life of an incident, transition by transition.
#include "core/incident_command.hpp"

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::core {
namespace {

using enum IncidentAction;

const Stamp kNow = stamp_from_ns(1'000'000'000);

IncidentCommand command(IncidentAction action) {
  IncidentCommand one{.action = action, .author = "ann"};
  if (action == shelve) one.shelve_for_s = 60.0;
  if (action == label) one.label = IncidentLabel::false_alarm;
  return one;
}

Incident in(IncidentState state) {
  Incident incident{.id = "i", .robot = "r", .seq = 4, .state = state};
  return incident;
}

/// The state after, "-" where it is not allowed, with "=" where nothing changes.
std::string after(IncidentState state, IncidentAction action) {
  const auto result = changed(in(state), command(action), kNow);
  if (!result) return "-";
  return std::string(name(result->incident.state)) + (result->incident.seq == 4 ? "=" : "");
}

TEST(IncidentCommand, LeadsFromStateToState) {
  using enum IncidentState;
  EXPECT_EQ(after(open, ack), "acknowledged");
  EXPECT_EQ(after(acknowledged, ack), "acknowledged=");
  EXPECT_EQ(after(resolved, ack), "-");
  EXPECT_EQ(after(open, unack), "open=");
  EXPECT_EQ(after(acknowledged, unack), "open");
  EXPECT_EQ(after(resolved, unack), "-");
  EXPECT_EQ(after(open, resolve), "resolved");
  EXPECT_EQ(after(acknowledged, resolve), "resolved");
  EXPECT_EQ(after(resolved, resolve), "resolved=");
  EXPECT_EQ(after(open, shelve), "open");
  EXPECT_EQ(after(acknowledged, shelve), "acknowledged");
  EXPECT_EQ(after(resolved, shelve), "-");
  EXPECT_EQ(after(open, label), "open");
  EXPECT_EQ(after(resolved, label), "resolved");
}

TEST(IncidentCommand, IsToldAsAnAlertOfItsKind) {
  const auto type = [](IncidentAction action) {
    return changed(in(IncidentState::acknowledged), command(action), kNow)->type;
  };
  EXPECT_EQ(type(ack), AlertType::acknowledged);
  EXPECT_EQ(type(unack), AlertType::unacknowledged);
  EXPECT_EQ(type(resolve), AlertType::resolved);
  EXPECT_EQ(type(shelve), AlertType::shelved);
  EXPECT_EQ(type(label), AlertType::updated);
}

TEST(IncidentCommand, SaysWho) {
  auto acknowledged = changed(in(IncidentState::open), command(ack), kNow)->incident;
  EXPECT_EQ(acknowledged.acknowledged_by, "ann");
  auto by_bob = command(ack);
  by_bob.author = "bob";
  EXPECT_EQ(changed(acknowledged, by_bob, kNow)->incident.acknowledged_by, "ann");
  EXPECT_EQ(changed(acknowledged, command(unack), kNow)->incident.acknowledged_by, "");
  const auto resolved = changed(acknowledged, command(resolve), kNow)->incident;
  EXPECT_EQ(resolved.resolved_by, "ann");
  EXPECT_EQ(resolved.resolved_at, kNow);
}

TEST(IncidentCommand, ShelvesForATimeAndEndsIt) {
  const auto shelved = changed(in(IncidentState::open), command(shelve), kNow)->incident;
  EXPECT_EQ(shelved.shelved_until, later_by_s(kNow, 60.0));
  EXPECT_FALSE(changed(shelved, command(resolve), kNow)->incident.shelved_until);
  auto end = command(shelve);
  end.shelve_for_s = 0.0;
  const auto ended = changed(shelved, end, kNow);
  EXPECT_FALSE(ended->incident.shelved_until);
  EXPECT_EQ(ended->type, AlertType::updated);
}

TEST(IncidentCommand, KeepsLabelAndComment) {
  auto with_comment = command(label);
  with_comment.comment = "a forklift";
  const auto labelled = changed(in(IncidentState::resolved), with_comment, kNow)->incident;
  EXPECT_EQ(labelled.label, IncidentLabel::false_alarm);
  EXPECT_EQ(labelled.comment, "a forklift");
  EXPECT_EQ(changed(labelled, with_comment, kNow)->incident, labelled);
}

/// The field that check() refuses.
std::string refused(const IncidentCommand& bad) {
  try {
    check(bad);
  } catch (const BadInput& error) {
    return error.field();
  }
  return "";
}

TEST(IncidentCommand, NamesWhatIsMissingOrTooLong) {
  for (const auto action : {ack, unack, resolve, shelve, label}) {
    EXPECT_EQ(refused(command(action)), "");
    EXPECT_EQ(refused({.action = action, .comment = std::string(2001, 'x')}),
              action == shelve  ? "seconds"
              : action == label ? "label"
                                : "comment");
  }
  auto one = command(shelve);
  for (const double bad : {-1.0, 604'801.0, std::numeric_limits<double>::quiet_NaN()}) {
    one.shelve_for_s = bad;
    EXPECT_EQ(refused(one), "seconds");
  }
}

TEST(IncidentCommand, TakesACommentOfSoManyCharactersNotBytes) {
  auto with_comment = command(label);
  with_comment.comment = "";
  for (int i = 0; i < 2000; ++i) *with_comment.comment += "\u00fc";
  EXPECT_NO_THROW(check(with_comment));
  *with_comment.comment += "\u00fc";
  EXPECT_EQ(refused(with_comment), "comment");
}

}  // namespace
}  // namespace kidnapwatch::core
