#include "session/session_reader.h"

#include "base/paths.h"
#include "session/layer_section.h"
#include "session/session_choices.h"

namespace microinjection {
namespace {

const std::vector<std::string> kAutomatic = {kAuto};
const std::vector<std::string> kNone = {""};

constexpr char kRigs[] = "config/rigs", kCells[] = "config/cells", kMotions[] = "config/hand_motions";
const Range kLayers = Range::closed(1, 10);

void readManipulator(LayerSection& section, Session::Manipulator& rig, const std::vector<std::string>& names) {
  const std::string before = rig.device();
  section.choice("name", rig.name, names);
  if (rig.device() != before) rig.port = rig.name_space = rig.config = kAuto;  // those of another device
  section.path("port", rig.port, kAutomatic);
  section.text("namespace", rig.name_space);
  section.fileOrName("config", rig.config, kRigs, kAutomatic);
  section.existingFile("urdf", rig.urdf, kAutomatic);
}

void readRig(LayerSection section, SessionDraft& draft, const SessionChoices& choices) {
  Session::Rig& rig = draft.session.rig;
  readManipulator(section, rig, choices.rigs);
  section.flag("allow_network", draft.allow_network);
}

void readHand(LayerSection section, Session::Hand& hand, const SessionChoices& choices) {
  const std::string before = hand.device;
  section.choice("device", hand.device, choices.hands);
  if (hand.device != before) {  // those of another device
    hand.config = hand.position_type = kAuto;
    hand.topics = {};
  }
  section.existingFile("config", hand.config, kAutomatic);
  LayerSection topics = section.section("topics");
  topics.text("namespace", hand.topics.name_space);
  topics.text("force", hand.topics.force);
  topics.text("clutch", hand.topics.clutch);
  topics.text("operator_present", hand.topics.operator_present);
  section.choice("position_type", hand.position_type, choices.position_types);
  section.flag("require_operator", hand.require_operator);
  section.fileOrName("motion", hand.motion, kMotions);
  section.flag("wait_for_go", hand.wait_for_go);
}

void readInjection(LayerSection section, SessionDraft& draft, const SessionChoices& choices) {
  section.choice("mode", draft.session.injection.mode, choices.modes);
  section.flag("auto_enable", draft.auto_enable);
  section.flag("start_when_enabled", draft.start_when_enabled);
  section.integer("layers", draft.session.injection.layers, kLayers);
}

void readLink(LayerSection section, SessionDraft& draft, const SessionChoices& choices) {
  Session::Link& link = draft.session.link;
  section.choice("scheme", link.scheme, choices.schemes);
  section.number("delay", link.delay, Range::nonNegative());
  section.number("jitter", link.jitter, Range::nonNegative());
  section.number("loss", link.loss, Range::closed(0, 1));
  section.flag("emulated", draft.link_emulated);
}

void readCamera(LayerSection section, Session::Camera& camera, const SessionChoices& choices) {
  section.choice("source", camera.source, choices.cameras);
  section.existingFile("config", camera.config, kAutomatic);
  section.path("path", camera.path, kNone);
  section.text("topic", camera.topic);
}

void readRecord(LayerSection section, Session::Record& record) {
  section.path("folder", record.folder, kNone);
  section.flag("bag", record.bag);
  section.flag("end_when_done", record.end_when_done);
  section.text("trainee", record.trainee);
  section.path("history", record.history, kAutomatic);
  section.existingFile("training", record.training, kAutomatic);
}

void setIfAuto(std::string& value, const std::string& instead) {
  if (value == kAuto) value = instead;
}

}  // namespace

SessionDraft::SessionDraft(const std::string& package) {
  session.package = package;
  session.cell = package + "/" + kCells + "/mouse_oocyte_injection.yaml";
  session.hand.motion = package + "/" + kMotions + "/indent_and_retract.yaml";
  for (std::string* automatic :
       {&session.rig.config, &session.rig.urdf, &session.holder_rig.config, &session.holder_rig.urdf,
        &session.sensor.source, &session.injector, &session.hand.config, &session.force.hand, &session.injection.mode,
        &session.camera.config, &session.record.history, &session.record.training, &session.notebook})
    *automatic = kAuto;
  session.overrides = YAML::Node(YAML::NodeType::Map);
}

void readSessionKeys(ConfigReader& reader, const std::string& folder, SessionDraft& draft) {
  Session& session = draft.session;
  const SessionChoices choices(session.package);
  LayerSection section(reader, "", folder, session);
  section.fileOrName("cell", session.cell, kCells);
  section.fileOrName("hidden", session.hidden, kCells, kNone);
  section.choice("model", session.model, choices.models);
  section.flag("estimator", session.estimator);
  readRig(section.section("rig"), draft, choices);
  LayerSection holder_rig = section.section("holder_rig");
  readManipulator(holder_rig, session.holder_rig, choices.holder_rigs);
  LayerSection sensor = section.section("sensor");
  sensor.choice("source", session.sensor.source, choices.sensors);
  sensor.numbers("mounting", session.sensor.mounting);
  sensor.flag("quiet", session.sensor.quiet);
  section.choice("injector", session.injector, choices.injectors);
  section.choice("holder", session.holder, choices.holders);
  readHand(section.section("hand"), session.hand, choices);
  LayerSection force = section.section("force");
  force.choice("controller", session.force.controller, choices.controller_forces);
  force.choice("hand", session.force.hand, choices.hand_forces);
  readInjection(section.section("injection"), draft, choices);
  readLink(section.section("link"), draft, choices);
  readCamera(section.section("camera"), session.camera, choices);
  LayerSection display = section.section("display");
  display.flag("markers", session.display.markers);
  display.flag("rviz", session.display.rviz);
  display.choice("console", session.display.console, choices.consoles);
  readRecord(section.section("record"), session.record);
  section.path("notebook", session.notebook, {"", kAuto});
  section.number("rate", session.rate, Range::closed(50, 5000));
  section.overrides("overrides");
}

Session resolved(SessionDraft draft) {
  Session session = draft.session;
  const std::string& package = session.package;
  const bool modelled = !session.rig.real();
  setIfAuto(session.rig.config, package + "/" + kRigs + "/" + session.rig.device() + ".yaml");
  const Session::Manipulator& holder_rig = session.holder_rig;
  const bool has_rig = holder_rig.present();
  setIfAuto(session.holder_rig.config, has_rig ? package + "/" + kRigs + "/" + holder_rig.device() + ".yaml" : "");
  setIfAuto(session.holder_rig.urdf, has_rig ? package + "/urdf/holding_axes.urdf" : "");
  setIfAuto(session.rig.urdf, package + "/urdf/rig.urdf");
  session.rig.allow_network = draft.allow_network.value_or(modelled);
  setIfAuto(session.sensor.source, modelled ? "simulated" : "serial");
  setIfAuto(session.injector, modelled ? "simulated" : "serial");
  if (!session.hand.present() || session.hand.isVirtual()) session.hand.config.clear();
  setIfAuto(session.hand.config, package + "/config/haptic/" + session.hand.device + ".yaml");
  setIfAuto(session.force.hand, session.force.controller);
  setIfAuto(session.injection.mode, session.hand.present() ? "manual" : "automatic");
  session.injection.auto_enable = draft.auto_enable.value_or(modelled);
  session.injection.start_when_enabled = draft.start_when_enabled.value_or(modelled);
  const Session::Link& link = session.link;
  session.link.emulated = draft.link_emulated.value_or(link.delay + link.jitter + link.loss > 0);
  setIfAuto(session.camera.config, package + "/config/camera.yaml");
  setIfAuto(session.record.history, userDataFile("training.csv"));
  setIfAuto(session.record.training, package + "/config/training.yaml");
  setIfAuto(session.notebook, session.record.folder.empty() ? "" : session.record.folder + "/notebook.csv");
  return session;
}

}  // namespace microinjection
