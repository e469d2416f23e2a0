#include "session/session_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

#include "base/config_reader.h"
#include "base/errors.h"
#include "base/paths.h"
#include "session/cell_facts.h"
#include "session/parameter_tree.h"
#include "session/rig_description.h"

namespace microinjection {
namespace {

constexpr double kGuard = 2;  // force limit over the largest puncture force
constexpr char kController[] = "injection_controller", kMicroscope[] = "microscope";

using Keys = std::map<std::string, std::vector<std::string>>;

const char* const kFitted[] = {"micromanipulator", "haptic_bridge", kController, "display", kMicroscope};

// How parameters follow the cell: with its radius, with one over it, with E R^2, with one over that.
const Keys kLengths = {
    {"micromanipulator", {"servo_speed_limit"}},
    {"haptic_bridge",
     {"position_scale", "rate_mode/gain", "rate_mode/speed_limit", "fixtures/wall/point", "fixtures/workspace/low",
      "fixtures/workspace/high"}},
    {kController,
     {"speed_limit", "jump_limit", "lag_limit", "tracking_limit", "needle_speed_limit", "depth_limit",
      "motion/approach_speed", "motion/travel_limit", "motion/indent_speed", "motion/stab_speed",
      "motion/stab_acceleration", "motion/overshoot", "motion/retract_speed", "witness/depth", "witness/gap",
      "goal/depth", "goal/margin", "goal/suction/dent", "goal/suction/length"}},
    {"display", {"colour_range", "force_scale", "injection_pipette/length", "holding_pipette/length"}},
    {kMicroscope, {"camera/pixel_size", "focus/range", "focus/speed"}},
    {"haptic_device", {"handle_offset", "arrow_scale"}}};
const Keys kPerLength = {{"haptic_device", {"hand_scale", "enlargement"}}, {"display", {"enlargement"}}};
const Keys kForces = {{kController, {"force_limit", "lateral_force_limit"}}};
const Keys kPerForce = {{"haptic_bridge", {"force_gain"}}, {"display", {"force_scale"}}};

struct SpeedKey {
  const char *node, *path;
};
const SpeedKey kSpeeds[] = {{"micromanipulator", "servo_speed_limit"},
                            {kController, "speed_limit"},
                            {kController, "motion/stab_speed"},
                            {"haptic_bridge", "rate_mode/speed_limit"}};

class Fit {
 public:
  Fit(const Session& session, const YAML::Node& device)
      : session_(session),
        cell_(CellFacts::ofScene(session.cell)),
        rig_(session.rig.urdf),
        base_(emptyMap()),
        changed_(emptyMap()) {
    for (const char* node : kFitted) base_[node] = loadYamlMap(session.package + "/config/" + node + ".yaml");
    for (const char* node : {"haptic_bridge", "haptic_device"}) {
      if (!base_[node].IsDefined()) base_[node] = emptyMap();
      const YAML::Node of_device = parameterAt(device, node);
      if (of_device.IsDefined()) mergeParameters(base_[node], of_device);
    }
  }

  SessionFit run() {
    if (session_.holder_rig.present()) rig_.carryHolder(session_.holder_rig.urdf);
    rig_.scale(cell_.lengthScale(), cell_.mouth_radius);
    scaleAll();
    if (cell_.puncture_force > 0) set(kController, "force_limit", roundedParameter(kGuard * cell_.puncture_force));
    followScene();
    for (const SpeedKey& speed : kSpeeds)
      if (has(speed.node, speed.path))
        set(speed.node, speed.path, std::min(read(speed.node, speed.path), rig_.axisSpeed()));
    if (session_.camera.source == "sim") followMicroscope();
    override();
    findMisfits();
    if (!errors_.empty()) throw ConfigError(errors_);
    return {changed_, rig_.text(), text()};
  }

 private:
  YAML::Node get(const std::string& node, const std::string& path) const {
    const YAML::Node changed = parameterAt(changed_, node + "/" + path);
    return changed.IsDefined() ? changed : parameterAt(base_, node + "/" + path);
  }
  bool has(const std::string& node, const std::string& path) const { return get(node, path).IsDefined(); }
  /// NaN where it is no number.
  double read(const std::string& node, const std::string& path) const {
    double value = 0;
    const YAML::Node parameter = get(node, path);
    const bool good = parameter.IsDefined() && parameter.IsScalar() && YAML::convert<double>::decode(parameter, value);
    return good ? value : std::numeric_limits<double>::quiet_NaN();
  }
  void set(const std::string& node, const std::string& path, double value) {
    double of_file = 0;
    const YAML::Node base = parameterAt(base_, node + "/" + path);
    const bool is_same =
        base.IsDefined() && base.IsScalar() && YAML::convert<double>::decode(base, of_file) && of_file == value;
    if (!is_same || parameterAt(changed_, node + "/" + path).IsDefined())
      setParameter(changed_, node + "/" + path, numberValue(value));
  }

