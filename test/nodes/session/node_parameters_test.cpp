#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "base/errors.h"
#include "nodes/bus/local_bus.h"
#include "nodes/executive/node_registry.h"
#include "nodes/session/recorded_session.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

const std::string kFolder = MICROINJECTION_SOURCE_DIR;
const std::string kScene = testFile("scenes/coarse_oocyte.yaml");
const std::string kRounded = kFolder + "/config/cells/mouse_oocyte_pipette.yaml";
const std::string kFamilies = kFolder + "/config/families";
const std::string kMotion = kFolder + "/config/hand_motions/indent_and_retract.yaml";

/// YAML of what each node cannot do without; FOLDER: an empty one.
const std::map<std::string, std::string> kGood = {
    {"calibration", "{}"},
    {"camera", "{source: folder, path: FOLDER}"},
    {"cell_estimator", "{scene: " + kRounded + ", families: " + kFamilies + "}"},
    {"cell_simulator", "{scene: " + kScene + "}"},
    {"display", "{}"},
    {"focus", "{}"},
    {"force_sensor", "{}"},
    {"force_watchdog", "{}"},
    {"haptic_bridge", "{}"},
    {"haptic_device", "{kind: joy}"},
    {"holder", "{}"},
    {"image_recorder", "{output_dir: FOLDER}"},
    {"injection_controller", "{}"},
    {"injector", "{}"},
    {"link_emulator", "{}"},
    {"micromanipulator", "{}"},
    {"microscope", "{}"},
    {"notebook", "{file: FOLDER/notebook.csv}"},
    {"virtual_hand", "{motion: " + kMotion + "}"},
    {"readiness", "{}"},
    {"session_recorder", "{output_dir: FOLDER}"},
    {"teleoperation_follower", "{}"},
    {"touch", "{}"},
    {"vision", "{}"},
    {"visual_servo", "{}"}};

