// SPDX-License-Identifier: Apache-2.0
// Conclusions to those who wait for them: broker and store, neither waiting for the other.
#pragma once

#include "adapters/mqtt/link.hpp"
#include "service/outbox.hpp"
#include "service/score_rate.hpp"
#include "service/watch.hpp"
#include "storage/writer.hpp"

namespace kidnapwatch::service {

class Announcements final : public Announcer {
 public:
  /// All outlive this. So many scores of each robot go to the broker in a second, too.
  Announcements(adapters::mqtt::Link& link, storage::Writer& writer, Outbox& outbox,
                std::size_t scores_per_s)
      : link_(link), writer_(writer), outbox_(outbox), score_rate_(scores_per_s) {}

  void announce_state(const core::RobotStatus& status, core::Stamp now) override;
  void announce_alert(const core::Alert& alert, std::optional<core::ScanPair> evidence) override;
  void announce_score(const std::string& robot, const core::Score& score,
                      core::Stamp arrival) override;
  void keep_learned(const std::string& robot, std::vector<float> learned) override;

 private:
  adapters::mqtt::Link& link_;
  storage::Writer& writer_;
  Outbox& outbox_;
  ScoreRate score_rate_;
};

}  // namespace kidnapwatch::service