  void scaleAll() {
    const double length = cell_.lengthScale(), force = cell_.forceScale();
    scaleKeys(kLengths, length);
    scaleKeys(kPerLength, 1 / length);
    scaleKeys(kForces, force);
    scaleKeys(kPerForce, 1 / force);
    // No smaller: a sensor's noise does not shrink with the cell.
    for (const char* threshold : {"detection/contact_force", "witness/force"})
      set(kController, threshold, roundedParameter(read(kController, threshold) * std::max(1.0, force)));
  }

  void scaleKeys(const Keys& keys, double factor) {
    if (factor == 1) return;
    for (const auto& [node, paths] : keys)
      for (const std::string& path : paths)
        if (has(node, path)) scale(node, path, factor);
  }
  void scale(const std::string& node, const std::string& path, double factor) {
    const YAML::Node value = get(node, path);
    try {
      setParameter(changed_, node + "/" + path, scaled(value, factor));
    } catch (const YAML::Exception&) {
      errors_.push_back(session_.hand.config + ": " + node + "/" + path + " = " + YAML::Dump(value) +
                        ": must be a number, or a list of numbers");
    }
  }
  static YAML::Node scaled(const YAML::Node& value, double factor) {
    if (!value.IsSequence()) return numberValue(roundedParameter(factor * value.as<double>()));
    YAML::Node list(YAML::NodeType::Sequence);
    for (std::size_t i = 0; i < value.size(); ++i) list.push_back(scaled(value[i], factor));
    return list;
  }

  void followScene() {
    const std::pair<std::string, std::string> drawn[] = {{"display", ""}, {kMicroscope, "specimen/"}};
    for (const auto& [node, group] : drawn) {
      follow(node, group + "injection_pipette/", "tip_radius", "shaft_radius", cell_.tip_radius);
      follow(node, group + "holding_pipette/", "mouth_radius", "outer_radius", cell_.mouth_radius);
    }
  }
  /// The first radius is the scene's, if it has one, and the second keeps its ratio to the first.
  void follow(const std::string& node, const std::string& pipette, const char* first, const char* second,
              double radius) {
    if (!(radius > 0)) return;
    const double ratio = read(node, pipette + second) / read(node, pipette + first);
    set(node, pipette + first, radius);
    set(node, pipette + second, roundedParameter(radius * ratio));
  }

  /// Of the virtual microscope the pixel size and the pipettes' directions are known, and its calibration is not that
  /// of a real camera.
  void followMicroscope() {
    setParameter(changed_, "vision/pixel_size", ofCamera("pixel_size"));
    double turned = 0;  // counter-clockwise, and directions count clockwise
    if (YAML::convert<double>::decode(ofCamera("angle"), turned) && std::isfinite(turned)) {
      set("vision", "injection_pipette/direction", directionOf(-M_PI / 2 - turned));
      set("vision", "holding_pipette/direction", directionOf(M_PI / 2 - turned));
    }
    const YAML::Node file = textValue(userDataFile("calibration_simulated.yaml"));
    setParameter(changed_, "calibration/file", file);
    setParameter(changed_, "vision/calibration", file);
    setParameter(changed_, "visual_servo/calibration", file);
  }

  /// As it will be, with what the session overrides.
  YAML::Node ofCamera(const std::string& key) const {
    const YAML::Node overridden = parameterAt(session_.overrides, std::string(kMicroscope) + "/camera/" + key);
    return overridden.IsDefined() ? overridden : get(kMicroscope, "camera/" + key);
  }
  static double directionOf(double angle) { return roundedParameter(std::remainder(angle, 2 * M_PI)); }

  void override() {
    for (const auto& item : session_.overrides) {
      const std::string node = item.first.Scalar();
      if (node == "rig") {
        std::vector<std::string> wrong;
        rig_.override(item.second, wrong);
        for (const std::string& line : wrong) add(line);
      } else {
        if (!changed_[node].IsDefined()) changed_[node] = emptyMap();
        mergeParameters(changed_[node], item.second);
      }
    }
  }

