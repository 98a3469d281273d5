// SPDX-License-Identifier: Apache-2.0
// Names of an incident's kinds, states and messages.
#include "core/incident.hpp"

#include <gtest/gtest.h>

#include "core/bad_input.hpp"

namespace kidnapwatch::core {
namespace {

TEST(IncidentKind, ComesBackFromItsName) {
  EXPECT_EQ(name(IncidentKind::teleport), "teleport");
  EXPECT_EQ(name(IncidentKind::carry), "carry");
  EXPECT_EQ(incident_kind("teleport", "kind"), IncidentKind::teleport);
  EXPECT_EQ(incident_kind("carry", "kind"), IncidentKind::carry);
  EXPECT_THROW((void)incident_kind("open", "kind"), BadInput);
  EXPECT_THROW((void)incident_kind("", "kind"), BadInput);
}

TEST(IncidentState, ComesBackFromItsName) {
  EXPECT_EQ(name(IncidentState::open), "open");
  EXPECT_EQ(name(IncidentState::acknowledged), "acknowledged");
  EXPECT_EQ(name(IncidentState::resolved), "resolved");
  EXPECT_EQ(incident_state("open", "state"), IncidentState::open);
  EXPECT_EQ(incident_state("acknowledged", "state"), IncidentState::acknowledged);
  EXPECT_EQ(incident_state("resolved", "state"), IncidentState::resolved);
  EXPECT_THROW((void)incident_state("teleport", "state"), BadInput);
}

TEST(AlertType, HasTheNameOfTheChange) {
  EXPECT_EQ(name(AlertType::opened), "opened");
  EXPECT_EQ(name(AlertType::updated), "updated");
  EXPECT_EQ(name(AlertType::acknowledged), "acknowledged");
  EXPECT_EQ(name(AlertType::unacknowledged), "unacknowledged");
  EXPECT_EQ(name(AlertType::resolved), "resolved");
  EXPECT_EQ(name(AlertType::shelved), "shelved");
}

}  // namespace
}  // namespace kidnapwatch::core
