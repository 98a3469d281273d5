// SPDX-License-Identifier: Apache-2.0
// Alerts stay until somebody confirmed them.
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "storage/archive.hpp"
#include "storage/sqlite.hpp"
#include "storage/writer.hpp"
#include "tests/storage/fault_vfs.hpp"
#include "tests/storage/store_folder.hpp"

namespace kidnapwatch::storage {
namespace {

OutboxMessage alert(int number, const std::string& robot = "robot-1") {
  return {.event_id = "event-" + std::to_string(number),
          .robot = robot,
          .payload = "{\"number\":" + std::to_string(number) + "}"};
}

OutboxMessage delivered(int number) {
  auto message = alert(number);
  message.delivered = true;
  return message;
}

TEST(Outbox, TheLatestAlertOfAnIncidentStaysUntilThatIsResolved) {
  const StoreFolder folder;
  Writer writer({.file = folder.store()});
  const Archive archive(folder.store(), writer.recent());
  auto incident = incident_of(1);
  const auto change = [&](int event) {
    writer.put_incident({.incident = incident, .alert = alert(event)});
    ++incident.seq;
  };
  const auto confirm = [&](int event) {
    writer.confirm_delivery(alert(event).event_id);
    writer.flush().get();
  };
  change(1);
  change(2);
  confirm(1);
  EXPECT_EQ(archive.outbox(), std::vector{alert(2)});
  confirm(2);
  EXPECT_EQ(archive.outbox(), std::vector{delivered(2)});
  incident.state = core::IncidentState::resolved;
  change(3);
  writer.flush().get();
  EXPECT_EQ(archive.outbox(), std::vector{alert(3)});
  confirm(3);
  EXPECT_TRUE(archive.outbox().empty());
}

TEST(Outbox, AlertsWaitInOrderUntilTheyAreConfirmed) {
  const StoreFolder folder;
  {
    Writer writer({.file = folder.store()});
    for (int i = 1; i <= 4; ++i) {
      writer.put_incident({.incident = incident_of(i), .alert = alert(i)});
    }
    writer.confirm_delivery("event-2");
    writer.confirm_delivery("event-unknown");
  }
  EXPECT_EQ(Archive(folder.store()).outbox(),
            (std::vector{alert(1), delivered(2), alert(3), alert(4)}));
  Writer writer({.file = folder.store()});  // the next start
  for (const int i : {1, 3, 4}) writer.confirm_delivery(alert(i).event_id);
  writer.put_incident({.incident = incident_of(5), .alert = alert(5)});
  writer.flush().get();
  EXPECT_EQ(Archive(folder.store()).outbox(),
            (std::vector{delivered(1), delivered(2), delivered(3), delivered(4), alert(5)}));
}

TEST(Outbox, TheSameAlertTwiceIsOne) {
  const StoreFolder folder;
  Writer writer({.file = folder.store()});
  for (int i = 0; i < 2; ++i) writer.put_incident({.incident = incident_of(1), .alert = alert(1)});
  writer.flush().get();
  EXPECT_EQ(Archive(folder.store()).outbox(), std::vector{alert(1)});
}

TEST(Outbox, AnAlertIsThereExactlyIfItsIncidentIs) {
  const StoreFolder folder;
  FaultyDisk disk;
  Writer writer({.file = folder.store(), .retry_max = std::chrono::milliseconds(1)});
  const Archive archive(folder.store(), writer.recent());
  disk.let_writes_return(SQLITE_FULL);
  writer.put_incident({.incident = incident_of(1), .alert = alert(1)});
  EXPECT_THROW(writer.flush().get(), StorageError);
  EXPECT_TRUE(archive.outbox().empty());
  EXPECT_FALSE(archive.incident(incident_id(1)));
  writer.confirm_delivery(alert(1).event_id);  // published meanwhile, and confirmed
  disk.let_writes_return(SQLITE_OK);
  writer.flush().get();
  EXPECT_TRUE(archive.incident(incident_id(1)));
  EXPECT_EQ(archive.outbox(), std::vector{delivered(1)});
}

TEST(Alerts, AreFollowedInTheOrderOfTheirCommitsFromWhereOneStopped) {
  const StoreFolder folder;
  Writer writer({.file = folder.store()});
  const Archive archive(folder.store(), writer.recent());
  EXPECT_EQ(archive.alert_numbers(), (AlertNumbers{.first = 1, .last = 0}));
  for (const int i : {2, 1, 3}) {
    writer.put_incident({.incident = incident_of(i), .alert = alert(i)});
    writer.confirm_delivery(alert(i).event_id);  // they stay
  }
  writer.flush().get();
  const auto all = archive.alerts(0, 100);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[0].payload, alert(2).payload);
  EXPECT_EQ(all[2].payload, alert(3).payload);
  EXPECT_EQ(archive.alerts(0, 2), (std::vector{all[0], all[1]}));
  EXPECT_EQ(archive.alerts(all[1].number, 100), std::vector{all[2]});
  EXPECT_EQ(archive.alerts_of(incident_id(1)), std::vector{all[1]});
  EXPECT_EQ(archive.alert_numbers(), (AlertNumbers{.first = all[0].number, .last = all[2].number}));
}

TEST(Alerts, ANumberIsNeverGivenAgain) {
  const StoreFolder folder;
  Writer writer({.file = folder.store()});
  writer.put_incident({.incident = incident_of(1), .alert = alert(1)});
  writer.flush().get();
  Database(folder.store(), Access::read_write).execute("DELETE FROM alert");  // as retention does
  const Archive archive(folder.store(), writer.recent());
  EXPECT_EQ(archive.alert_numbers(), (AlertNumbers{.first = 2, .last = 1}));
  writer.put_incident({.incident = incident_of(2), .alert = alert(2)});
  writer.flush().get();
  EXPECT_EQ(archive.alerts(1, 100).at(0).payload, alert(2).payload);
}

}  // namespace
}  // namespace kidnapwatch::storage
