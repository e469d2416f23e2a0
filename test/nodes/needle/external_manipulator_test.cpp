// A needle that another node moves: what is wrong with that node holds the needle, with the reason, and nothing leaps
// after it. rig_node_test.cpp asks of it what it asks of each rig.

#include "nodes/needle/external_manipulator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <ostream>
#include <regex>
#include <sstream>
#include <utility>

#include "base/errors.h"
#include "needle_bench.h"
#include "nodes/executive/executive.h"

namespace microinjection {
namespace {

constexpr char kRigStatus[] = "micromanipulator: rig";
constexpr double kStreamSpeed = 50e-6;  // m/s

/// The stream of a controller that goes on whatever happens, along x at kStreamSpeed.
class ExternalManipulatorTest : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(enabled()) << bench_.status(); }

  bool enabled(double limit = 5) {
    return bench_.until([&] { return bench_.state() == "ENABLED"; }, limit);
  }
  void stream() {
    const Eigen::Vector3d start = bench_.needle();
    const ros::Time begin = bench_.session.now();
    bench_.world.repeat<geometry_msgs::PoseStamped>("needle/servo_cp", [this, start, begin] {
      const double way = kStreamSpeed * secondsBetween(begin, bench_.session.now());
      return std::optional(poseAt(start + Eigen::Vector3d(way, 0, 0)));
    });
  }
  void streamUntilItMoves() {
    stream();
    ASSERT_TRUE(bench_.until([&] { return stage_.position.x() > 10e-6; }, 1)) << bench_.status();
  }
  /// m, from where the stage is now, in so many seconds, truly.
  double wanders(double seconds) {
    const Eigen::Vector3d begin = stage_.position;
    double farthest = 0;
    bench_.until(
        [&] {
          farthest = std::max(farthest, (stage_.position - begin).norm());
          return false;
        },
        seconds);
    return farthest;
  }
  /// After a pause a stream that begins at the needle is followed.
  void expectFollowsAnew() {
    bench_.silence();
    bench_.run(0.2);
    const Eigen::Vector3d goal = bench_.needle() + Eigen::Vector3d(5e-6, 0, 0);
    bench_.servo(poseAt(goal));
    EXPECT_TRUE(bench_.until([&] { return (stage_.tip() - goal).norm() < 0.2e-6; }, 1)) << bench_.status();
    bench_.silence();
  }
  std::string rigValue(const std::string& key) { return bench_.session.diagnostics().value(kRigStatus, key); }
  std::string rigText() { return bench_.session.diagnostics().text(kRigStatus); }

  NeedleBench bench_{"external"};
  LabStage& stage_ = *bench_.session.stage();
};

struct StageFault {
  std::string name, reason;
  std::function<void(VirtualSession&, LabStage&)> begin, end;
  double noticed = 0.15;  ///< s, until it is
  friend std::ostream& operator<<(std::ostream& out, const StageFault& fault) { return out << fault.name; }
};

sensor_msgs::JointState foreignJoints() {
  sensor_msgs::JointState message;
  message.name = {"x", "y", "z"};
  message.position = {1e-3, 0, 0};
  return message;
}

