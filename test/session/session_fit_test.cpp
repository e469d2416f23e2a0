#include "session/session_fit.h"

#include <tinyxml2.h>

#include <cmath>
#include <sstream>

#include "base/config_reader.h"
#include "session/parameter_tree.h"
#include "session_folder.h"

namespace microinjection {
namespace {

constexpr double kModulus = 17.9e3;  // Pa, of the cell of the paper

/// The cell of the paper, with the diameter in its own key.
std::string oocyte(const std::string& puncture = "{force: 7.5e-6}", double diameter = 56e-6) {
  std::ostringstream text;
  text << "cell: {diameter: " << diameter << ", material: {young_modulus: 17.9e3}, puncture: " << puncture
       << "}\nholding_pipette: {contact_radius: 10e-6}\nneedle: {tip: {shape: hemisphere, radius: 3e-6}}\n";
  return text.str();
}

/// A cell of another size, in proportion.
std::string large(double factor, double modulus = kModulus) {
  std::ostringstream text;
  text << "cell: {diameter: " << factor * 56e-6 << ", material: {young_modulus: " << modulus
       << "}}\nholding_pipette: {contact_radius: " << factor * 10e-6
       << "}\nneedle: {tip: {shape: hemisphere, radius: " << factor * 3e-6 << "}}\n";
  return text.str();
}

double number(const YAML::Node& map, const std::string& path) {
  const YAML::Node value = parameterAt(map, path);
  EXPECT_TRUE(value.IsDefined()) << path;
  return value.IsDefined() ? value.as<double>() : std::nan("");
}

double numberOr(const YAML::Node& map, const std::string& path, double otherwise) {
  const YAML::Node value = parameterAt(map, path);
  return value.IsDefined() ? value.as<double>() : otherwise;
}

bool has(const YAML::Node& map, const std::string& path) { return parameterAt(map, path).IsDefined(); }

class SessionFitTest : public SessionFolder {
 protected:
  SessionFit fit(const std::string& scene, const std::string& overrides = "", std::vector<std::string> arguments = {},
                 const YAML::Node& device = YAML::Node(YAML::NodeType::Map)) {
    arguments.push_back("cell:=" + file("scene.yaml", scene));
    if (!overrides.empty()) arguments.push_back("overrides:=" + file("overrides.yaml", overrides));
    return SessionFit::of(session(arguments), device);
  }
  std::string refused(const std::string& scene, const std::string& overrides = "",
                      const std::vector<std::string>& arguments = {}) {
    return refusalOf([&] { fit(scene, overrides, arguments); });
  }
};

/// Elements of a URDF.
class Urdf {
 public:
  explicit Urdf(const std::string& text) { EXPECT_EQ(document_.Parse(text.c_str()), tinyxml2::XML_SUCCESS); }

  const tinyxml2::XMLElement* find(const char* kind, const char* name, std::initializer_list<const char*> below) const {
    const tinyxml2::XMLElement* element = document_.RootElement()->FirstChildElement(kind);
    while (element && !element->Attribute("name", name)) element = element->NextSiblingElement(kind);
    for (const char* each : below) element = element ? element->FirstChildElement(each) : nullptr;
    return element;
  }
  double height(const char* joint) const {
    const tinyxml2::XMLElement* origin = find("joint", joint, {"origin"});
    double x = 0, y = 0, z = 0;
    std::istringstream(origin ? origin->Attribute("xyz") : "") >> x >> y >> z;
    return z;
  }