  /// `line` begins with a key, whose place is named.
  void add(const std::string& line) {
    const std::string key = line.substr(0, line.find_first_of(" :"));
    errors_.push_back(session_.places.at("overrides/" + key) + ": " + line);
  }
  double number(const std::string& node, const std::string& path) {
    const double value = read(node, path);
    if (std::isfinite(value)) return value;
    const YAML::Node parameter = get(node, path);
    add(node + "/" + path + " = " + (parameter.IsDefined() ? YAML::Dump(parameter) : "nothing") + ": must be a number");
    return std::numeric_limits<double>::quiet_NaN();
  }

  void findMisfits() {
    const std::size_t before = errors_.size();
    const double depth = number(kController, "depth_limit"), force = number(kController, "force_limit");
    const double travel = number(kController, "motion/travel_limit"), goal = number(kController, "goal/depth");
    const double speeds[] = {number(kSpeeds[0].node, kSpeeds[0].path), number(kSpeeds[1].node, kSpeeds[1].path)};
    if (errors_.size() > before) return;
    for (const std::string& line : rig_.misfits(cell_.radius, depth)) add(line);
    const double way = rig_.sizes().start_height - cell_.radius;
    if (way > travel)
      refuse("motion/travel_limit", travel, "m",
             "the needle starts " + shortNumber(1e6 * way, 4) + " um above the cell; must be at least that");
    if (goal > depth) refuse("goal/depth", goal, "m", "must be at most depth_limit = " + shortNumber(depth));
    if (force <= cell_.puncture_force)
      refuse("force_limit", force, "N",
             "must be above the puncture force " + shortNumber(cell_.puncture_force) +
                 " N, or the cell is never punctured");
    if (force > sensorRange())
      refuse(
          "force_limit", force, "N",
          "must be at most the range of the force sensor, " + shortNumber(sensorRange()) + " N, whose force is used");
    for (int i = 0; i < 2; ++i) {
      if (speeds[i] > rig_.axisSpeed())
        add(std::string(kSpeeds[i].node) + "/" + kSpeeds[i].path + " = " + shortNumber(speeds[i]) +
            " m/s: must be at most the axes' " + shortNumber(rig_.axisSpeed()) + " m/s");
    }
  }
  void refuse(const std::string& path, double value, const std::string& unit, const std::string& reason) {
    add(std::string(kController) + "/" + path + " = " + shortNumber(value) + " " + unit + ": " + reason);
  }

  /// N, where the force of the simulated sensor is used.
  double sensorRange() {
    const Session::Force& force = session_.force;
    const bool is_used = force.controller == "measured" || force.hand != "predicted";
    if (session_.sensor.source != "simulated" || !is_used) return std::numeric_limits<double>::infinity();
    const YAML::Node overridden = parameterAt(session_.overrides, "force_sensor/simulated/axial_range");
    if (overridden.IsDefined()) {
      if (const double range = overridden.as<double>(-1); range > 0) return range;
      add("force_sensor/simulated/axial_range = " + YAML::Dump(overridden) + ": must be a number above 0");
      return std::numeric_limits<double>::infinity();
    }
    return parameterAt(loadYamlMap(session_.package + "/config/force_sensor.yaml"), "simulated/axial_range")
        .as<double>(0);
  }

  std::string text() {
    return "for a cell of " + shortNumber(2e6 * cell_.radius, 4) + " um: the needle starts at " +
           shortNumber(1e6 * rig_.sizes().start_height, 4) + " um, stops at " +
           shortNumber(1e6 * number(kController, "force_limit"), 3) + " uN and " +
           shortNumber(1e6 * number(kController, "depth_limit"), 3) + " um of depth; mouth at " +
           shortNumber(1e6 * rig_.sizes().mouth_height, 4) + " um, dish at " +
           shortNumber(1e6 * rig_.sizes().floor_height, 4) + " um";
  }

  const Session& session_;
  CellFacts cell_;
  RigDescription rig_;
  YAML::Node base_, changed_;
  std::vector<std::string> errors_;
};

}  // namespace

SessionFit SessionFit::of(const Session& session, const YAML::Node& device) { return Fit(session, device).run(); }

}  // namespace microinjection