const std::vector<StageFault> kStageFaults = {
    {"silent", "s old, allowed 0.1 s (timeout)",
     [](auto& session, auto& stage) { stage.silent_until = session.now() + durationOf(1000); },
     [](auto&, auto& stage) { stage.silent_until = ros::Time(); }},
    {"repeats_a_stamp", "repeats a stamp", [](auto&, auto& stage) { stage.repeats_stamp = true; },
     [](auto&, auto& stage) { stage.repeats_stamp = false; }},
    {"has_no_stamp", "its stamp is 0", [](auto&, auto& stage) { stage.stamps_nothing = true; },
     [](auto&, auto& stage) { stage.stamps_nothing = false; }},
    {"not_finite", "not finite", [](auto&, auto& stage) { stage.told_beside = NAN; },
     [](auto&, auto& stage) { stage.told_beside = 0; }},
    {"other_joints", "has no position of the joint z", [](auto&, auto& stage) { stage.joint = "focus"; },
     [](auto&, auto& stage) { stage.joint = "z"; }},
    {"too_seldom", "comes at", [](auto&, auto& stage) { stage.period = 0.02; },
     [](auto&, auto& stage) { stage.period = 0.01; }, 0.6},
    {"two_publishers", "is sent by two nodes, /my_rig and /stranger",
     [](auto& session, auto&) { session.addTestNode("stranger").repeat("my_rig/measured_js", foreignJoints()); },
     [](auto& session, auto&) { session.executive().kill("stranger"); }},
    {"disabled", "/my_rig is DISABLED", [](auto&, auto& stage) { stage.state = "DISABLED"; },
     [](auto&, auto& stage) {
       stage.target = stage.position;
       stage.state = "ENABLED";
     }},
    {"paused", "/my_rig is PAUSED", [](auto&, auto& stage) { stage.state = "PAUSED"; },
     [](auto&, auto& stage) { stage.state = "ENABLED"; }},
    {"not_homed", "/my_rig is not homed", [](auto&, auto& stage) { stage.homed = false; },
     [](auto&, auto& stage) { stage.homed = true; }},
    {"node_ended", "s old, allowed 0.1 s (timeout)", [](auto& session, auto&) { session.executive().kill("my_rig"); },
     [](auto& session, auto&) { session.executive().restart("my_rig"); }},
    {"node_frozen", "s old, allowed 0.1 s (timeout)",
     [](auto& session, auto&) { session.executive().freeze("my_rig"); },
     [](auto& session, auto&) { session.executive().thaw("my_rig"); }},
};

class StageFaultTest : public ExternalManipulatorTest, public testing::WithParamInterface<StageFault> {};

TEST_P(StageFaultTest, HoldsTheNeedleAndNothingLeapsAfterIt) {
  streamUntilItMoves();
  GetParam().begin(bench_.session, stage_);
  ASSERT_TRUE(bench_.until([&] { return bench_.state() == "DISABLED"; }, GetParam().noticed)) << bench_.state();
  EXPECT_LE(wanders(1), 1e-6) << "it is held";
  EXPECT_TRUE(contains(bench_.status(), GetParam().reason));
  EXPECT_NE(bench_.level(), 0);
  EXPECT_TRUE(contains(rigText(), GetParam().reason));

  GetParam().end(bench_.session, stage_);
  ASSERT_TRUE(enabled()) << bench_.status();
  EXPECT_LE(wanders(1), 1e-6) << "the stream goes on, 50 um and more ahead";
  expectFollowsAnew();
}

INSTANTIATE_TEST_SUITE_P(ExternalManipulator, StageFaultTest, testing::ValuesIn(kStageFaults),
                         [](const auto& info) { return info.param.name; });

/// What is no pause but a fault: it waits for enable.
class StageErrorTest : public ExternalManipulatorTest {
 protected:
  void expectFault(const std::string& reason, double limit = 1) {
    ASSERT_TRUE(bench_.until([&] { return bench_.state() == "FAULT"; }, limit)) << bench_.state();
    bench_.run(0.2);
    EXPECT_TRUE(contains(bench_.status(), "/my_rig: "));
    EXPECT_TRUE(contains(bench_.status(), reason));
    bench_.run(2);
    EXPECT_EQ(bench_.state(), "FAULT") << "it waits for enable";
  }
  void expectEnables() {
    bench_.command("enable");
    ASSERT_TRUE(enabled()) << bench_.status();
    EXPECT_LE(wanders(1), 1e-6);
    expectFollowsAnew();
  }
};

TEST_F(StageErrorTest, ItsOwnFaultWhichEnableAsksItToLeave) {
  streamUntilItMoves();
  stage_.state = "FAULT";
  expectFault("it is in FAULT");
  expectEnables();
  EXPECT_EQ(stage_.last_word, "enable");
}

TEST_F(StageErrorTest, AStageThatIsLaterThanItSays) {
  stage_.time_constant = 0.2;
  stream();
  expectFault("off the path that was commanded in the last 0.05 s (lag), allowed 2 um (path_tolerance)");
  EXPECT_LT(stage_.position.x(), 20e-6);
  stage_.time_constant = 5e-3;
  expectEnables();
}

TEST_F(StageErrorTest, AStageThatDoesNotObey) {
  stage_.obeys = false;
  stream();
  expectFault("off the path");
  stage_.obeys = true;
  expectEnables();
}

