#pragma once

#include <yaml-cpp/yaml.h>

#include <QApplication>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/OperatingState.h"
#include "cell_microinjection/StringStamped.h"
#include "rviz/console_widget.h"
#include "rviz/microscope_widget.h"
#include "virtual_session.h"
#include "window_user.h"

namespace microinjection {

/// Of the test, for who shares a bus that the executive owns.
inline std::shared_ptr<Bus> shared(Bus& bus) {
  return std::shared_ptr<Bus>(&bus, [](Bus*) {});
}

/// Has the console find a node's parameters, as a ROS master would have them.
inline void setParameters(VirtualSession& session, const std::string& name, const YAML::Node& value) {
  session.executive().network().setParameter(name, value);
  if (!value.IsMap()) return;
  for (const auto& entry : value) setParameters(session, name + "/" + entry.first.as<std::string>(), entry.second);
}

/// The operator's console among the nodes of a virtual session, its user, and the commands that the user has sent.
class ConsoleBench {
 public:
  /// `task`: whose console, of config/console.
  ConsoleBench(VirtualSession& session, const std::string& task) : session_(session) {
    startQt();
    session.world().hear<cell_microinjection::StringStamped>(kCommands);
    session.executive().add("rviz", [&](Bus& bus) {
      const auto console =
          std::make_shared<ConsoleWidget>([this](double age) { return needle_ ? needle_(age) : std::nullopt; });
      console->showParts(partsOf(task));
      console->start(shared(bus));
      bus.setStep(1e-3 * ConsoleWidget::kPeriod, [widget = console.get()](const ros::Time&) { widget->tick(); });
      console_ = console.get();
      return console;
    });
    console_->resize(console_->sizeHint().expandedTo({640, 900}));
    console_->show();
    QApplication::setActiveWindow(console_);
    user_ = std::make_unique<WindowUser>(*console_);
    run(0.2);
  }
  ConsoleBench(const ConsoleBench&) = delete;

  WindowUser& user() { return *user_; }
  ConsoleWidget& console() { return *console_; }
  VirtualSession& session() { return session_; }
  TestNode& world() { return session_.world(); }
  /// Where the needle is, for the console.
  void setNeedle(ConsoleWidget::NeedlePose needle) { needle_ = std::move(needle); }

  void run(double seconds) {
    session_.run(seconds);
    QApplication::processEvents();  // what has appeared is laid out
  }
  /// Runs until the user sees it. @returns whether that was so within `limit` (s)
  bool until(const std::function<bool()>& seen, double limit = 10) {
    constexpr double kLook = 0.05;  // s
    for (double time = 0; time < limit; time += kLook) {
      if (seen()) return true;
      run(kLook);
    }
    return seen();
  }

  std::string headline() const { return WindowUser::lampIn(*console_).first; }
  std::string headlineText() const { return WindowUser::lampIn(*console_).second; }
  /// The commands that were sent, in their order.
  std::vector<std::string> sent() {
    std::vector<std::string> commands;
    for (const auto& message : world().hear<cell_microinjection::StringStamped>(kCommands).all())
      commands.push_back(message->string);
    return commands;
  }

 private:
  static constexpr char kCommands[] = "controller/state_command";

  static std::string partsOf(const std::string& task) {
    const YAML::Node file = YAML::LoadFile(MICROINJECTION_SOURCE_DIR "/config/console/" + task + ".yaml");
    return file["Panels"][0]["Parts"].as<std::string>();
  }

  VirtualSession& session_;
  ConsoleWidget::NeedlePose needle_;
  ConsoleWidget* console_ = nullptr;
  std::unique_ptr<WindowUser> user_;
};

/// The test as the controller that a console sees: it reports a state, and executes enable, disable, pause and resume.
class ShownController {
 public:
  /// `parameters`: those that a console reads, YAML.
  ShownController(VirtualSession& session, const std::string& parameters)
      : node_(session.addTestNode("injection_controller", 0.01)) {
    setParameters(session, "/injection_controller", YAML::Load(parameters));
    status.state = "idle";
    node_.repeat<cell_microinjection::InjectionStatus>("controller/injection_state",
                                                       [this] { return std::optional(status); });
    change("DISABLED");
    listen();
  }

  /// As the real one: its operating state comes at a change only.
  void change(const std::string& next) {
    state_ = next;
    cell_microinjection::OperatingState message;
    message.state = next;
    message.is_homed = true;
    node_.say("controller/operating_state", message, true);
  }
  void listen() {
    commands_ = node_.bus().subscribe<cell_microinjection::StringStamped>(
        "controller/state_command", 10, [this](const auto& delivery) { execute(delivery.message->string); });
  }
  void deafen() { commands_.shutdown(); }
  const std::string& state() const { return state_; }

  cell_microinjection::InjectionStatus status;  ///< that it reports

 private:
  void execute(const std::string& command) {
    if (command == "enable" || command == "resume") change("ENABLED");
    if (command == "disable") change("DISABLED");
    if (command == "pause") change("PAUSED");
  }

  TestNode& node_;
  Subscription commands_;
  std::string state_;
};

}  // namespace microinjection
