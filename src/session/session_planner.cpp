#include "session/session_plan.h"

#include <set>

#include "base/config_reader.h"
#include "base/errors.h"
#include "session/console_view.h"
#include "session/parameter_tree.h"
#include "session/session_fit.h"
#include "session/session_paths.h"

namespace microinjection {
namespace {

constexpr int kImages = 10, kMoves = 5;  // nice: nodes of images, and those that move the needle by them
constexpr char kKeyboard[] = "keyboard_hand";
constexpr char kFemtojetCode[] = "901";  // invented for the emulator: that of the device is not published

class Planner {
 public:
  Planner(const Session& session, SessionClock clock) : session_(session), clock_(clock) {
    plan_.files = session.files;
    plan_.parameters = emptyMap();
    device_ = session.hand.config.empty() ? emptyMap() : load(session.hand.config);
  }

  SessionPlan plan() {
    const SessionFit fit = SessionFit::of(session_, device_);
    plan_.files.push_back(session_.cell);
    plan_.files.push_back(session_.rig.urdf);
    if (session_.holder_rig.present()) plan_.files.push_back(session_.holder_rig.urdf);
    addRig();
    addSensor();
    addCells();
    if (session_.injector != "none") addPressure("injector", session_.injector);
    if (session_.holder != "none") addHolder();
    addController();
    addBridge();
    addHand();
    addDisplay();
    addImages();
    addRecorders();
    if (live()) addReadiness();
    for (NodePlan& node : plan_.nodes) {
      limitRate(node);
      const YAML::Node fitted = parameterAt(fit.parameters, node.name);
      if (fitted.IsDefined()) mergeParameters(node.parameters, fitted);
      addDeviceRemaps(node.remaps);
    }
    shareTilt();
    for (ForeignProcess& process : plan_.processes) addDeviceRemaps(process.remaps);
    plan_.parameters["robot_description"] = textValue(fit.robot_description);
    plan_.text = fit.text;
    return std::move(plan_);
  }

 private:
  /// The holding pipette's manipulator has the needle for an obstacle, as that is tilted.
  void shareTilt() {
    NodePlan *needle = nullptr, *holder = nullptr;
    for (NodePlan& node : plan_.nodes) {
      if (node.name == "micromanipulator") needle = &node;
      if (node.name == "holder_rig") holder = &node;
    }
    if (needle && holder)
      setParameter(holder->parameters, "other/tilt", parameterAt(needle->parameters, "pipette_tilt"));
  }

  /// Of a loop that would be faster than the session's.
  void limitRate(NodePlan& node) const {
    static const std::set<std::string> pictures = {"camera", "display", "image_recorder", "microscope"};
    static const std::set<std::string> loops = {"haptic_device", "teleoperation_follower"};  // without a rate in config
    if (!session_.rate || pictures.count(node.program) > 0) return;
    const YAML::Node rate = parameterAt(node.parameters, "rate");
    const double own = rate.IsDefined() ? rate.as<double>() : loops.count(node.program) > 0 ? 1000 : 0;
    if (own > *session_.rate) setParameter(node.parameters, "rate", numberValue(*session_.rate));
  }

  using Remaps = std::map<std::string, std::string>;

  YAML::Node load(const std::string& path) {
    plan_.files.push_back(path);
    return loadYamlMap(path);
  }
  std::string package(const std::string& file) const { return session_.package + "/" + file; }
  bool live() const { return clock_ == SessionClock::kWall; }

  /// With the parameters of config/PROGRAM.yaml.
  NodePlan& addConfigured(const std::string& program) {
    NodePlan& node = add(program, program);
    mergeParameters(node.parameters, load(package("config/" + program + ".yaml")));
    return node;
  }
  NodePlan& add(const std::string& name, const std::string& program) {
    NodePlan node;
    node.name = name;
    node.program = program;
    node.parameters = emptyMap();
    plan_.nodes.push_back(node);
    return plan_.nodes.back();
  }
  static void setText(NodePlan& node, const std::string& path, const std::string& value) {
    setParameter(node.parameters, path, textValue(value));
  }
  static void setFlag(NodePlan& node, const std::string& path, bool value) {
    setParameter(node.parameters, path, booleanValue(value));
  }
  /// Puts the device's file over the parameters of one of its nodes.
  void mergeDevice(NodePlan& node) {
    const YAML::Node of_device = parameterAt(device_, node.name);
    if (of_device.IsDefined()) mergeParameters(node.parameters, of_device);
  }