TEST_F(StageErrorTest, AStageThatMovesByItselfWhileItIsCommanded) {
  bench_.servo(poseAt(bench_.needle()));
  bench_.run(0.3);
  stage_.obeys = false;
  stage_.own_speed = 100e-6;
  expectFault("something else moves it");
  stage_.own_speed = 0;
  stage_.target = stage_.position;
  stage_.obeys = true;
  expectEnables();
}

TEST_F(StageErrorTest, APositionThatLeapsIsNotValid) {
  bench_.servo(poseAt(bench_.needle()));
  bench_.run(0.3);
  stage_.told_beside = 100e-6;
  expectFault("its position is 173 um from the one");
  EXPECT_TRUE(std::isnan(bench_.needle().x()));
  stage_.told_beside = 0;
  bench_.run(0.1);
  expectEnables();
}

/// By hand, or it counts from 0 where it was switched on.
TEST_F(StageErrorTest, AnotherPositionThanBeforeAPause) {
  bench_.session.executive().kill("my_rig");
  ASSERT_TRUE(bench_.until([&] { return bench_.state() == "DISABLED"; }, 1));
  stage_.position.z() += 5e-6;
  bench_.session.executive().restart("my_rig");
  expectFault("its position is 5 um from the one");
  EXPECT_TRUE(contains(bench_.status(), "check its origin, then enable"));
  EXPECT_TRUE(std::isnan(bench_.needle().x()));
  expectEnables();
}

TEST_F(StageErrorTest, ASecondNodeThatCommandsIt) {
  streamUntilItMoves();
  TestNode& stranger = bench_.session.addTestNode("stranger");
  stranger.sayNow("my_rig/servo_jp", foreignJoints());
  expectFault("two nodes command it on /my_rig/servo_jp: /micromanipulator and /stranger");
  EXPECT_LE((stage_.tip() - bench_.needle()).norm(), 1e-6) << "it is held where it is";
  expectEnables();
}

TEST_F(ExternalManipulatorTest, EnableIsPassedOn) {
  for (const auto& [state, word] : {std::pair("DISABLED", "enable"), std::pair("PAUSED", "resume")}) {
    stage_.state = state;
    ASSERT_TRUE(bench_.until([&] { return bench_.state() == "DISABLED"; }, 0.1));
    EXPECT_LE((bench_.needle() - stage_.tip()).norm(), 1e-9) << "its position is known all the same";
    bench_.command("enable");
    ASSERT_TRUE(enabled(0.1)) << bench_.status();
    EXPECT_EQ(stage_.last_word, word);
  }
}

/// One enable is enough for a stream that waits at the needle, as that of a controller which yields to its rig.
TEST_F(ExternalManipulatorTest, AStreamThatWaitsAtTheNeedleGoesOnAfterOneEnable) {
  double ahead = 0;  // m
  bench_.world.repeat<geometry_msgs::PoseStamped>("needle/servo_cp",
                                                  [&]() -> std::optional<geometry_msgs::PoseStamped> {
                                                    return poseAt(bench_.needle() + Eigen::Vector3d(ahead, 0, 0));
                                                  });
  bench_.run(0.3);
  stage_.state = "DISABLED";
  ASSERT_TRUE(bench_.until([&] { return bench_.state() == "DISABLED"; }, 0.1));
  bench_.run(1);
  bench_.command("enable");
  ASSERT_TRUE(enabled(0.1)) << bench_.status();
  bench_.run(0.1);
  const double begin = stage_.position.x();
  ahead = 3e-6;
  EXPECT_TRUE(bench_.until([&] { return stage_.position.x() > begin + 10e-6; }, 2)) << bench_.status();
}

/// Its DISABLED let an old target be pursued, far away after the stage was moved by hand.
TEST_F(ExternalManipulatorTest, AnOldTargetOfTheNodeIsNotPursued) {
  stage_.pursues_old_targets = true;
  streamUntilItMoves();
  stage_.state = "DISABLED";
  bench_.run(0.1);
  bench_.silence();
  stage_.own_speed = 1e-3;
  bench_.run(0.5);
  stage_.own_speed = 0;
  bench_.run(0.1);
  bench_.command("enable");
  EXPECT_LE(wanders(1), 10e-6) << "500 um without the first set-point, which is the needle";
  ASSERT_TRUE(enabled()) << bench_.status();
  expectFollowsAnew();
}

