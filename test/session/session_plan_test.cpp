#include "session/session_plan.h"

#include <algorithm>

#include "base/config_reader.h"
#include "session/parameter_tree.h"
#include "session_folder.h"

namespace microinjection {
namespace {

using Names = std::vector<std::string>;

class SessionPlanTest : public SessionFolder {
 protected:
  static SessionPlan plan(const std::vector<std::string>& arguments = {}, SessionClock clock = SessionClock::kWall) {
    return planOf(session(arguments), clock);
  }
  static Names nodes(const SessionPlan& plan) {
    Names names;
    for (const NodePlan& node : plan.nodes) names.push_back(node.name);
    return names;
  }
  static bool takesPart(const SessionPlan& plan, const std::string& name) { return plan.takesPart(name); }
  /// A parameter as text; "-" when it is not set.
  static std::string at(const SessionPlan& plan, const std::string& node, const std::string& path) {
    const NodePlan* found = plan.node(node);
    const YAML::Node value = found ? parameterAt(found->parameters, path) : YAML::Node(YAML::NodeType::Undefined);
    return value.IsDefined() && value.IsScalar() ? value.Scalar() : "-";
  }
};

TEST_F(SessionPlanTest, TheDefaultSession) {
  const SessionPlan session = plan();
  EXPECT_EQ(session.names(), (Names{"micromanipulator", "force_sensor", "cell_simulator", "injector",
                                    "injection_controller", "haptic_bridge", "virtual_hand", "display", "readiness",
                                    "force_sensor_frame", "robot_state_publisher"}));
  EXPECT_EQ(at(session, "cell_simulator", "scene"), kPackage + "/config/cells/mouse_oocyte_injection.yaml");
  EXPECT_EQ(at(session, "cell_simulator", "needle"), "true");
  EXPECT_EQ(at(session, "cell_simulator", "rate"), "1000");
  EXPECT_EQ(at(session, "micromanipulator", "device/resolution"), "1.0e-9");
  EXPECT_EQ(at(session, "virtual_hand", "wait_for_go"), "false");
  EXPECT_NE(session.parameters["robot_description"].Scalar().find("<robot"), std::string::npos);
  EXPECT_NE(session.text.find("for a cell of"), std::string::npos);
  EXPECT_EQ(std::count(session.files.begin(), session.files.end(), kPackage + "/config/injector.yaml"), 1);
}

/// A parameter of a node that does not take part would be refused by the next node of that name.
TEST_F(SessionPlanTest, TextsAreTexts) {
  const SessionPlan session = plan({"record.folder:=/tmp/1e5", "record.trainee:='007'", "injector:=emulated_femtojet"});
  const auto line = [&](const std::string& node) { return parameterText(session.node(node)->parameters); };
  EXPECT_NE(line("session_recorder").find("trainee: \"007\"\n"), std::string::npos);
  EXPECT_NE(line("cell_simulator").find("needle: \"true\"\n"), std::string::npos);
  EXPECT_NE(line("injector").find("inject: \"901\"\n"), std::string::npos);
  EXPECT_NE(line("injector").find("duration_range: [0.1, 99.9]\n"), std::string::npos);
}

TEST_F(SessionPlanTest, AnEmulatedRigIsAProcessOrInside) {
  const SessionPlan live = plan({"rig.name:=emulated_zaber"});
  const SessionPlan inside = plan({"rig.name:=emulated_zaber"}, SessionClock::kVirtual);
  EXPECT_TRUE(takesPart(live, "emulated_zaber"));
  EXPECT_FALSE(takesPart(inside, "emulated_zaber"));
  EXPECT_EQ(at(live, "micromanipulator", "emulated"), "false");
  EXPECT_EQ(at(inside, "micromanipulator", "emulated"), "true");
  EXPECT_EQ(at(live, "micromanipulator", "rig"), "zaber");
  EXPECT_EQ(at(live, "cell_simulator", "needle"), "measured");
  EXPECT_EQ(live.processes.front().arguments[2], at(live, "micromanipulator", "device/port/path"));
  EXPECT_EQ(at(plan({"rig.name:=zaber", "rig.port:=/dev/ttyUSB0"}), "micromanipulator", "device/port/path"),
            "/dev/ttyUSB0");
  EXPECT_EQ(at(plan({"rig.name:=zaber"}), "micromanipulator", "device/port/path"), "/tmp/emulated_zaber");
  EXPECT_EQ(
      at(plan({"rig.name:=sensapex", "rig.port:=udp:169.254.10.1:55555"}), "micromanipulator", "device/port/path"),
      "udp:169.254.10.1:55555");
  const SessionPlan own = plan({"rig.name:=external", "rig.namespace:=/my_rig", "rig.port:=/dev/ttyUSB0"});
  EXPECT_EQ(at(own, "micromanipulator", "rig"), "external");
  EXPECT_EQ(at(own, "micromanipulator", "device/namespace"), "/my_rig");
  EXPECT_EQ(at(own, "micromanipulator", "device/port/path"), "-") << "it has no port";
  EXPECT_EQ(at(own, "cell_simulator", "needle"), "measured");
  EXPECT_EQ(at(plan({"rig.name:=external"}), "micromanipulator", "device/rate"), "100");
  // An emulated rig never moves the real one.
  const SessionPlan dry = plan({"rig.name:=emulated_zaber", "rig.port:=/dev/ttyUSB0"});
  EXPECT_EQ(at(dry, "micromanipulator", "device/port/path"), dry.processes.front().arguments[2]);
  EXPECT_EQ(at(plan({"rig.config:=imperfect"}), "micromanipulator", "device/backlash"), "1.0e-6");
}

TEST_F(SessionPlanTest, AHolderHasItsPressureLine) {
  EXPECT_FALSE(takesPart(plan(), "holder"));
  const SessionPlan simulated = plan({"holder:=sim"}), real = plan({"holder:=voltage", "rig.name:=zaber"});
  EXPECT_EQ(at(simulated, "holder", "source"), "simulated");
  EXPECT_EQ(at(simulated, "holder", "auto_enable"), "true");
  EXPECT_EQ(at(simulated, "injector", "source"), "simulated");
  EXPECT_EQ(at(real, "holder", "source"), "serial");
  EXPECT_EQ(at(real, "holder", "auto_enable"), "false");
  EXPECT_EQ(at(real, "holder", "serial/pressure_unit"), "5000");
  EXPECT_EQ(at(real, "holder", "line/tube_compliance"), "1.0e-14");
  EXPECT_EQ(at(plan({"holder:=emulated_arduino"}), "holder", "emulated"), "arduino");
  EXPECT_EQ(at(plan({"holder:=sim", "record.folder:=/out"}), "session_recorder", "holder"), "true");
  EXPECT_EQ(at(plan({"record.folder:=/out"}), "session_recorder", "holder"), "-");
}

TEST_F(SessionPlanTest, ASecondManipulatorCarriesTheHoldingPipette) {
  const SessionPlan none = plan();
  EXPECT_FALSE(takesPart(none, "holder_rig"));
  EXPECT_EQ(at(none, "micromanipulator", "other/tip"), "-");
  EXPECT_TRUE(none.node("micromanipulator")->remaps.empty());
  EXPECT_EQ(none.parameters["robot_description"].Scalar().find("holding_base"), std::string::npos);

  const SessionPlan two =
      plan({"holder_rig.name:=sim", "overrides.micromanipulator.pipette_tilt:=0.5", "rig.name:=emulated_zaber"});
  const NodePlan& holder = *two.node("holder_rig");
  EXPECT_EQ(holder.program, "micromanipulator");
  EXPECT_EQ(holder.remaps.at("/needle/move_cp"), "/holder_rig/move_cp");
  EXPECT_EQ(holder.remaps.at("/other_rig/measured_cp"), "/needle/measured_cp");
  EXPECT_EQ(two.node("micromanipulator")->remaps.at("/other_rig/measured_cp"), "/holder_rig/measured_cp");
  EXPECT_EQ(at(two, "holder_rig", "tip"), "holding_pipette");
  EXPECT_EQ(at(two, "holder_rig", "auto_enable"), "false");
  EXPECT_EQ(at(two, "holder_rig", "other/tilt"), "0.5");
  EXPECT_EQ(at(two, "holder_rig", "rig"), "sim");
  EXPECT_EQ(at(two, "micromanipulator", "rig"), "zaber");
  EXPECT_NE(two.parameters["robot_description"].Scalar().find("holding_stage_z_to_holding_pipette"), std::string::npos);

  const SessionPlan same = plan({"holder_rig.name:=emulated_zaber", "rig.name:=emulated_zaber"});
  EXPECT_NE(at(same, "micromanipulator", "device/port/path"), at(same, "holder_rig", "device/port/path"));
  EXPECT_TRUE(takesPart(same, "emulated_zaber"));
  EXPECT_TRUE(takesPart(same, "holder_emulated_zaber"));
  EXPECT_EQ(at(plan({"holder_rig.name:=zaber", "holder_rig.port:=/dev/ttyUSB1"}), "holder_rig", "device/port/path"),
            "/dev/ttyUSB1");
}

TEST_F(SessionPlanTest, TwoRigsHaveTwoLines) {
  const auto refused = [](const Names& arguments) { return refusalOf([&] { plan(arguments); }); };
  EXPECT_NE(refused({"rig.name:=zaber", "holder_rig.name:=zaber"})
                .find("holder_rig/port = auto with rig/name = zaber: must be another one than rig/port"),
            std::string::npos);
  EXPECT_EQ(refused({"rig.name:=zaber", "holder_rig.name:=zaber", "holder_rig.port:=/dev/ttyUSB1"}), "");
  EXPECT_EQ(refused({"rig.name:=zaber", "holder_rig.name:=mp285"}), "");
  EXPECT_NE(refused({"rig.name:=zaber", "rig.port:=/dev/a", "holder_rig.name:=mp285", "holder_rig.port:=/dev/a"}), "");
  EXPECT_NE(refused({"rig.name:=external", "holder_rig.name:=external"}).find("holder_rig/namespace"),
            std::string::npos);
  EXPECT_EQ(refused({"rig.name:=external", "holder_rig.name:=external", "holder_rig.namespace:=/my_holder"}), "");
  EXPECT_NE(refused({"holder_rig.name:=sim", "holder_rig.urdf:=" + kPackage + "/urdf/rig.urdf"})
                .find("has no link holding_base"),
            std::string::npos);
}

TEST_F(SessionPlanTest, AHiddenCellIsAtTheNeedleAndTheBelievedOneIsServed) {
  const SessionPlan session = plan({"hidden:=zebrafish_embryo", "camera.source:=sim", "estimator:=true"});
  EXPECT_EQ(at(session, "true_cell", "scene"), kPackage + "/config/cells/zebrafish_embryo.yaml");
  EXPECT_EQ(session.node("true_cell")->program, "cell_simulator");
  EXPECT_EQ(session.node("true_cell")->remaps.at("/cell/set_parameters"), "/true_cell/set_parameters");
  EXPECT_EQ(session.node("force_sensor")->remaps.at("/cell/predicted_cf"), "/true_cell/predicted_cf");
  EXPECT_EQ(session.node("microscope")->remaps.at("/cell/state"), "/true_cell/state");
  EXPECT_EQ(session.node("vision")->remaps.at("/cell/state"), "/true_cell/state");
  EXPECT_EQ(session.node("touch")->remaps.at("/cell/contact"), "/true_cell/contact");
  // Whatever the true cell says, the estimated one says under its own name.
  for (const char* topic : {"predicted_cf", "contact", "state", "set_parameters", "parameters"})
    EXPECT_EQ(session.node("true_cell")->remaps.at(std::string("/cell/") + topic), std::string("/true_cell/") + topic);
  EXPECT_TRUE(session.node("injection_controller")->remaps.empty());
  EXPECT_EQ(at(session, "cell_estimator", "serve"),
            at(plan({"estimator:=true", "sensor.source:=serial"}), "cell_estimator", "serve"));
}

TEST_F(SessionPlanTest, ATwinDoesNotServeItselfWhatItHasServed) {
  EXPECT_EQ(at(plan({"estimator:=true"}), "cell_estimator", "serve"), "false");
  EXPECT_NE(at(plan({"estimator:=true", "sensor.source:=topic"}), "cell_estimator", "serve"), "false");
  EXPECT_EQ(at(plan({"estimator:=true", "sensor.source:=none", "camera.source:=sim"}), "cell_estimator", "serve"),
            "false");
  EXPECT_NE(at(plan({"estimator:=true", "sensor.source:=none", "camera.source:=device"}), "cell_estimator", "serve"),
            "false");
}

TEST_F(SessionPlanTest, ALinkIsEmulatedOrDirect) {
  const SessionPlan emulated = plan({"link.scheme:=wave", "link.delay:=0.05"}), direct = plan({"link.scheme:=wave"});
  EXPECT_EQ(at(emulated, "link_emulator", "delay"), "0.05");
  EXPECT_TRUE(emulated.node("haptic_bridge")->remaps.empty());
  EXPECT_FALSE(takesPart(direct, "link_emulator"));
  EXPECT_EQ(direct.node("haptic_bridge")->remaps.at("/link/hand/received"), "/link/rig/sent");
  EXPECT_EQ(direct.node("teleoperation_follower")->remaps.at("/link/rig/received"), "/link/hand/sent");
  EXPECT_EQ(at(direct, "haptic_bridge", "link/scheme"), "wave");
  EXPECT_EQ(at(direct, "haptic_bridge", "timeouts/controller"), "0.25");
  EXPECT_EQ(at(plan(), "haptic_bridge", "link/scheme"), "none");
  EXPECT_EQ(at(plan({"link.scheme:=wave", "force.hand:=blend"}), "teleoperation_follower", "force_source"), "blend");
  EXPECT_FALSE(takesPart(plan({"link.scheme:=wave", "hand.device:=none"}), "teleoperation_follower"));
}

TEST_F(SessionPlanTest, TheHandMayFeelAnotherForceThanTheController) {
  const std::tuple<std::string, std::string, std::string> cases[] = {
      {"", "predicted", "predicted"},
      {"force.hand:=blend", "blend", "predicted"},
      {"force.controller:=measured", "measured", "measured"}};
  for (const auto& [argument, hand, controller] : cases) {
    const SessionPlan session = plan(argument.empty() ? Names{} : Names{argument});
    EXPECT_EQ(at(session, "haptic_bridge", "force_source"), hand);
    EXPECT_EQ(at(session, "injection_controller", "force_source"), controller);
  }
}

TEST_F(SessionPlanTest, AHandThatMayFallNeedsItsOperator) {
  for (const char* hand :
       {"dvrk", "external", "falcon", "force_dimension", "geomagic", "joy", "keyboard", "marker", "omni", "spacenav"})
    EXPECT_EQ(at(plan({std::string("hand.device:=") + hand}), "haptic_bridge", "require_operator"), "true") << hand;
  for (const char* hand : {"external", "force_dimension", "dvrk", "falcon"})
    EXPECT_EQ(at(plan({std::string("hand.device:=") + hand, "hand.require_operator:=false"}), "haptic_bridge",
                 "require_operator"),
              "false")
        << hand;
}

TEST_F(SessionPlanTest, EachKnownDriverHasItsOwnTopics) {
  const std::tuple<std::string, std::string, std::string> cases[] = {{"force_dimension", "/Falcon00", "body/servo_cf"},
                                                                     {"dvrk", "/MTMR", "body/servo_cf"},
                                                                     {"falcon", "/falcon", "servo_cf"}};
  for (const auto& [hand, device, force] : cases) {
    const SessionPlan session = plan({"hand.device:=" + hand});
    EXPECT_EQ(at(session, "haptic_device", "kind"), "crtk");
    EXPECT_EQ(at(session, "haptic_device", "device"), device);
    EXPECT_EQ(at(session, "haptic_device", "force"), force);
    EXPECT_EQ(at(session, "force_watchdog", "device"), device);
    const std::string watched = at(session, "force_watchdog", "force");
    EXPECT_EQ(watched == "-" ? "servo_cf" : watched, force);
    EXPECT_TRUE(session.node("haptic_device")->respawn);
    EXPECT_TRUE(session.node("force_watchdog")->respawn);
  }
}

TEST_F(SessionPlanTest, TopicsOfAKnownDriver) {
  const SessionPlan session = plan({"hand.device:=dvrk", "hand.topics.namespace:=/MTML",
                                    "hand.topics.operator_present:=/pedal", "hand.position_type:=transform"});
  EXPECT_EQ(at(session, "haptic_device", "device"), "/MTML");
  EXPECT_EQ(at(session, "force_watchdog", "device"), "/MTML");
  EXPECT_EQ(at(session, "haptic_device", "operator_present/topic"), "/pedal");
  EXPECT_EQ(at(session, "haptic_device", "clutch/topic"), "/console/clutch");
  EXPECT_EQ(at(session, "haptic_device", "position_type"), "transform");
}

TEST_F(SessionPlanTest, AnExternalDeviceHasTopicsOfItsOwnForAllNodes) {
  const SessionPlan session =
      plan({"hand.device:=external", "hand.topics.namespace:=/arm", "hand.topics.force:=/arm/body/servo_cf"});
  EXPECT_FALSE(takesPart(session, "haptic_device"));
  EXPECT_EQ(at(session, "force_watchdog", "kind"), "-");
  for (const NodePlan& node : session.nodes) {
    EXPECT_EQ(node.remaps.at("/haptic/measured_cp"), "/arm/measured_cp") << node.name;
    EXPECT_EQ(node.remaps.at("/haptic/servo_cf"), "/arm/body/servo_cf");
    EXPECT_EQ(node.remaps.at("/haptic/operator_present"), "/arm/operator_present");
  }
  EXPECT_EQ(plan({"hand.device:=external"}).nodes.front().remaps.at("/haptic/clutch"), "/haptic/clutch");
}

TEST_F(SessionPlanTest, NodesOfEachHand) {
  const std::map<std::string, std::pair<bool, bool>> adapter_and_watchdog = {
      {"virtual_hand", {false, false}}, {"none", {false, false}}, {"keyboard", {false, false}},
      {"external", {false, true}},      {"joy", {true, false}},   {"marker", {true, false}},
      {"spacenav", {true, false}},      {"omni", {true, true}},   {"geomagic", {true, true}},
      {"dvrk", {true, true}},           {"falcon", {true, true}}, {"force_dimension", {true, true}}};
  for (const auto& [hand, has] : adapter_and_watchdog) {
    const SessionPlan live = plan({"hand.device:=" + hand}),
                      virtual_ = plan({"hand.device:=" + hand}, SessionClock::kVirtual);
    EXPECT_EQ(takesPart(live, "haptic_device"), has.first) << hand;
    EXPECT_EQ(takesPart(live, "force_watchdog"), has.second) << hand;
    EXPECT_EQ(takesPart(virtual_, "haptic_device"), has.first) << hand;
    EXPECT_FALSE(takesPart(virtual_, "force_watchdog")) << hand;
    EXPECT_EQ(takesPart(live, "virtual_hand"), hand == "virtual_hand") << hand;
    EXPECT_EQ(takesPart(live, "haptic_bridge"), hand != "none") << hand;
  }
  const SessionPlan omni = plan({"hand.device:=omni"});
  EXPECT_EQ(at(omni, "force_watchdog", "kind"), "omni");
  EXPECT_EQ(at(omni, "force_watchdog", "device"), "phantom");
  // The watchdog follows the adapter to another device.
  for (const std::string& hand : {"omni", "dvrk"}) {
    const SessionPlan other = plan({"hand.device:=" + hand, "overrides.haptic_device.device:=left"});
    EXPECT_EQ(at(other, "haptic_device", "device"), "left") << hand;
    EXPECT_EQ(at(other, "force_watchdog", "device"), "left") << hand;
  }
}

TEST_F(SessionPlanTest, TheKeyboardInItsTerminalHasTheParametersOfTheSession) {
  const SessionPlan session = plan({"hand.device:=keyboard", "overrides.keyboard_hand.step:=2.0e-3"});
  EXPECT_EQ(parameterAt(session.parameters, "keyboard_hand/hand_speed").as<double>(), 0.01);
  EXPECT_EQ(parameterAt(session.parameters, "keyboard_hand/step").as<double>(), 2e-3);
  EXPECT_FALSE(parameterAt(plan({"hand.device:=omni"}).parameters, "keyboard_hand").IsDefined());
}

TEST_F(SessionPlanTest, EachSourceOfImages) {
  const Names seeing = {"vision", "calibration", "visual_servo", "focus", "touch"};
  for (const auto& [source, node] : std::map<std::string, std::string>{
           {"sim", "microscope"}, {"device", "camera"}, {"folder", "camera"}, {"video", "camera"}, {"topic", ""}}) {
    const SessionPlan session =
        plan({"camera.source:=" + source, "camera.path:=/data/stack", "display.console:=inject"});
    for (const std::string& each : seeing) EXPECT_TRUE(takesPart(session, each)) << source << " " << each;
    EXPECT_EQ(takesPart(session, "microscope"), node == "microscope") << source;
    EXPECT_EQ(takesPart(session, "camera"), node == "camera") << source;
    const bool remapped = session.node("vision")->remaps.count("/microscope/image_raw") == 1;
    EXPECT_EQ(remapped, source == "topic");
    EXPECT_EQ(session.node("display")->remaps.count("/microscope/image_raw") == 1, source == "topic");
  }
  EXPECT_EQ(at(plan({"camera.source:=folder", "camera.path:=/data"}), "camera", "rate"), "10");
  EXPECT_EQ(at(plan({"camera.source:=video", "camera.path:=/data"}), "camera", "rate"), "0");
  EXPECT_FALSE(takesPart(plan(), "vision"));
  EXPECT_TRUE(takesPart(plan({"camera.source:=sim", "record.folder:=/out"}), "image_recorder"));
}

TEST_F(SessionPlanTest, RvizHasTheSceneOrAConsole) {
  const SessionPlan scene = plan({"display.rviz:=true"}), console = plan({"display.console:=inject"});
  EXPECT_EQ(scene.processes.back().arguments, (Names{"-d", kPackage + "/config/session.rviz"}));
  EXPECT_EQ(scene.processes.back().package, "cell_microinjection")
      << "rviz of ROS can die where a screen is drawn in software";
  EXPECT_EQ(scene.processes.back().prefix, "chrt --idle 0");
  EXPECT_NE(console.processes.back().view.find("microinjection/ConsolePanel"), std::string::npos);
  EXPECT_EQ(console.processes.back().prefix, "nice -n 5");
  EXPECT_EQ(console.processes.back().environment.at("LC_ALL"), "C");
  EXPECT_FALSE(takesPart(plan({"display.markers:=false"}), "display"));
}

TEST_F(SessionPlanTest, ARecordHasWhatTakesPart) {
  const SessionPlan session =
      plan({"record.folder:=/out", "hand.device:=none", "injector:=none", "record.trainee:=ann"});
  EXPECT_TRUE(session.node("session_recorder")->required);
  EXPECT_EQ(at(session, "session_recorder", "hand"), "false");
  EXPECT_EQ(at(session, "session_recorder", "injector"), "false");
  EXPECT_EQ(at(session, "session_recorder", "training/trainee"), "ann");
  EXPECT_NE(at(session, "session_recorder", "training/history").find("cell_microinjection/training.csv"),
            std::string::npos);
  EXPECT_EQ(at(session, "notebook", "cell"), "mouse_oocyte_injection");
  EXPECT_EQ(at(session, "notebook", "file"), "/out/notebook.csv");
  EXPECT_FALSE(takesPart(plan({"record.folder:=/out", "notebook:=''"}), "notebook"));
  EXPECT_EQ(at(plan({"record.folder:=/out"}), "session_recorder", "training/trainee"), "-");
}

TEST_F(SessionPlanTest, OverridesHaveTheLastWordForEachNode) {
  const SessionPlan session = plan({"overrides.injector.source:=serial", "overrides.true_cell.rate:=500",
                                    "overrides.vision.image_timeout:=5.0", "hidden:=mouse_oocyte"});
  EXPECT_EQ(at(session, "injector", "source"), "serial");
  EXPECT_EQ(at(session, "true_cell", "rate"), "500");
  EXPECT_EQ(at(session, "cell_simulator", "rate"), "1000");
  EXPECT_FALSE(takesPart(session, "vision")) << "it has overrides, and does not take part";
}

TEST_F(SessionPlanTest, TheSessionsRateIsTheLargestOfAnyLoop) {
  const Names arguments = {"rate:=250", "link.scheme:=wave", "holder:=sim", "overrides.cell_simulator.rate:=500"};
  const SessionPlan limited = plan(arguments);
  for (const char* loop : {"virtual_hand", "haptic_bridge", "teleoperation_follower", "injection_controller",
                           "micromanipulator", "force_sensor"})
    EXPECT_EQ(at(limited, loop, "rate"), "250.0") << loop;
  EXPECT_EQ(at(limited, "holder", "rate"), "200") << "slower by itself";
  EXPECT_EQ(at(limited, "cell_simulator", "rate"), "500") << "an override has the last word";
  EXPECT_EQ(at(plan(), "micromanipulator", "rate"), "1000");
  EXPECT_EQ(at(plan({"rate:=5000", "link.scheme:=wave"}), "teleoperation_follower", "rate"), "-") << "it is slower";
  EXPECT_EQ(at(plan({"rate:=100", "hand.device:=joy"}), "haptic_device", "rate"), "100.0");
  EXPECT_EQ(at(plan({"rate:=auto"}), "micromanipulator", "rate"), "1000");
}

TEST_F(SessionPlanTest, KeepsOnlyWhatIsWanted) {
  SessionPlan session = plan({"display.rviz:=true"});
  session.keepOnly({"display", "rviz", "force_sensor_frame"});
  EXPECT_EQ(session.names(), (Names{"display", "force_sensor_frame", "rviz"}));
  EXPECT_EQ(session.parameters.size(), 0u);
  SessionPlan rig = plan();
  rig.keepOnly({"micromanipulator"});
  EXPECT_EQ(rig.parameters.size(), 1u);
  EXPECT_NE(
      refusalOf([&] {
        session.keepOnly({"haptic_bride", "display"});
      }).find("only = haptic_bride: this session has no such node; must be one of: display, force_sensor_frame, rviz"),
      std::string::npos);
}

TEST_F(SessionPlanTest, NamesTheFileThatCannotBeRead) {
  const std::string hand = file("hand.yaml", "haptic_device: {kind: crtk}\nhaptic_device: {}\n");
  EXPECT_NE(refusalOf([&] {
              plan({"hand.device:=dvrk", "hand.config:=" + hand});
            }).find("hand.yaml, line 2: haptic_device: is there twice"),
            std::string::npos);
}

}  // namespace
}  // namespace microinjection