  void addRig() {
    NodePlan& needle = addManipulator("micromanipulator", session_.rig, session_.rig.name);
    if (session_.holder_rig.present()) {
      setText(needle, "other/tip", "holding_pipette");
      needle.remaps["/other_rig/measured_cp"] = "/holder_rig/measured_cp";
      addHolderRig();
    }
    ForeignProcess frames;
    frames.name = frames.package = frames.program = "robot_state_publisher";
    plan_.processes.push_back(frames);
  }

  /// The same node a second time, with all topics below a name of its own.
  void addHolderRig() {
    NodePlan& node = addManipulator("holder_rig", session_.holder_rig, "holder_" + session_.holder_rig.name);
    setText(node, "tip", "holding_pipette");
    setText(node, "other/tip", "needle_tip");
    setFlag(node, "auto_enable", false);
    for (const char* topic :
         {"servo_cp", "servo_cv", "move_cp", "state_command", "emulated_fault", "measured_cp", "measured_cv",
          "setpoint_cp", "true_cp", "abilities", "operating_state", "loop_state", "setpoint_trace"})
      node.remaps[std::string("/needle/") + topic] = std::string("/holder_rig/") + topic;
    node.remaps["/other_rig/measured_cp"] = "/needle/measured_cp";
  }

  /// `emulator`: name of the process of an emulated one.
  NodePlan& addManipulator(const std::string& name, const Session::Manipulator& rig, const std::string& emulator_name) {
    const std::string terminal = runtimeFolder() + "/" + emulator_name;
    const bool is_process = rig.emulated() && live();
    NodePlan& node = add(name, "micromanipulator");
    mergeParameters(node.parameters, load(package("config/micromanipulator.yaml")));
    setParameter(node.parameters, "device", load(rig.config));
    setText(node, "rig", rig.device());
    setFlag(node, "allow_network", session_.rig.allow_network);
    setFlag(node, "emulated", rig.emulated() && !is_process);
    if (rig.real() && !rig.external() && rig.port != "auto") setText(node, "device/port/path", rig.port);
    if (rig.external() && rig.name_space != "auto") setText(node, "device/namespace", rig.name_space);
    if (rig.emulated()) setText(node, "device/port/path", terminal);
    if (is_process) {
      ForeignProcess emulator;
      emulator.name = emulator_name;
      emulator.package = "cell_microinjection";
      emulator.program = "emulate";
      emulator.arguments = {rig.device(), "--link", terminal};
      plan_.processes.push_back(emulator);
    }
    return node;
  }

  void addSensor() {
    if (session_.sensor.source == "none") return;
    NodePlan& node = addConfigured("force_sensor");
    setText(node, "source", session_.sensor.source);
    setFlag(node, "quiet", session_.sensor.quiet);
    if (!session_.hidden.empty()) node.remaps["/cell/predicted_cf"] = "/true_cell/predicted_cf";
    plan_.frames.push_back({"force_sensor_frame", "needle_tip", "force_sensor", session_.sensor.mounting});
  }

  void addCell(const std::string& name, const std::string& scene, const std::string& model) {
    NodePlan& node = add(name, "cell_simulator");
    mergeParameters(node.parameters, load(package("config/cell_simulator.yaml")));
    setText(node, "scene", scene);
    setText(node, "model", model);
    setText(node, "families", package("config/families"));
    setText(node, "needle", needle());
  }
  /// The simulated rig tells the true pose of its needle.
  std::string needle() const { return session_.rig.simulated() ? "true" : "measured"; }

