#include "session/session.h"

#include <algorithm>
#include <filesystem>

#include "base/errors.h"
#include "session/parameter_tree.h"
#include "session/session_check.h"
#include "session/session_choices.h"
#include "session/session_paths.h"
#include "session/session_reader.h"

namespace microinjection {
namespace {

constexpr char kSessions[] = "config/sessions", kArgument[] = "argument";

std::string workingFolder() {
  std::error_code ignored;
  const std::string folder = std::filesystem::current_path(ignored).string();
  return folder.empty() ? "/" : folder;
}

/// The value of an argument: YAML where it begins as a list, a map or a text in quotes, otherwise as it is.
YAML::Node argumentValue(const std::string& text) {
  if (std::string("[{\"'").find(text.front()) == std::string::npos) return YAML::Node(text);
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception&) {
    return YAML::Node(text);
  }
}

/// The key, or one that it is part of, has a value.
bool isThere(const YAML::Node& keys, const std::string& key) {
  if (parameterAt(keys, key).IsDefined()) return true;
  for (std::size_t slash = key.find('/'); slash != std::string::npos; slash = key.find('/', slash + 1)) {
    const YAML::Node outer = parameterAt(keys, key.substr(0, slash));
    if (outer.IsDefined() && !outer.IsMap()) return true;
  }
  return false;
}

/// Reads a session's files, the base before what it is the base of, and then the arguments.
class Loader {
 public:
  explicit Loader(const std::string& package) : draft_(package) {}

  Session load(const std::string& file_or_name, const std::vector<std::string>& arguments) {
    const std::string path = pathOfFileOrName(file_or_name, workingFolder(), draft_.session.package, kSessions);
    draft_.session.places.source = path;
    if (isFile(path)) {
      readFile(path);
    } else {
      errors_.push_back("session = " + file_or_name + ": " + noSuchSession(path));
    }
    readArguments(arguments);
    if (!errors_.empty()) throw ConfigError(errors_);
    Session session = resolved(draft_);
    checkSession(session);
    return session;
  }

 private:
  std::string noSuchSession(const std::string& path) const {
    return "no such file: " + path + "; must be a path, or a name of " + kSessions + ": " +
           join(namesIn(draft_.session.package, kSessions), ", ");
  }

  void readFile(const std::string& path) {
    open_.push_back(path);
    try {
      ConfigReader reader = ConfigReader::ofFile(path);
      draft_.session.files.push_back(path);
      const std::string folder = std::filesystem::path(path).parent_path().string();
      readVersion(reader);
      readBase(reader, folder);
      readSessionKeys(reader, folder, draft_);
      reader.finish();
    } catch (const ConfigError& error) {
      errors_.push_back(error.what());
    }
    open_.pop_back();
  }

  static void readVersion(ConfigReader& reader) {
    int version = Session::kVersion;
    reader.integer("version", version, Range::finite(), ConfigReader::kRequired);
    if (version != Session::kVersion)
      reader.error("version",
                   "must be " + std::to_string(Session::kVersion) +
                       (version > Session::kVersion ? ": the file is for a newer version of this program"
                                                    : ", of which config/sessions/default.yaml has all keys"));
  }

  void readBase(ConfigReader& reader, const std::string& folder) {
    std::string base;
    reader.text("base", base);
    if (base.empty()) return;
    const std::string path = pathOfFileOrName(base, folder, draft_.session.package, kSessions);
    const auto first = std::find(open_.begin(), open_.end(), path);
    if (first != open_.end()) {
      reader.error("base", "is its own base: " + join({first, open_.end()}, " -> ") + " -> " + path);
    } else if (isFile(path)) {
      readFile(path);
    } else {
      reader.error("base", noSuchSession(path));
    }
  }

  void readArguments(const std::vector<std::string>& arguments) {
    YAML::Node keys(YAML::NodeType::Map);
    for (const std::string& argument : arguments) {
      const std::size_t equals = argument.find('=');
      const bool has_colon = equals != std::string::npos && equals > 0 && argument[equals - 1] == ':';
      std::string key = equals == std::string::npos ? "" : argument.substr(0, equals - (has_colon ? 1 : 0));
      if (key.empty()) {
        errors_.push_back(std::string(kArgument) + " " + argument +
                          ": must be KEY:=VALUE, such as hand.device:=keyboard");
        continue;
      }
      if (equals + 1 == argument.size()) continue;  // not given
      std::replace(key.begin(), key.end(), '.', '/');
      if (isThere(keys, key)) {
        errors_.push_back(std::string(kArgument) + " " + argument + ": is there twice; must be there once");
      } else {
        setParameter(keys, key, argumentValue(argument.substr(equals + 1)));
      }
    }
    ConfigReader reader(keys, kArgument);
    readSessionKeys(reader, workingFolder(), draft_);
    try {
      reader.finish();
    } catch (const ConfigError& error) {
      errors_.push_back(error.what());
    }
  }