TEST_F(ExternalManipulatorTest, RateAndLagAreMeasured) {
  stream();
  bench_.run(1);
  EXPECT_EQ(bench_.session.diagnostics().of(kRigStatus)->level, 0) << rigText();
  EXPECT_NEAR(std::stod(rigValue("rate of its positions (Hz)")), 100, 3);
  EXPECT_EQ(rigValue("lag that was told (s)"), "0.05");
  const double lag = std::stod(rigValue("largest lag since the last report (s)"));
  EXPECT_GT(lag, 0.005) << "the servo's";
  EXPECT_LT(lag, 0.025) << "and a period of the set-points'";
  EXPECT_LT(std::stod(rigValue("age of a position at its arrival (s)")), 2e-3);
  bench_.silence();
  bench_.run(0.3);
  EXPECT_EQ(rigValue("largest lag since the last report (s)"), "0") << "at rest nothing is late";
  stage_.time_constant = 0.06;  // too little for a fault at this speed
  stream();
  bench_.run(0.6);
  EXPECT_TRUE(contains(rigText(), "s late, told are 0.05 s (lag)"));
  EXPECT_EQ(bench_.state(), "ENABLED");
}

TEST_F(ExternalManipulatorTest, ASetPointThatItNeverReachesIsNoted) {
  bench_.move(bench_.needle() + Eigen::Vector3d(3e-6, 0, 0));
  ASSERT_TRUE(bench_.until([&] { return stage_.position.x() > 2e-6; }, 2));
  stage_.obeys = false;
  bench_.run(2);
  EXPECT_TRUE(bench_.busy());
  EXPECT_TRUE(contains(bench_.session.diagnostics().value(kNeedleStatus, "device's note"), "beside its set-point"));
}

TEST(ExternalRigPoses, AreInTheFrameThatWasTold) {
  NeedleBench bench("external",
                    "{device: {positions: poses, frame: stage, directions: [1, 1, -1], origin: [0, 0, 1e-3]}}");
  LabStage& stage = *bench.session.stage();
  bench.run(1);
  EXPECT_EQ(bench.state(), "DISABLED");
  EXPECT_TRUE(contains(bench.status(), "its frame is world, must be stage"));
  stage.frame = "stage";
  ASSERT_TRUE(bench.until([&] { return bench.state() == "ENABLED"; }, 5)) << bench.status();
  const Eigen::Vector3d begin = bench.needle();
  EXPECT_TRUE(isNear(begin, stage.geometry.tip({0, 0, 1e-3}), 1e-12));
  bench.move(begin + Eigen::Vector3d(0, 20e-6, 50e-6));
  ASSERT_TRUE(bench.until([&] { return bench.busy(); }, 0.1));
  ASSERT_TRUE(bench.until([&] { return !bench.busy(); }, 5));
  EXPECT_TRUE(isNear(stage.position, {0, 20e-6, -50e-6}, 0.2e-6)) << "its third axis counts downwards";
}

/// The URDF of the rig whose third motor is tilted, as that of an InjectMan: sin 11917/15557 above the horizon.
std::string tiltedRig() {
  std::ifstream file(MICROINJECTION_SOURCE_DIR "/urdf/rig.urdf");
  std::ostringstream text;
  text << file.rdbuf();
  const std::string path = testing::TempDir() + "external_rig_test_tilted.urdf";
  std::ofstream(path) << std::regex_replace(text.str(), std::regex("<axis xyz=\"0 0 1\"/>"),
                                            "<axis xyz=\"0.642815 0 0.766022\"/>");
  return path;
}