  void addCells() {
    if (!session_.hidden.empty()) {
      addCell("true_cell", session_.hidden, "auto");
      for (const char* topic : {"predicted_cf", "contact", "state", "set_parameters", "parameters"})
        plan_.nodes.back().remaps[std::string("/cell/") + topic] = std::string("/true_cell/") + topic;
      plan_.files.push_back(session_.hidden);
    }
    if (session_.estimator) {
      NodePlan& node = addConfigured("cell_estimator");
      setText(node, "scene", session_.cell);
      if (!servesEstimate()) setFlag(node, "serve", false);
      setText(node, "families", package("config/families"));
    }
    addCell("cell_simulator", session_.cell, session_.model);
    if (session_.holder == "none") return;
    NodePlan& cell = plan_.nodes.back();
    setFlag(cell, "holder", true);
    const Session::Manipulator& rig = session_.holder_rig;
    if (rig.present()) setText(cell, "holder_rig", rig.simulated() ? "true" : "measured");
  }
  /// Otherwise the simulated cell would follow itself: what the sensor feels, or the image shows, is the served cell.
  bool servesEstimate() const {
    if (!session_.hidden.empty()) return true;
    return session_.sensor.source == "none" ? session_.camera.source != "sim" : session_.sensor.source != "simulated";
  }

  /// A node with a device of config/injectors, or a simulated one.
  NodePlan& addPressure(const std::string& program, const std::string& name) {
    const bool is_emulated = name.rfind("emulated_", 0) == 0;
    const std::string device = is_emulated ? name.substr(9) : name;
    NodePlan& node = addConfigured(program);
    const bool has_file = device != "simulated" && device != "serial";
    if (has_file) mergeParameters(node.parameters, load(package("config/injectors/" + device + ".yaml")));
    if (name == "emulated_femtojet") setText(node, "serial/codes/inject", kFemtojetCode);
    setText(node, "source", device == "simulated" ? "simulated" : "serial");
    setText(node, "emulated", is_emulated ? device : "none");
    return node;
  }

  void addHolder() {
    NodePlan& node = addPressure("holder", session_.holder == "sim" ? "simulated" : session_.holder);
    setFlag(node, "auto_enable", session_.injection.auto_enable);
  }

  void addController() {
    NodePlan& node = addConfigured("injection_controller");
    setText(node, "mode", session_.injection.mode);
    setText(node, "force_source", session_.force.controller);
    setFlag(node, "quiet_sensor", session_.sensor.quiet);
    setFlag(node, "auto_enable", session_.injection.auto_enable);
    setFlag(node, "start_when_enabled", session_.injection.start_when_enabled);
    setParameter(node.parameters, "goal/layers", integerValue(session_.injection.layers));
    setFlag(node, "injector", session_.injector != "none");
    setFlag(node, "holder", session_.holder != "none");
  }

  void addBridge() {
    if (!session_.hand.present()) return;
    const Session::Link& link = session_.link;
    const bool has_link = link.scheme != "none";
    NodePlan& bridge = addConfigured("haptic_bridge");
    setText(bridge, "force_source", session_.force.hand);
    setFlag(bridge, "quiet_sensor", session_.sensor.quiet);
    if (session_.hand.isVirtual()) setParameter(bridge.parameters, "timeouts/hand_unchanged", integerValue(0));
    if (has_link) mergeParameters(bridge.parameters, load(package("config/link.yaml")));
    setText(bridge, "link/scheme", link.scheme);
    if (has_link && !link.emulated) bridge.remaps["/link/hand/received"] = "/link/rig/sent";
    mergeDevice(bridge);
    if (isCrtk() || isExternal()) setFlag(bridge, "require_operator", session_.hand.require_operator);
    if (has_link) addLink();
  }

  void addLink() {
    const Session::Link& link = session_.link;
    NodePlan& follower = add("teleoperation_follower", "teleoperation_follower");
    mergeParameters(follower.parameters, load(package("config/link.yaml")));
    setText(follower, "force_source", session_.force.hand);
    setFlag(follower, "quiet_sensor", session_.sensor.quiet);
    if (!link.emulated) {
      follower.remaps["/link/rig/received"] = "/link/hand/sent";
      return;
    }
    NodePlan& emulator = add("link_emulator", "link_emulator");
    setParameter(emulator.parameters, "delay", numberValue(link.delay));
    setParameter(emulator.parameters, "jitter", numberValue(link.jitter));
    setParameter(emulator.parameters, "loss", numberValue(link.loss));
    setParameter(emulator.parameters, "seed", integerValue(1));
  }

  bool isExternal() const { return session_.hand.device == "external"; }
  /// Its driver speaks CRTK, and haptic_device adapts it.
  bool isCrtk() const {
    const YAML::Node kind = parameterAt(device_, "haptic_device/kind");
    return kind.IsDefined() && kind.IsScalar() && kind.Scalar() == "crtk";
  }