struct Bad {
  std::string node, changes;       ///< YAML, over the good ones
  std::vector<std::string> words;  ///< that the message must have
  friend std::ostream& operator<<(std::ostream& out, const Bad& bad) { return out << bad.node << ' ' << bad.changes; }
};
const std::vector<Bad> kBad = {
    {"calibration", "{pattern: {rows: 1}}", {"pattern/rows = 1", "[2, 100]"}},
    {"calibration", "{file: " + kMotion + "}", {"indent_and_retract.yaml"}},
    {"camera", "{path: /nowhere}", {"/nowhere"}},
    {"camera", "{rate: -1}", {"rate = -1"}},
    {"camera", "{source: television}", {"source = television", "device, folder, video"}},
    {"cell_estimator", "{estimator: {modulus_deviation: 0}}", {"modulus_deviation = 0", "[0.01, 3]"}},
    {"cell_estimator", "{estimator: {history: {capacity: 2}}}", {"history/capacity = 2", "[40, 2000]"}},
    {"cell_estimator", "{scene: " + kScene + "}", {"coarse_oocyte.yaml", "needs a cell of a family"}},
    {"cell_simulator", "{scene: /nowhere.yaml}", {"/nowhere.yaml"}},
    {"cell_simulator", "{model: surrogate}", {"model = surrogate", "needle/tip/shape = disc"}},
    {"cell_simulator", "{model: surrogate, scene: " + kRounded + "}", {"model = surrogate", "prepare --scene"}},
    {"cell_simulator", "{model: guessed}", {"model = guessed", "auto, surrogate, live, explicit"}},
    {"cell_simulator", "{rate: 1e6}", {"rate = 1e6", "[50, 5000]"}},
    {"cell_simulator", "{holding: {friction: {lip: -1}}}", {"holding/friction/lip = -1", "[0, inf)"}},
    {"cell_simulator", "{holding: {radius: 1e-5}}", {"holding/radius"}},
    {"cell_simulator", "{extrapolation_limit: 0.0}", {"extrapolation_limit = 0", "(0, inf)"}},
    {"display", "{rate: -1}", {"rate = -1"}},
    {"focus", "{step: 0}", {"step = 0"}},
    {"force_sensor", "{simulated: {bits: 2}}", {"simulated/bits = 2", "[4, 32]"}},
    {"force_sensor", "{simulated: {axial_range: wide}}", {"axial_range = wide", "number"}},
    {"force_sensor", "{source: guessed}", {"source = guessed", "simulated, serial, topic"}},
    {"force_sensor", "{source: serial}", {"serial/path is missing", "serial/matrix is missing"}},
    {"force_sensor", "{frame: nowhere}", {"frame 'nowhere'", "static_transform_publisher"}},
    {"force_watchdog", "{timeout: 0.0}", {"timeout = 0", "(0, inf)"}},
    {"force_watchdog", "{kind: omni, force: body/servo_cf}", {"force = body/servo_cf", "kind: crtk only"}},
    {"force_watchdog", "{kind: moon}", {"kind = moon", "crtk, omni, geomagic"}},
    {"haptic_bridge", "{position_scale: 0}", {"position_scale = 0", "(0, inf)"}},
    {"haptic_bridge", "{force_source: guessed}", {"force_source = guessed", "predicted, measured"}},
    {"haptic_bridge", "{timeouts: {clutch: -1}}", {"timeouts/clutch = -1", "[0, inf)"}},
    {"haptic_device", "{kind: moon}", {"kind = moon", "crtk, omni, geomagic, joy, keyboard, marker"}},
    {"haptic_device", "{kind: crtk, position_type: twist}", {"position_type = twist", "pose, transform"}},
    {"haptic_device", "{kind: crtk, clutch: {index: -1}}", {"clutch/index = -1", "[0, 63]"}},
    {"haptic_device", "{centre: 1}", {"centre = 1", "(0, 1)"}},
    {"haptic_device", "{kind: omni, clutch_button: red}", {"clutch_button = red", "grey, white, none"}},
    {"haptic_device", "{kind: omni, operator_button: grey}", {"operator_button", "another than clutch_button"}},
    {"image_recorder", "{output_dir: /proc/nowhere}", {"/proc/nowhere"}},
    {"image_recorder", "{rate: 0}", {"rate = 0", "[1, 1000]"}},
    {"injection_controller", "{force_limit: -1e-6}", {"force_limit = -1", "(0, inf)"}},
    {"injection_controller", "{mode: moon, rate: 1}", {"mode = moon", "manual, semi_automatic, automatic", "rate = 1"}},
    {"injector", "{pipette: {tip_radius: -1e-6}}", {"tip_radius = -1e-6", "(0, inf)"}},
    {"injector", "{source: serial}", {"serial/path is missing", "serial/pulse is missing"}},
    {"link_emulator", "{loss: 2}", {"loss = 2"}},
    {"micromanipulator", "{collision_margin: -1}", {"collision_margin = -1", "[0, inf)"}},
    {"micromanipulator", "{pipette_tilt: 2}", {"pipette_tilt = 2 rad", "[0, 1.2] rad"}},
    {"micromanipulator", "{device: {backlash: -1}}", {"device/backlash = -1", "[0, inf)"}},
    {"micromanipulator", "{rig: moon}", {"rig = moon", "eppendorf, mp285, scientifica, sensapex, transferman, zaber"}},
    {"micromanipulator", "{rig: mp285, device: {microsteps: [1, 0, 0]}}", {"device/microsteps"}},
    {"micromanipulator", "{rig: eppendorf, device: {speed: 1}}", {"device/speed = 1"}},
    {"micromanipulator", "{rig: scientifica, device: {version: 4}}", {"device/version = 4", "[2, 3]"}},
    {"micromanipulator", "{rig: zaber, device: {gain: -1}}", {"device/gain = -1"}},
    {"microscope", "{focus: {start: 1}}", {"focus/start = 1", "within range"}},
    {"microscope", "{specimen: {dust: -1}}", {"specimen/dust = -1", "[0, 200]"}},
    {"microscope", "{camera: {pixel_size: 0}}", {"camera/pixel_size = 0"}},
    {"notebook", "{file: /proc/nowhere/notebook.csv}", {"/proc/nowhere"}},
    {"virtual_hand", "{motion: /nowhere.csv}", {"/nowhere.csv"}},
    {"virtual_hand", "{mass: -0.1}", {"mass = -0.1", "(0, inf)"}},
    {"session_recorder", "{row_period: 0}", {"row_period = 0", "(0, inf)"}},
    {"touch", "{largest_force: 0}", {"largest_force = 0"}},
    {"vision", "{pixel_size: -1}", {"pixel_size = -1", "[0, 0.0001]"}},
    {"vision", "{cell: {contrast_mode: x_ray}}", {"cell/contrast_mode = x_ray", "bright_field, phase, dic, unknown"}},
    {"visual_servo", "{image_target: {gain: 0}}", {"image_target/gain = 0", "(0, 1]"}},
    // What measures or injects on while virtual time stands.
    {"force_sensor",
     "{source: serial, serial: {path: /dev/tty7, matrix: [1e-4, 0, 0, 2e-4], offset: [2.5, 2.5]}}",
     {"source = serial", "/dev/tty7", "virtual time"}},
    {"injector",
     "{source: serial, serial: {path: /dev/tty7, pulse_pressure: 20e3, pulse_duration: 0.5, refuse: NO, "
     "pulse: [{send: GO, expect: OK}]}}",
     {"source = serial", "/dev/tty7", "virtual time"}},
};