/// Straight up in world takes two motors, and the needle stays on its line.
TEST(ExternalRigAxes, MayBeOblique) {
  constexpr double kSine = 11917.0 / 15557;
  const double cosine = std::sqrt(1 - kSine * kSine);
  VirtualSession session({"rig.name:=external", "rig.urdf:=" + tiltedRig()});
  session.add("micromanipulator");
  TestNode& world = session.world();
  auto& poses = world.hear<geometry_msgs::PoseStamped>("needle/measured_cp");
  auto& states = world.hear<cell_microinjection::OperatingState>("needle/operating_state");
  LabStage& stage = *session.stage();
  ASSERT_TRUE(session.until([&] { return states.newest() && states.newest()->state == "ENABLED"; }, 5));
  session.run(0.1);
  const Eigen::Vector3d begin = toVector(poses.newest()->pose.position), up(0, 0, 50e-6);
  world.sayNow("needle/move_cp", poseAt(begin + up));
  double beside = 0;
  ASSERT_TRUE(session.until(
      [&] {
        beside = std::max(beside, (stage.tip() - begin).head<2>().norm());
        return (stage.tip() - begin - up).norm() < 0.2e-6;
      },
      5));
  EXPECT_LT(beside, 1e-6);
  EXPECT_NEAR(stage.position.z(), up.z() / kSine, 0.3e-6);
  EXPECT_NEAR(stage.position.x(), -up.z() / kSine * cosine, 0.3e-6);
}

/// A node that only commands moves to a place, which the micromanipulator does by set-points.
TEST(ExternalRigMoves, GoStraightAtTheirSpeed) {
  struct Mover {
    explicit Mover(Bus& bus, const ManipulatorGeometry& geometry) : cycle(bus, 1000), rig(cycle, geometry, {}) {
      cycle.onStep([this](const Cycle::Tick& tick) { rig.step(tick.now.toSec()); });
    }
    Cycle cycle;
    ExternalManipulator rig;
  };
  VirtualSession session({"rig.name:=external"});
  LabStage& stage = *session.stage();
  std::shared_ptr<Mover> mover;
  session.executive().add("mover", [&](Bus& bus) { return mover = std::make_shared<Mover>(bus, stage.geometry); });
  ASSERT_TRUE(session.until([&] { return mover->rig.state() == ManipulatorDevice::State::kReady; }, 2));
  const Eigen::Vector3d goal(30e-6, 0, 40e-6);
  mover->rig.moveTo(goal, 50e-6);
  const ros::Time begin = session.now();
  double beside = 0;
  ASSERT_TRUE(session.until(
      [&] {
        beside = std::max(beside, stage.position.cross(goal.normalized()).norm());
        return !mover->rig.moving();
      },
      5));
  EXPECT_LT(beside, 0.1e-6);
  EXPECT_LT((stage.position - goal).norm(), 0.2e-6);
  EXPECT_NEAR(secondsBetween(begin, session.now()), 1, 0.1) << "50 um at 50 um/s";
  mover.reset();
}

TEST(ExternalManipulatorConfig, NamesWhatIsWrong) {
  const std::pair<const char*, const char*> cases[] = {
      {"{namespace: my rig}", "namespace = my rig: must be the namespace of your node's topics"},
      {"{namespace: /needle}", "namespace = /needle"},
      {"{positions: angles}", "positions = angles: must be one of: joints, poses"},
      {"{joints: [x, x, z]}", "joints"},
      {"{positions: poses, origin: [1e-3, 0, 0]}", "origin"},
      {"{positions: poses, directions: [1, 1, -1]}", "directions"},
      {"{rate: 5}", "rate = 5: must be a number in [20, 1000]"},
      {"{lag: 0}", "lag = 0"},
      {"{rate: 20, timeout: 0.05}", "timeout = 0.05: must be at least two periods of rate, 0.1 s"},
      {"{resolution: 1.5e-6}", "path_tolerance"},
      {"{devise: /my_rig}", "devise: unknown key"}};
  for (const auto& [changes, what] : cases) {
    YAML::Node map = loadYamlMap(MICROINJECTION_SOURCE_DIR "/config/rigs/external.yaml");
    for (const auto& entry : YAML::Load(changes)) map[entry.first.as<std::string>()] = entry.second;
    ConfigReader reader(map, "external.yaml");
    try {
      ExternalManipulatorConfig::read(reader);
      reader.finish();
      ADD_FAILURE() << changes << " is taken";
    } catch (const ConfigError& error) {
      EXPECT_TRUE(contains(error.what(), what));
    }
  }
}

}  // namespace
}  // namespace microinjection
