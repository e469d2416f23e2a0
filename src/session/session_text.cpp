#include "base/errors.h"
#include "session/parameter_tree.h"
#include "session/session.h"

namespace microinjection {
namespace {

/// A group of keys of a file.
class Group {
 public:
  explicit Group(int indent) : indent_(indent, ' ') {}
  Group& text(const std::string& key, const std::string& value) { return add(key, textValue(value)); }
  Group& flag(const std::string& key, bool value) { return add(key, booleanValue(value)); }
  Group& number(const std::string& key, double value) { return add(key, numberValue(value)); }
  Group& raw(const std::string& key, const std::string& value) {
    text_ += indent_ + key + ":" + value;
    return *this;
  }
  const std::string& lines() const { return text_; }

 private:
  Group& add(const std::string& key, const YAML::Node& value) { return raw(key, " " + scalarText(value) + "\n"); }

  std::string indent_, text_;
};

std::string handText(const Session::Hand& hand) {
  const std::string topics = Group(4)
                                 .text("namespace", hand.topics.name_space)
                                 .text("force", hand.topics.force)
                                 .text("clutch", hand.topics.clutch)
                                 .text("operator_present", hand.topics.operator_present)
                                 .lines();
  return "\n" + Group(2)
                    .text("device", hand.device)
                    .text("config", hand.config.empty() ? "auto" : hand.config)
                    .raw("topics", "\n" + topics)
                    .text("position_type", hand.position_type)
                    .flag("require_operator", hand.require_operator)
                    .text("motion", hand.motion)
                    .flag("wait_for_go", hand.wait_for_go)
                    .lines();
}

std::string sensorText(const Session::Sensor& sensor) {
  std::vector<std::string> mounting;
  for (const double value : sensor.mounting) mounting.push_back(numberText(value));
  return "\n" + Group(2)
                    .text("source", sensor.source)
                    .raw("mounting", " [" + join(mounting, ", ") + "]\n")
                    .flag("quiet", sensor.quiet)
                    .lines();
}

}  // namespace

std::string Session::text() const {
  Group keys(0);
  keys.raw("version", " " + std::to_string(kVersion) + "\n");
  keys.text("cell", cell).text("hidden", hidden).text("model", model).flag("twin", twin);
  keys.raw("rig", "\n" + Group(2)
                             .text("name", rig.name)
                             .text("port", rig.port)
                             .text("namespace", rig.name_space)
                             .text("config", rig.config)
                             .text("urdf", rig.urdf)
                             .flag("allow_network", rig.allow_network)
                             .lines());
  keys.raw("sensor", sensorText(sensor)).text("injector", injector).raw("hand", handText(hand));
  keys.raw("force", "\n" + Group(2).text("controller", force.controller).text("hand", force.hand).lines());
  keys.raw("injection", "\n" + Group(2)
                                   .text("mode", injection.mode)
                                   .flag("auto_enable", injection.auto_enable)
                                   .flag("start_when_enabled", injection.start_when_enabled)
                                   .raw("layers", " " + std::to_string(injection.layers) + "\n")
                                   .lines());
  keys.raw("link", "\n" + Group(2)
                              .text("scheme", link.scheme)
                              .number("delay", link.delay)
                              .number("jitter", link.jitter)
                              .number("loss", link.loss)
                              .flag("emulated", link.emulated)
                              .lines());
  keys.raw("camera", "\n" + Group(2)
                                .text("source", camera.source)
                                .text("config", camera.config)
                                .text("path", camera.path)
                                .text("topic", camera.topic)
                                .lines());
  keys.raw("display", "\n" + Group(2)
                                 .flag("markers", display.markers)
                                 .flag("rviz", display.rviz)
                                 .text("console", display.console)
                                 .lines());
  keys.raw("record", "\n" + Group(2)
                                .text("folder", record.folder)
                                .flag("bag", record.bag)
                                .flag("end_when_done", record.end_when_done)
                                .text("trainee", record.trainee)
                                .text("history", record.history)
                                .text("training", record.training)
                                .lines());
  keys.text("notebook", notebook);
  keys.raw("overrides", overrides.size() == 0 ? " {}\n" : "\n" + parameterText(overrides, 2));
  return keys.lines();
}

}  // namespace microinjection