 private:
  tinyxml2::XMLDocument document_;
};

TEST_F(SessionFitTest, TheFilesAreForTheOocyteOfThePaper) {
  const SessionFit found = fit(oocyte());
  EXPECT_EQ(found.parameters.size(), 0u) << found.parameters;
  EXPECT_NE(found.text.find("56 um: the needle starts at 60 um, stops at 15 uN"), std::string::npos) << found.text;
  std::ifstream in(kPackage + "/urdf/rig.urdf");
  std::ostringstream urdf;
  urdf << in.rdbuf();
  EXPECT_EQ(found.robot_description, urdf.str());
}

TEST_F(SessionFitTest, TheVirtualMicroscopeShowsACellOfAnySizeAlike) {
  const std::string wide = oocyte("{force: 7.5e-6}", 112e-6);
  const YAML::Node parameters = fit(wide, "", {"camera.source:=sim"}).parameters;
  EXPECT_NEAR(number(parameters, "microscope/camera/pixel_size"), 0.5e-6, 1e-12);
  EXPECT_EQ(number(parameters, "vision/pixel_size"), number(parameters, "microscope/camera/pixel_size"));
  for (const char* key : {"calibration/file", "vision/calibration", "visual_servo/calibration"})
    EXPECT_NE(parameterAt(parameters, key).as<std::string>().find("/cell_microinjection/calibration_simulated.yaml"),
              std::string::npos);
  // The pixel size of a camera is known to a calibration only.
  EXPECT_FALSE(has(fit(wide, "", {"camera.source:=device"}).parameters, "vision"));
}

TEST_F(SessionFitTest, ThePipettesOfTheVirtualMicroscopeComeFromWhereItIsTurnedTo) {
  const std::vector<std::string> sim = {"camera.source:=sim", "overrides:={microscope: {camera: {angle: 2.0}}}"};
  const YAML::Node turned = fit(oocyte(), "", sim).parameters, plain = fit(oocyte(), "", {sim[0]}).parameters;
  EXPECT_NEAR(number(plain, "vision/injection_pipette/direction"), -M_PI / 2, 1e-3);
  EXPECT_NEAR(number(plain, "vision/holding_pipette/direction"), M_PI / 2, 1e-3);
  EXPECT_NEAR(number(turned, "vision/injection_pipette/direction"), 1.5 * M_PI - 2, 1e-3);
  EXPECT_NEAR(number(turned, "vision/holding_pipette/direction"), M_PI / 2 - 2, 1e-3);
}

TEST_F(SessionFitTest, TheScaleOfVisionIsThatOfTheMicroscopeAsItIsOverridden) {
  const YAML::Node parameters =
      fit(oocyte(), "", {"camera.source:=sim", "overrides:={microscope: {camera: {pixel_size: 0.1e-6}}}"}).parameters;
  EXPECT_EQ(number(parameters, "vision/pixel_size"), 0.1e-6);
}

TEST_F(SessionFitTest, KeysAreThoseOfTheFiles) {
  // With a factor of 2 each key that follows the cell differs.
  const YAML::Node parameters =
      fit(large(2, 2 * kModulus), "", {"hand.device:=marker"}, loadYamlMap(kPackage + "/config/haptic/marker.yaml"))
          .parameters;
  const std::map<std::string, std::vector<std::string>> keys = {
      {"micromanipulator", {"servo_speed_limit"}},
      {"haptic_bridge",
       {"position_scale", "rate_mode/gain", "rate_mode/speed_limit", "fixtures/wall/point", "fixtures/workspace/low",
        "fixtures/workspace/high", "force_gain"}},
      {"injection_controller",
       {"speed_limit", "jump_limit", "lag_limit", "tracking_limit", "needle_speed_limit", "depth_limit",
        "motion/approach_speed", "motion/travel_limit", "motion/indent_speed", "motion/stab_speed",
        "motion/stab_acceleration", "motion/overshoot", "motion/retract_speed", "goal/depth", "goal/margin",
        "force_limit", "lateral_force_limit", "detection/contact_force"}},
      {"display", {"colour_range", "force_scale", "injection_pipette/length", "holding_pipette/length", "enlargement"}},
      {"microscope", {"camera/pixel_size", "focus/range", "focus/speed"}},
      {"haptic_device", {"handle_offset", "arrow_scale", "hand_scale", "enlargement"}}};
  for (const std::string key : {"depth", "force", "gap"})
    EXPECT_TRUE(has(parameters, "injection_controller/witness/" + key)) << key;
  for (const auto& [node, paths] : keys) {
    const bool of_hand = node == "haptic_device";
    YAML::Node file = loadYamlMap(kPackage + "/config/" + (of_hand ? "haptic/marker" : node) + ".yaml");
    if (of_hand) file.reset(file[node]);
    for (const std::string& path : paths) {
      EXPECT_TRUE(has(file, path)) << node << "/" << path;
      EXPECT_TRUE(has(parameters, node + "/" + path)) << node << "/" << path;
    }
  }
}

TEST_F(SessionFitTest, TheHandFeelsACellInProportionAlike) {
  const std::pair<double, double> cells[] = {{2, kModulus}, {0.5, kModulus}, {1, 5e3}, {2.5, 1e3}};
  for (const auto& [factor, modulus] : cells) {
    const YAML::Node parameters = fit(large(factor, modulus)).parameters;
    const double stiffness = factor * modulus / kModulus;  // of the cell, against the oocyte's
    const double scale = numberOr(parameters, "haptic_bridge/position_scale", 1e-3) *
                         numberOr(parameters, "haptic_bridge/force_gain", 2e5);
    EXPECT_NEAR(stiffness * scale, 1e-3 * 2e5, 1e-2);
  }
}

TEST_F(SessionFitTest, ASoftInsideIsFelt) {
  const auto gain = [&](const std::vector<double>& moduli) {
    const double radii[] = {28e-6, 24e-6, 10e-6};
    std::ostringstream scene;
    scene << "cell: {layers: [";
    for (std::size_t i = 0; i < moduli.size(); ++i)
      scene << (i ? ", " : "") << "{outer_radius: " << radii[i] << ", material: {young_modulus: " << moduli[i] << "}}";
    scene << "]}\nholding_pipette: {contact_radius: 10e-6}\nneedle: {tip: {radius: 3e-6}}\n";
    return numberOr(fit(scene.str()).parameters, "haptic_bridge/force_gain", 2e5);
  };
  EXPECT_EQ(gain({kModulus}), 2e5);
  EXPECT_EQ(gain({kModulus, kModulus, kModulus}), 2e5);
  EXPECT_NEAR(2e5 / gain({kModulus, 1e3}), (1 + 16.9 * std::pow(1 - std::pow(24.0 / 28, 3), 2)) / 17.9, 1e-5);
  EXPECT_GT(gain({kModulus, 1e3}), gain({kModulus, 1e3, 5e3}));
}

TEST_F(SessionFitTest, ATensegrityIsFeltAsTheFilesAre) {
  const std::string scene = "cell: {model: tensegrity, diameter: 56e-6}\nneedle: {tip: {radius: 3e-6}}\n";
  EXPECT_FALSE(has(fit(scene).parameters, "haptic_bridge"));
}

TEST_F(SessionFitTest, TimesStay) {
  const YAML::Node controller = fit(large(3)).parameters["injection_controller"];
  EXPECT_NEAR(number(controller, "motion/travel_limit") / number(controller, "motion/approach_speed"), 3, 1e-4);
}

TEST_F(SessionFitTest, TheRigFollows) {
  const Urdf urdf(fit(large(3)).robot_description);
  EXPECT_NEAR(urdf.height("world_to_manipulator_base"), 180e-6, 1e-12);
  EXPECT_NEAR(urdf.height("world_to_holding_pipette"), -84e-6, 1e-12);
  EXPECT_NEAR(urdf.height("world_to_dish"), -120e-6, 1e-12);  // the floor is 60 um below it
  EXPECT_NEAR(urdf.height("world_to_objective"), -120e-6, 1e-12);
  EXPECT_NEAR(urdf.find("joint", "manipulator_z", {"limit"})->DoubleAttribute("lower"), -600e-6, 1e-12);
  EXPECT_NEAR(urdf.find("link", "holding_pipette", {"collision", "geometry", "cylinder"})->DoubleAttribute("radius"),
              90e-6, 1e-12);
  EXPECT_NEAR(urdf.find("link", "holding_pipette", {"visual", "geometry", "cylinder"})->DoubleAttribute("length"),
              600e-6, 1e-12);
  EXPECT_STREQ(urdf.find("link", "holding_pipette", {"visual", "origin"})->Attribute("xyz"), "0 0 0.0003");
  EXPECT_NEAR(urdf.find("link", "cell", {"visual", "geometry", "sphere"})->DoubleAttribute("radius"), 84e-6, 1e-12);
}

TEST_F(SessionFitTest, TheGuardFollowsThePunctureForce) {
  const YAML::Node parameters =
      fit(oocyte("{layers: [{name: a, force: 1e-6}, {name: b, force: 2e-6, stiffness: 1}]}")).parameters;
  EXPECT_EQ(parameterText(parameters), "injection_controller:\n  force_limit: 4.0e-06\n");
}

TEST_F(SessionFitTest, SpeedsStayWithinThoseOfTheAxes) {
  const YAML::Node parameters = fit(large(20)).parameters;
  EXPECT_EQ(number(parameters, "micromanipulator/servo_speed_limit"), 2e-3);
  EXPECT_EQ(number(parameters, "injection_controller/motion/stab_speed"), 2e-3);
}

TEST_F(SessionFitTest, ASmallCellIsNotTouchedByNoise) {
  EXPECT_FALSE(has(fit(large(0.5)).parameters, "injection_controller/detection"));
}

TEST_F(SessionFitTest, ADevicesOwnNumbersAreScaled) {
  const YAML::Node joy = loadYamlMap(kPackage + "/config/haptic/joy.yaml");
  const YAML::Node parameters = fit(large(2), "", {}, joy).parameters;
  EXPECT_EQ(number(parameters, "haptic_bridge/rate_mode/gain"), 2e-3);
  EXPECT_EQ(number(parameters, "haptic_bridge/rate_mode/speed_limit"), 40e-6);
}

TEST_F(SessionFitTest, TheUserHasTheLastWord) {
  const SessionFit found = fit(large(2),
                               "injection_controller: {force_limit: 2e-6, motion: {approach_speed: 9e-6}}\n"
                               "cell_simulator: {rate: 500}\nrig: {floor_height: -500e-6}");
  EXPECT_EQ(number(found.parameters, "injection_controller/force_limit"), 2e-6);
  EXPECT_EQ(number(found.parameters, "injection_controller/motion/approach_speed"), 9e-6);
  EXPECT_NEAR(number(found.parameters, "injection_controller/motion/travel_limit"), 120e-6, 1e-12);
  EXPECT_EQ(parameterText(found.parameters["cell_simulator"]), "rate: 500\n");
  EXPECT_NE(found.robot_description.find("-0.00044"), std::string::npos);
}

/// The example of doc/guide/your_rig.md.
TEST_F(SessionFitTest, ARigOfOnesOwnFollowsTheCellUnlessItsSizesAreOverridden) {
  std::ifstream in(kPackage + "/urdf/rig.urdf");
  const std::string urdf((std::istreambuf_iterator<char>(in)), {});
  const std::vector<std::string> own = {"rig.name:=zaber", "rig.urdf:=" + file("my_rig.urdf", urdf)};
  const SessionFit fitted = fit(large(76.0 / 56), "", own);
  const Urdf scaled(fitted.robot_description);
  EXPECT_NEAR(scaled.height("world_to_dish"), -21.4e-6, 0.1e-6);
  EXPECT_NEAR(scaled.height("world_to_manipulator_base"), 81.4e-6, 0.1e-6);
  const std::string heights = "; mouth at -38 um, dish at -81.43 um";
  EXPECT_NE(fitted.text.find(heights), std::string::npos) << fitted.text;

  const SessionFit kept = fit(large(76.0 / 56),
                              "rig: {start_height: 60.0e-6, mouth_height: -38.0e-6, floor_height: -60.0e-6,\n"
                              "      travel: 200.0e-6, pipette_radius: 30.0e-6, pipette_length: 200.0e-6}",
                              own);
  const Urdf mine(kept.robot_description);
  EXPECT_NEAR(mine.height("world_to_dish"), 0, 1e-12);
  EXPECT_NEAR(mine.height("world_to_objective"), 0, 1e-12);
  EXPECT_NEAR(mine.height("world_to_manipulator_base"), 60e-6, 1e-12);
  EXPECT_NEAR(mine.height("world_to_holding_pipette"), -38e-6, 1e-12);
  EXPECT_NEAR(mine.find("joint", "manipulator_z", {"limit"})->DoubleAttribute("lower"), -200e-6, 1e-12);
  const auto* holder = mine.find("link", "holding_pipette", {"collision", "geometry", "cylinder"});
  EXPECT_NEAR(holder->DoubleAttribute("radius"), 30e-6, 1e-12);
  EXPECT_NEAR(holder->DoubleAttribute("length"), 200e-6, 1e-12);
}

TEST_F(SessionFitTest, NamesWhatDoesNotFit) {
  const std::pair<std::string, std::string> cases[] = {
      {"rig: {start_height: 20e-6}", "rig/start_height = 2e-05 m: the needle starts in the cell"},
      {"rig: {travel: 30e-6}", "rig/travel = 3e-05 m: the needle does not reach"},
      {"rig: {mouth_height: 0}", "rig/mouth_height = 0 m: the holding pipette does not hold the cell"},
      {"rig: {floor_height: -10e-6}", "rig/floor_height = -1e-05 m: the cell lies in the dish"},
      {"rig: {start_height: high}", "overrides.yaml, line 1: rig/start_height = high: must be a number"},
      {"rig: {roof: 1}", "rig/roof: unknown key; known here: floor_height, "},
      {"injection_controller: {force_limit: 7e-6}", "must be above the puncture force 7.5e-06 N"},
      {"injection_controller: {force_limit: much}", "force_limit = much: must be a number"},
      {"injection_controller: {speed_limit: 5e-3}", "speed_limit = 0.005 m/s: must be at most the axes' 0.002"},
      {"injection_controller: {goal: {depth: 60e-6}}", "goal/depth = 6e-05 m: must be at most depth_limit"},
      {"injection_controller:\n  motion:\n    travel_limit: 10e-6",
       "overrides.yaml, line 3: injection_controller/motion/travel_limit = 1e-05 m: the needle starts 32 um above the "
       "cell"},
      {"controller: {a: 1}", "unknown key; known here: calibration, "},
      {"display: 3", "display = 3: must be keys with values"},
      {"{", "overrides.yaml: "},
      {"- 1", "must be a YAML map"}};
  for (const auto& [overrides, reason] : cases) {
    const std::string found = refused(oocyte(), overrides);
    EXPECT_NE(found.find(reason), std::string::npos) << overrides << "\n" << found << "\nhas not\n" << reason;
  }
}

TEST_F(SessionFitTest, NamesAllThatDoesNotFitAtOnce) {
  const std::string found =
      refused(oocyte(), "rig: {roof: 1, mouth_height: 0}\ninjection_controller: {force_limit: 7e-6}");
  for (const char* part : {"rig/roof", "rig/mouth_height", "force_limit"})
    EXPECT_NE(found.find(part), std::string::npos) << found;
}

TEST_F(SessionFitTest, AForceBeyondTheSensorsRangeIsRefusedWhereItIsUsed) {
  const std::string stiff = large(12);
  EXPECT_NE(refused(stiff, "", {"force.hand:=measured"}).find("must be at most the range of the force sensor"),
            std::string::npos);
  EXPECT_NE(refused(stiff, "", {"force.controller:=measured"}).find("must be at most the range of the force sensor"),
            std::string::npos);
  EXPECT_EQ(refused(stiff), "");
  EXPECT_EQ(refused(stiff, "", {"force.controller:=measured", "sensor.source:=topic"}), "");
  EXPECT_EQ(refused(stiff, "force_sensor: {simulated: {axial_range: 1.0}}", {"force.controller:=measured"}), "");
}

TEST_F(SessionFitTest, ASceneWithoutACellIsNamed) {
  const std::string no_needle = "cell: {diameter: 56e-6, material: {young_modulus: 17.9e3}}\nneedle: {}\n";
  for (const std::string& scene :
       {std::string("{}"), std::string("cell: {}"), std::string("cell: {diameter: big}"),
        std::string("cell: {diameter: 0, material: {young_modulus: 1}}\nneedle: {tip: {radius: 1e-6}}"),
        std::string("a"), std::string("cell: ["), no_needle,
        std::string("cell: {layers: [3]}\nneedle: {tip: {radius: 1e-6}}"),
        std::string("cell: {diameter: .nan, material: {young_modulus: 1}}\nneedle: {tip: {radius: 1e-6}}")})
    EXPECT_NE(refused(scene).find("scene.yaml: "), std::string::npos) << scene << "\n" << refused(scene);
}

TEST_F(SessionFitTest, ACellInAnotherUnitIsNamed) {
  EXPECT_NE(refused(oocyte("{force: 7.5e-6}", 56))
                .find("scene.yaml: cell/diameter = 56.0: must be 1e-6 .. 5e-3 m; 56 um would be 5.6e-5"),
            std::string::npos)
      << refused(oocyte("{force: 7.5e-6}", 56));
  EXPECT_NE(refused(large(1, 0.5)).find("cell/material/young_modulus = 0.5: must be 1 .. 1e9 Pa; 0.5 kPa would be 500"),
            std::string::npos);
}

TEST_F(SessionFitTest, AUrdfThatCannotFollowIsNamed) {
  const auto refusal = [&](const std::string& urdf) {
    return refused(oocyte(), "", {"rig.urdf:=" + file("rig.urdf", urdf)});
  };
  EXPECT_NE(refusal("<robot>").find("rig.urdf: is no URDF"), std::string::npos) << refusal("<robot>");
  EXPECT_NE(refusal("<robot/>").find("rig.urdf: has no joint world_to_manipulator_base"), std::string::npos);
  EXPECT_NE(refusal("").find("rig.urdf: is no URDF"), std::string::npos);
}

TEST_F(SessionFitTest, EachCellOfThePackageFits) {
  for (const auto& entry : std::filesystem::directory_iterator(kPackage + "/config/cells")) {
    const std::string cell = entry.path().stem().string();
    EXPECT_EQ(refusalOf([&] { SessionFit::of(session({"cell:=" + cell}), YAML::Node(YAML::NodeType::Map)); }), "")
        << cell;
  }
}

}  // namespace
}  // namespace microinjection