  void addHand() {
    if (session_.hand.isVirtual()) {
      NodePlan& node = addConfigured("virtual_hand");
      setText(node, "motion", session_.hand.motion);
      setFlag(node, "wait_for_go", session_.hand.wait_for_go);
      plan_.files.push_back(session_.hand.motion);
      return;
    }
    if (live() && parameterAt(device_, "force_watchdog").IsDefined()) addWatchdog();
    if (parameterAt(device_, "haptic_device").IsDefined()) addAdapter();
    if (parameterAt(device_, kKeyboard).IsDefined()) addKeyboard();
  }

  /// The operator starts it, in a terminal: the session has its parameters only.
  void addKeyboard() {
    YAML::Node parameters = emptyMap();
    for (const YAML::Node& source : {device_, session_.overrides}) {
      if (const YAML::Node of_keyboard = parameterAt(source, kKeyboard); of_keyboard.IsDefined())
        mergeParameters(parameters, of_keyboard);
    }
    plan_.parameters[kKeyboard] = parameters;
  }

  /// Gives the device zero force in the place of a bridge or an adapter that was killed.
  void addWatchdog() {
    NodePlan& node = add("force_watchdog", "force_watchdog");
    node.respawn = true;
    mergeDevice(node);
    if (isExternal()) return;
    if (isCrtk()) {
      setText(node, "device", deviceNamespace());
    } else {
      setParameter(node.parameters, "kind", parameterAt(device_, "haptic_device/kind"));
      if (const YAML::Node device = adapterDevice(); device.IsDefined())
        setParameter(node.parameters, "device", device);
    }
  }

  void addAdapter() {
    const Session::Hand& hand = session_.hand;
    NodePlan& node = add("haptic_device", "haptic_device");
    node.respawn = true;
    mergeDevice(node);
    if (!isCrtk()) return;
    setText(node, "device", deviceNamespace());
    setButton(node, "clutch", hand.topics.clutch);
    setButton(node, "operator_present", hand.topics.operator_present);
    if (hand.position_type != "auto") setText(node, "position_type", hand.position_type);
  }
  static void setButton(NodePlan& node, const std::string& button, const std::string& topic) {
    if (topic == "auto") return;
    setText(node, button + "/topic", topic);
    setParameter(node.parameters, button + "/index", integerValue(0));
  }

  std::string deviceNamespace() const {
    if (session_.hand.topics.name_space != "auto") return session_.hand.topics.name_space;
    const YAML::Node device = adapterDevice();
    return device.IsDefined() && device.IsScalar() ? device.Scalar() : "/haptic";
  }
  YAML::Node adapterDevice() const {
    const YAML::Node device = parameterAt(session_.overrides, "haptic_device/device");
    return device.IsDefined() ? device : parameterAt(device_, "haptic_device/device");
  }
  /// A device without an adapter has the topics of ours under names of its own.
  void addDeviceRemaps(Remaps& remaps) const {
    if (!isExternal()) return;
    const Session::Topics& topics = session_.hand.topics;
    const std::string space = deviceNamespace();
    const auto named = [&](const std::string& topic, const char* otherwise) {
      return topic == "auto" ? space + "/" + otherwise : topic;
    };
    remaps["/haptic/measured_cp"] = space + "/measured_cp";
    remaps["/haptic/servo_cf"] = named(topics.force, "servo_cf");
    remaps["/haptic/clutch"] = named(topics.clutch, "clutch");
    remaps["/haptic/operator_present"] = named(topics.operator_present, "operator_present");
  }

  /// Another driver's images.
  Remaps imageRemaps() const {
    return session_.camera.source == "topic" ? Remaps{{"/microscope/image_raw", session_.camera.topic}} : Remaps{};
  }