  SessionDraft draft_;
  std::vector<std::string> open_;  // files that are being read, the newest last
  std::vector<std::string> errors_;
};

}  // namespace

std::string SessionPlaces::at(const std::string& key) const {
  const auto found = of.find(key);
  return found == of.end() ? source : found->second;
}

const std::vector<std::string>& overridableNodes() {
  static const std::vector<std::string> nodes = {
      "rig",           "calibration",   "camera",        "cell_estimator",   "cell_simulator",
      "display",       "focus",         "force_sensor",  "force_watchdog",   "haptic_bridge",
      "haptic_device", "holder",        "holder_rig",    "image_recorder",   "injection_controller",
      "injector",      "keyboard_hand", "link_emulator", "micromanipulator", "microscope",
      "notebook",      "virtual_hand",  "readiness",     "session_recorder", "teleoperation_follower",
      "touch",         "true_cell",     "vision",        "visual_servo"};
  return nodes;
}

Session Session::load(const std::string& file_or_name, const std::vector<std::string>& arguments,
                      const std::string& package) {
  return Loader(package.empty() ? packageFolder() : package).load(file_or_name, arguments);
}

std::string Session::text() const {
  YAML::Node keys = emptyMap();
  const auto text = [&](const std::string& key, const std::string& value) {
    setParameter(keys, key, textValue(value));
  };
  const auto flag = [&](const std::string& key, bool value) { setParameter(keys, key, booleanValue(value)); };
  const auto number = [&](const std::string& key, double value) { setParameter(keys, key, numberValue(value)); };
  setParameter(keys, "version", integerValue(kVersion));
  text("cell", cell);
  text("hidden", hidden);
  text("model", model);
  flag("estimator", estimator);
  text("rig/name", rig.name);
  text("rig/port", rig.port);
  text("rig/namespace", rig.name_space);
  text("rig/config", rig.config);
  text("rig/urdf", rig.urdf);
  flag("rig/allow_network", rig.allow_network);
  text("holder_rig/name", holder_rig.name);
  text("holder_rig/port", holder_rig.port);
  text("holder_rig/namespace", holder_rig.name_space);
  text("holder_rig/config", holder_rig.present() ? holder_rig.config : "auto");
  text("holder_rig/urdf", holder_rig.present() ? holder_rig.urdf : "auto");
  text("sensor/source", sensor.source);
  for (const double value : sensor.mounting) keys["sensor"]["mounting"].push_back(numberValue(value));
  flag("sensor/quiet", sensor.quiet);
  text("injector", injector);
  text("holder", holder);
  text("hand/device", hand.device);
  text("hand/config", hand.config.empty() ? "auto" : hand.config);
  text("hand/topics/namespace", hand.topics.name_space);
  text("hand/topics/force", hand.topics.force);
  text("hand/topics/clutch", hand.topics.clutch);
  text("hand/topics/operator_present", hand.topics.operator_present);
  text("hand/position_type", hand.position_type);
  flag("hand/require_operator", hand.require_operator);
  text("hand/motion", hand.motion);
  flag("hand/wait_for_go", hand.wait_for_go);
  text("force/controller", force.controller);
  text("force/hand", force.hand);
  text("injection/mode", injection.mode);
  flag("injection/auto_enable", injection.auto_enable);
  flag("injection/start_when_enabled", injection.start_when_enabled);
  setParameter(keys, "injection/layers", integerValue(injection.layers));
  text("link/scheme", link.scheme);
  number("link/delay", link.delay);
  number("link/jitter", link.jitter);
  number("link/loss", link.loss);
  flag("link/emulated", link.emulated);
  text("camera/source", camera.source);
  text("camera/config", camera.config);
  text("camera/path", camera.path);
  text("camera/topic", camera.topic);
  flag("display/markers", display.markers);
  flag("display/rviz", display.rviz);
  text("display/console", display.console);
  text("record/folder", record.folder);
  flag("record/bag", record.bag);
  flag("record/end_when_done", record.end_when_done);
  text("record/trainee", record.trainee);
  text("record/history", record.history);
  text("record/training", record.training);
  text("notebook", notebook);
  rate ? number("rate", *rate) : text("rate", "auto");
  setParameter(keys, "overrides", overrides);
  return parameterText(keys);
}

}  // namespace microinjection