/// A node alone, with the frame that the force sensor needs.
class NodeParameters {
 public:
  NodeParameters() {
    network_.setParameter("/robot_description", YAML::Node(readFile(kFolder + "/urdf/rig.urdf")));
    std::filesystem::create_directories(folder());
    frames_bus_ = network_.connect(
        "/rig_frames",
        YAML::Load("{frames: [{parent: needle_tip, child: force_sensor, pose: [0, 0, 0.04, 0, 0, 0]}]}"));
    frames_ = nodeFactory("rig_frames")(*frames_bus_);
  }

  YAML::Node good(const std::string& node) const {
    std::string text = kGood.at(node);
    const std::size_t place = text.find("FOLDER");
    if (place != std::string::npos) text.replace(place, 6, folder());
    return YAML::Load(text);
  }
  /// What the node refuses these with, or an empty text.
  std::string refusal(const std::string& node, const YAML::Node& parameters) {
    const auto bus = network_.connect("/" + node, parameters);
    try {
      nodeFactory(node)(*bus);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

 private:
  std::string folder() const { return (folders_.path() / "empty").string(); }

  UserFolders folders_;
  LocalNetwork network_{ros::Time(1)};
  std::unique_ptr<LocalBus> frames_bus_;
  std::shared_ptr<void> frames_;
};

/// A node whose parameters are wrong names key, value and range, and never comes alive.
class OfNode : public testing::TestWithParam<std::string> {
 protected:
  NodeParameters nodes_;
};

TEST_P(OfNode, GoodOnesAreTaken) { EXPECT_EQ(nodes_.refusal(GetParam(), nodes_.good(GetParam())), ""); }

TEST_P(OfNode, AKeyThatItDoesNotKnowIsRefused) {
  YAML::Node parameters = nodes_.good(GetParam());
  parameters["forse_limit"] = 3;
  const std::string refusal = nodes_.refusal(GetParam(), parameters);
  EXPECT_NE(refusal.find("forse_limit"), std::string::npos) << refusal;
  EXPECT_NE(refusal.find("unknown key"), std::string::npos) << refusal;
}

TEST_P(OfNode, AKeyThatItNeedsAndThatIsMissingIsNamed) {
  for (const auto& key : nodes_.good(GetParam())) {
    YAML::Node parameters = nodes_.good(GetParam());
    parameters.remove(key.first.as<std::string>());
    const std::string refusal = nodes_.refusal(GetParam(), parameters);
    EXPECT_NE(refusal.find(key.first.as<std::string>() + " is missing"), std::string::npos) << refusal;
  }
}

std::vector<std::string> nodeNames() {
  std::vector<std::string> names;
  for (const auto& [name, parameters] : kGood) names.push_back(name);
  return names;
}
INSTANTIATE_TEST_SUITE_P(NodeParameters, OfNode, testing::ValuesIn(nodeNames()),
                         [](const auto& node) { return node.param; });

class OutOfRange : public testing::TestWithParam<Bad> {};

TEST_P(OutOfRange, IsRefusedByName) {
  const auto& [node, changes, words] = GetParam();
  NodeParameters nodes;
  YAML::Node parameters = nodes.good(node);
  for (const auto& entry : YAML::Load(changes)) parameters[entry.first.as<std::string>()] = entry.second;
  const std::string refusal = nodes.refusal(node, parameters);
  for (const std::string& word : words)
    EXPECT_NE(refusal.find(word), std::string::npos) << refusal << " has no " << word;
}

INSTANTIATE_TEST_SUITE_P(NodeParameters, OutOfRange, testing::ValuesIn(kBad),
                         [](const auto& bad) { return bad.param.node + "_" + std::to_string(bad.index); });

}  // namespace
}  // namespace microinjection