  void addDisplay() {
    const Session::Display& display = session_.display;
    if (!display.markers) return;
    NodePlan& node = addConfigured("display");
    node.nice = kImages;
    node.remaps = imageRemaps();
    const bool has_console = display.console != "none";
    if (!display.rviz && !has_console) return;
    ForeignProcess rviz;
    rviz.name = rviz.program = "rviz";
    rviz.package = "cell_microinjection";
    // The nodes at 1 kHz have priority; but a stop button must not wait for an idle processor.
    rviz.prefix = has_console ? "nice -n 5" : "chrt --idle 0";
    // rviz misreads numbers below 1 under locales with a decimal comma.
    rviz.environment["LC_ALL"] = "C";
    rviz.remaps = imageRemaps();
    if (has_console) {
      rviz.arguments = {"-d"};
      rviz.view = consoleView(session_.package, display.console);
    } else {
      rviz.arguments = {"-d", package("config/session.rviz")};
    }
    plan_.processes.push_back(rviz);
  }

  void addImages() {
    const std::string& source = session_.camera.source;
    if (source == "none") return;
    const std::size_t first = plan_.nodes.size();
    addVision();
    if (!session_.record.folder.empty()) {
      NodePlan& recorder = addConfigured("image_recorder");
      recorder.nice = kImages;
      setText(recorder, "output_dir", session_.record.folder);
    }
    if (source == "sim") {
      NodePlan& node = addConfigured("microscope");
      node.nice = kImages;
      setText(node, "needle", needle());
    } else if (source != "topic") {
      addCamera();
    }
    for (std::size_t i = first; i < plan_.nodes.size(); ++i) {
      plan_.nodes[i].remaps = imageRemaps();
      if (session_.hidden.empty()) continue;
      for (const char* topic : {"contact", "state"})
        plan_.nodes[i].remaps[std::string("/cell/") + topic] = std::string("/true_cell/") + topic;
    }
  }

  void addVision() {
    NodePlan& vision = addConfigured("vision");
    vision.nice = kImages;
    setText(vision, "scene", session_.cell);
    setText(vision, "families", package("config/families"));
    addConfigured("calibration").nice = kMoves;
    addConfigured("visual_servo").nice = kMoves;
    addConfigured("focus").nice = kImages;
    addConfigured("touch").nice = kMoves;
  }

  void addCamera() {
    const Session::Camera& camera = session_.camera;
    NodePlan& node = add("camera", "camera");
    node.nice = kMoves;
    if (camera.source == "device") {
      mergeParameters(node.parameters, load(camera.config));
      return;
    }
    setText(node, "source", camera.source);
    setText(node, "path", camera.path);
    // A video has a rate of its own.
    setParameter(node.parameters, "rate", integerValue(camera.source == "folder" ? 10 : 0));  // 1/s
    setFlag(node, "loop", true);
  }

  void addRecorders() {
    if (!session_.notebook.empty()) {
      NodePlan& notebook = add("notebook", "notebook");
      const std::string name = session_.cell.substr(session_.cell.rfind('/') + 1);
      setText(notebook, "file", session_.notebook);
      setText(notebook, "cell", name.substr(0, name.find('.')));
    }
    const Session::Record& record = session_.record;
    if (record.folder.empty()) return;
    NodePlan& node = add("session_recorder", "session_recorder");
    node.required = true;
    setText(node, "output_dir", record.folder);
    for (NodePlan& each : plan_.nodes) {
      if (each.program == "virtual_hand") setText(each, "recorder", "/session_recorder");
    }
    setFlag(node, "hand", session_.hand.present());
    setFlag(node, "injector", session_.injector != "none");
    if (session_.holder != "none") setFlag(node, "holder", true);
    setFlag(node, "bag", record.bag);
    setFlag(node, "end_when_done", record.end_when_done);
    if (record.trainee.empty()) return;
    setParameter(node.parameters, "training", load(record.training));
    setText(node, "training/trainee", record.trainee);
    setText(node, "training/history", record.history);
  }

  /// For people: a session on a virtual clock has its result instead. The watchdog has no diagnostics.
  void addReadiness() {
    YAML::Node names(YAML::NodeType::Sequence);
    for (const NodePlan& each : plan_.nodes) {
      if (each.program != "force_watchdog") names.push_back(each.name);
    }
    NodePlan& node = add("readiness", "readiness");
    node.nice = kImages;
    setParameter(node.parameters, "nodes", names);
  }

  const Session& session_;
  SessionClock clock_;
  YAML::Node device_;  // the file of the hand's device
  SessionPlan plan_;
};

}  // namespace

SessionPlan planOf(const Session& session, SessionClock clock) { return Planner(session, clock).plan(); }

}  // namespace microinjection
