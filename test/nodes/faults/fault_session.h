#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/InjectorState.h"
#include "cell_microinjection/StringStamped.h"
#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {

/// How a node drops out.
enum class NodeFault {
  kKill,    ///< as by SIGKILL
  kFreeze,  ///< as by SIGSTOP; to the others it is as silent
};
inline void PrintTo(NodeFault fault, std::ostream* out) { *out << (fault == NodeFault::kKill ? "kill" : "freeze"); }

/// Where a needle, a hand or a force was, by the time of arrival (s).
struct Track {
  std::vector<double> times;
  std::vector<Eigen::Vector3d> values;

  Track since(double time) const {
    Track later;
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (times[i] <= time) continue;
      later.times.push_back(times[i]);
      later.values.push_back(values[i]);
    }
    return later;
  }
  /// The difference of the largest and the smallest height.
  double span() const {
    double low = INFINITY, high = -INFINITY;
    for (const auto& value : values) {
      low = std::min(low, value.z());
      high = std::max(high, value.z());
    }
    return high - low;
  }
};

/// Nodes that the test strikes, and all that they have said.
class FaultSession {
 public:
  static constexpr double kTick = 1e-3;      ///< s
  static constexpr double kStill = 2e-9;     ///< m
  static constexpr double kStart = 32e-6;    ///< m, of the needle, 4 um above the cell
  static constexpr double kStopTime = 0.01;  ///< s, motion/stop_time: from a set-point that rests to such a needle
  static constexpr double kInputs = 0.05;  ///< s, of the controller's inputs, and of hand, needle, force at the bridge
  static constexpr double kController = 0.25;  ///< s, timeouts/controller of bridge and follower
  static constexpr double kLink = 0.3;         ///< s, link/timeout

  explicit FaultSession(const std::vector<std::string>& overrides) : session_(overrides) {
    session_.executive().add("records", [this](Bus& bus) { return records_ = std::make_shared<Records>(bus); });
  }

  VirtualSession& session() { return session_; }

  /// Between two steps of all nodes, after which the node says nothing more. @returns the time (s)
  double strike(const std::string& node, NodeFault fault) {
    fault == NodeFault::kKill ? session_.executive().kill(node) : session_.executive().freeze(node);
    return session_.now().toSec();
  }
  /// To a phase of the virtual hand's motion, and some seconds into it.
  void runIntoPhase(const std::string& phase, double seconds) {
    ASSERT_TRUE(session_.until([&] { return said(records_->phase, phase); }, 3)) << phase;
    session_.run(seconds);
  }
  /// To a state of the injection, and some seconds into it.
  void runIntoState(const std::string& state, double seconds) {
    ASSERT_TRUE(
        session_.until([&] { return records_->injection.newest() && records_->injection.newest()->state == state; }, 3))
        << state;
    session_.run(seconds);
  }

  Track needle() const { return track(records_->needle, &geometry_msgs::PoseStamped::pose); }
  Track setpoint() const { return track(records_->setpoint, &geometry_msgs::PoseStamped::pose); }
  const Probe<geometry_msgs::PoseStamped>& target() const { return records_->target; }
  Track hand() const { return track(records_->hand, &geometry_msgs::PoseStamped::pose); }
  Track force() const { return track(records_->force, &geometry_msgs::WrenchStamped::wrench); }
  const Probe<geometry_msgs::WrenchStamped>& forces() const { return records_->force; }
  const Probe<cell_microinjection::InjectorState>& injector() const { return records_->injector; }

  /// It moved until the node was struck, and from `within` (s) afterwards it rests for good.
  static void expectRests(const Track& track, double struck, double within) {
    ASSERT_FALSE(track.times.empty());
    ASSERT_GT(track.times.back(), struck + within + 0.1);
    double low = INFINITY, high = -INFINITY, late = -INFINITY;
    for (std::size_t i = 0; i < track.times.size(); ++i) {
      const double height = track.values[i].z();
      if (track.times[i] > struck - 0.02 && track.times[i] <= struck) {
        low = std::min(low, height);
        high = std::max(high, height);
      }
      if ((track.values[i] - track.values.back()).norm() > kStill) late = track.times[i] - struck;
    }
    EXPECT_GT(high - low, 50e-9) << "it did not move before";
    EXPECT_LE(late, within + kTick) << "it moved for so long";
  }
  /// It was zero for good as soon as the time-out had elapsed, or `earlier` (s) before. The 0.11 N of these sessions
  /// take two steps to fall, by the bridge's force_rate_limit.
  static void expectForceEnds(const Track& force, double struck, double within, double earlier = 0) {
    ASSERT_FALSE(force.times.empty());
    ASSERT_GT(force.times.back(), struck + within + 0.1);
    double felt = -INFINITY;
    for (std::size_t i = 0; i < force.times.size(); ++i) {
      if (force.values[i].norm() > 0) felt = force.times[i] - struck;
    }
    EXPECT_LT(felt, within + 2 * kTick) << "it was felt for so long";
    EXPECT_GE(felt, within - earlier - 2 * kTick) << "it was felt no longer";
  }
  static void expectNoForce(const Track& force) {
    ASSERT_FALSE(force.values.empty());
    for (const auto& value : force.values) ASSERT_EQ(value.norm(), 0);
  }
  /// The needle goes on, and the cell is felt, as if nothing had been.
  void expectGoesOn(double struck) const {
    EXPECT_GT(needle().since(struck + 0.06).span(), 0.5e-6);
    const Track felt = force().since(struck + 0.06);
    EXPECT_GT(felt.values.size(), 40u);
    for (const auto& value : felt.values) ASSERT_GT(value.norm(), 0);
  }

 private:
  /// A node without steps: it hears each message in the instant in which it is said.
  struct Records {
    explicit Records(Bus& bus)
        : needle(bus, "needle/measured_cp"),
          setpoint(bus, "needle/servo_cp"),
          hand(bus, "haptic/measured_cp"),
          target(bus, "teleop/servo_cp"),
          force(bus, "haptic/servo_cf"),
          injector(bus, "injector/state"),
          injection(bus, "controller/injection_state"),
          phase(bus, "virtual_hand/phase") {}
    Probe<geometry_msgs::PoseStamped> needle, setpoint, hand, target;
    Probe<geometry_msgs::WrenchStamped> force;
    Probe<cell_microinjection::InjectorState> injector;
    Probe<cell_microinjection::InjectionStatus> injection;
    Probe<cell_microinjection::StringStamped> phase;
  };

  static bool said(const Probe<cell_microinjection::StringStamped>& words, const std::string& word) {
    return words.newest() && words.newest()->string == word;
  }
  static Eigen::Vector3d vectorOf(const geometry_msgs::Pose& pose) { return toVector(pose.position); }
  static Eigen::Vector3d vectorOf(const geometry_msgs::Wrench& wrench) { return toVector(wrench.force); }
  template <typename Message, typename Value>
  static Track track(const Probe<Message>& probe, Value Message::*value) {
    Track track;
    for (std::size_t i = 0; i < probe.count(); ++i) {
      track.times.push_back(probe.arrivals()[i].toSec());
      track.values.push_back(vectorOf((*probe.all()[i]).*value));
    }
    return track;
  }

  VirtualSession session_;
  std::shared_ptr<Records> records_;
};

}  // namespace microinjection
