#include <cell_microinjection/Readiness.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "virtual_session.h"

namespace microinjection {
namespace {

/// The default session with the node that tells why it does not do what it is asked to.
class ReadinessNodeTest : public testing::Test {
 protected:
  ReadinessNodeTest() {
    session_.start();
    session_.world().hear<cell_microinjection::Readiness>(kTopic);
  }
  void listen(const std::string& nodes) {
    session_.add("readiness", "readiness", YAML::Load("{nodes: [" + nodes + "]}"));
  }
  const cell_microinjection::Readiness& newest() {
    return *session_.world().hear<cell_microinjection::Readiness>(kTopic).newest();
  }
  bool until(const std::function<bool(const cell_microinjection::Readiness&)>& done) {
    return session_.until([&] {
      const auto& heard = session_.world().hear<cell_microinjection::Readiness>(kTopic);
      return heard.count() > 0 && done(*heard.newest());
    });
  }
  static const cell_microinjection::Hindrance* of(const cell_microinjection::Readiness& message,
                                                  const std::string& node) {
    const auto found = std::find_if(message.hindrances.begin(), message.hindrances.end(),
                                    [&](const auto& each) { return each.node == node; });
    return found == message.hindrances.end() ? nullptr : &*found;
  }

  static constexpr const char* kTopic = "session/readiness";
  VirtualSession session_;
};

TEST_F(ReadinessNodeTest, TheReasonToBeMendedFirstComesFirstAndHasItsRemedy) {
  listen("micromanipulator, injection_controller, haptic_bridge");
  ASSERT_TRUE(until([](const auto& message) { return message.ready; }));
  EXPECT_TRUE(newest().hindrances.empty() || !newest().hindrances.front().holds);
  session_.world().command("/needle/state_command", "disable");
  ASSERT_TRUE(until([](const auto& message) { return !message.ready && message.hindrances.size() > 1; }));
  const cell_microinjection::Hindrance& first = newest().hindrances.front();
  EXPECT_EQ(first.node, "micromanipulator") << first.reason;
  EXPECT_EQ(first.reason, "DISABLED; allowed after enable");
  EXPECT_TRUE(first.holds);
  EXPECT_NE(first.remedy.find("Send the opposite"), std::string::npos) << first.remedy;
  EXPECT_EQ(first.section, "The controller is ENABLED, the rig is not");
  session_.world().command("/needle/state_command", "enable");
  EXPECT_TRUE(until([](const auto& message) { return of(message, "micromanipulator") == nullptr; }));
}

TEST_F(ReadinessNodeTest, ANodeThatNeverSpeaksIsNamed) {
  listen("micromanipulator, somebody");
  ASSERT_TRUE(until([](const auto& message) { return of(message, "somebody") != nullptr; }));
  EXPECT_EQ(of(newest(), "somebody")->reason, "the node somebody has not started yet");
  EXPECT_FALSE(newest().ready);
}

}  // namespace
}  // namespace microinjection
