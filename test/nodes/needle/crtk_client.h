#pragma once

#include <optional>
#include <string>
#include <vector>

#include "needle_bench.h"

namespace microinjection {

/// A CRTK client, as the node "client", that behaves as the released crtk_python_client (1.4.0) does on ROS 1. Written
/// from its source (src/crtk/utils.py, wait_move_handle.py, ral_ros1.py; MIT licence) without its code.
///
/// What counts of it: commands have stamp 0 and an empty frame; state_command is latched, motion commands are not; an
/// operating_state counts only when its stamp is later than that of the one before; wait() of a move needs is_busy true
/// with a stamp later than the command, and false after it; home() and unhome() wait for another operating_state than
/// the one at their begin; setpoint() needs a stamp of the last 20 ms, or waits so long for another message.
class CrtkClient {
 public:
  using OperatingState = cell_microinjection::OperatingState;
  struct Handle {
    ros::Time begun;
  };

  explicit CrtkClient(VirtualSession& session)
      : session_(session),
        node_(session.addTestNode("client")),
        states_(node_.hear<OperatingState>("needle/operating_state")),
        setpoints_(node_.hear<geometry_msgs::PoseStamped>("needle/setpoint_cp")),
        last_busy_(session.now()) {
    node_.publisher<cell_microinjection::StringStamped>("needle/state_command", true);
  }

  const OperatingState& state() {
    for (; counted_ < states_.count(); ++counted_) {
      const OperatingState& message = *states_.all()[counted_];
      if (message.is_busy && message.header.stamp > last_busy_) last_busy_ = message.header.stamp;
      if (message.header.stamp > state_.header.stamp) state_ = message;
    }
    return state_;
  }
  /// All that were heard, also those that do not count.
  const std::vector<boost::shared_ptr<const OperatingState>>& heard() const { return states_.all(); }
  /// What is_busy said from the message of this number on, each change of it.
  std::vector<bool> busyChanges(std::size_t since) const {
    std::vector<bool> changes;
    bool before = false;
    for (std::size_t i = since; i < states_.count(); ++i) {
      const bool busy = states_.all()[i]->is_busy;
      if (busy != before) changes.push_back(busy);
      before = busy;
    }
    return changes;
  }
  /// m; empty where none comes.
  std::optional<Eigen::Vector3d> setpoint() {
    constexpr double kInterval = 0.02;  // s
    const auto* old = setpoints_.newest();
    if (!old || secondsBetween(old->header.stamp, session_.now()) > kInterval)
      session_.until([&] { return setpoints_.newest() != old; }, kInterval);
    if (!setpoints_.newest() || setpoints_.newest()->header.stamp.isZero()) return std::nullopt;
    return toVector(setpoints_.newest()->pose.position);
  }

  void command(const std::string& word) {
    cell_microinjection::StringStamped message;
    message.string = word;
    node_.say("needle/state_command", message, true);
  }
  bool enable() {
    return change("enable", state().state == "ENABLED", [&] { return state().state == "ENABLED"; });
  }
  bool disable() {
    return change("disable", state().state == "DISABLED", [&] { return state().state == "DISABLED"; });
  }
  bool home() {
    return change("home", state().is_homed, [&] { return state().is_homed && !state().is_busy; });
  }
  bool unhome() {
    return change("unhome", !state().is_homed, [&] { return !state().is_homed && !state().is_busy; });
  }
  bool waitForState(const std::string& wanted) {
    return session_.until([&] { return state().state == wanted; });
  }

  Handle move(const Eigen::Vector3d& place) {
    const Handle handle{session_.now()};
    node_.say("needle/move_cp", poseAt(place, ""));
    return handle;
  }
  bool wait(const Handle& handle, bool is_busy = false) {
    return session_.until([&] {
      const bool now_busy = state().is_busy, was_busy = last_busy_ > handle.begun;
      return is_busy ? was_busy : was_busy && !now_busy;
    });
  }
  void servo(const Eigen::Vector3d& place) { node_.say("needle/servo_cp", poseAt(place, "")); }
  void servoVelocity(double x) { node_.say("needle/servo_cv", velocityMessage(x)); }

 private:
  template <typename Satisfied>
  bool change(const std::string& word, bool already, const Satisfied& satisfied) {
    const std::size_t before = states_.count();
    command(word);
    return already || session_.until([&] { return states_.count() > before && satisfied(); });
  }

  VirtualSession& session_;
  TestNode& node_;
  Probe<OperatingState>& states_;
  Probe<geometry_msgs::PoseStamped>& setpoints_;
  std::size_t counted_ = 0;  ///< states
  OperatingState state_;     ///< the newest one that counts
  ros::Time last_busy_;
};

const Eigen::Vector3d kCrtkStart(0, 0, 60e-6);   ///< m, of the tip with all joints at 0
const Eigen::Vector3d kCrtkFar(8e-3, 0, 60e-6);  ///< m, 4 s away

/// A simulated rig with a client that has enabled and homed it, and has the needle at kCrtkStart.
class CrtkBench : public testing::Test {
 protected:
  void SetUp() override {
    client_.disable();
    ASSERT_TRUE(client_.enable());
    const std::size_t since = client_.heard().size();
    client_.home();  // a wait for the move would be over with it
    ASSERT_TRUE(bench_.until([&] { return client_.busyChanges(since) == kBusyOnce; }, 1));
    ASSERT_TRUE(client_.wait(client_.move(kCrtkStart)));
    bench_.session.diagnostics().clear();
  }

  ::testing::AssertionResult isAt(const Eigen::Vector3d& place) { return isNear(bench_.needle(), place, 2e-9); }
  /// A move of 8 mm that is under way.
  CrtkClient::Handle setOff() {
    const CrtkClient::Handle handle = client_.move(kCrtkFar);
    EXPECT_TRUE(client_.wait(handle, true)) << "is_busy";
    EXPECT_TRUE(bench_.until([&] { return bench_.needle().x() > 20e-6; }, 1));
    return handle;
  }
  void expectRests() {
    bench_.run(0.1);
    EXPECT_LE(bench_.strays(0.2), 1e-9);
  }
  /// On the diagnostics of the next 0.2 s, or before.
  void expectSaid(const std::string& text, const std::string& status = kNeedleStatus) {
    const auto said = [&] { return bench_.session.diagnostics().ever(status, text); };
    EXPECT_TRUE(bench_.until(said, 0.2)) << "\"" << text << "\"; " << bench_.session.diagnostics().text(status);
  }

  const std::vector<bool> kBusyOnce{true, false};
  NeedleBench bench_;
  CrtkClient client_{bench_.session};
};

}  // namespace microinjection
