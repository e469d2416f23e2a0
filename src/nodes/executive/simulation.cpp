#include "nodes/executive/simulation.h"

#include <chrono>
#include <sstream>

#include "base/errors.h"
#include "cell_microinjection/CellContact.h"
#include "cell_microinjection/InjectionStatus.h"
#include "cell_microinjection/StringStamped.h"
#include "nodes/executive/session_nodes.h"

namespace microinjection {
namespace {

/// s of the session between two looks at the wall's clock
constexpr double kStride = 0.05;

/// What tells that a session is over, and in which state it is left.
class SessionWatch {
 public:
  explicit SessionWatch(Bus& bus) {
    phase_ = bus.subscribe<cell_microinjection::StringStamped>(
        "virtual_hand/phase", 10, [this](const auto& delivery) { hand_done_ = delivery.message->string == "done"; });
    injection_ = bus.subscribe<cell_microinjection::InjectionStatus>(
        "controller/injection_state", 10, [this](const auto& delivery) { status_ = *delivery.message; });
    cell_ = bus.subscribe<cell_microinjection::CellContact>("cell/contact", 1, [this](const auto& delivery) {
      in_cell_ = delivery.message->in_contact || delivery.message->inside;
    });
  }

  bool done() const {
    return hand_done_ || (status_.state == "idle" && !status_.outcome.empty() && status_.outcome != "none");
  }
  const cell_microinjection::InjectionStatus& status() const { return status_; }
  bool inCell() const { return in_cell_; }

 private:
  bool hand_done_ = false, in_cell_ = false;
  cell_microinjection::InjectionStatus status_;
  Subscription phase_, injection_, cell_;
};

}  // namespace

void requireSimulable(const Session& session) {
  std::ostringstream problems;
  const auto refuse = [&](const std::string& key, const std::string& value, const char* allowed) {
    problems << (problems.tellp() > 0 ? "\n" : "") << session.places.at(key) << ": " << key << " = " << value
             << ": needs a live session; in virtual time must be " << allowed;
  };
  const auto emulated = [](const std::string& name) { return name.rfind("emulated_", 0) == 0; };
  if (session.rig.real()) refuse("rig/name", session.rig.name, "sim or emulated_NAME");
  if (session.sensor.source == "serial" || session.sensor.source == "topic")
    refuse("sensor/source", session.sensor.source, "simulated or none");
  if (session.injector != "simulated" && session.injector != "none" && !emulated(session.injector))
    refuse("injector", session.injector, "simulated, emulated_NAME or none");
  if (session.hand.present() && !session.hand.isVirtual())
    refuse("hand/device", session.hand.device, "virtual_hand or none");
  if (session.hand.wait_for_go) refuse("hand/wait_for_go", "true", "false");
  if (session.injection.mode == "semi_automatic") refuse("injection/mode", "semi_automatic", "manual or automatic");
  if (session.camera.source == "device" || session.camera.source == "topic")
    refuse("camera/source", session.camera.source, "none, sim, folder or video");
  if (session.display.rviz) refuse("display/rviz", "true", "false");
  if (session.display.console != "none") refuse("display/console", session.display.console, "none");
  if (!session.injection.auto_enable) refuse("injection/auto_enable", "false", "true: nobody enables the needle");
  if (!session.hand.present() && !session.injection.start_when_enabled)
    refuse("injection/start_when_enabled", "false", "true: nobody starts the injection");
  if (problems.tellp() > 0) throw ConfigError(problems.str());
}

SimulationResult simulate(const Session& session, const SimulationConfig& config,
                          const std::function<void(double)>& progress) {
  using Clock = std::chrono::steady_clock;
  requireSimulable(session);
  Executive executive;
  const SessionWatch* watch = nullptr;  // until the executive ends it
  executive.add("simulation", [&](Bus& bus) {
    const auto node = std::make_shared<SessionWatch>(bus);
    watch = node.get();
    return node;
  });
  Session simulated = session;
  simulated.display.markers = false;  // nobody looks, and no record has them
  addNodes(executive, planOf(simulated, SessionClock::kVirtual));

  SimulationResult result;
  const Clock::time_point begin = Clock::now();
  Clock::time_point shown = begin;
  const double limit = config.duration > 0 ? config.duration : config.limit;
  const auto is_over = [&] { return executive.failures().size() > 0 || (config.duration <= 0 && watch->done()); };
  try {
    while (executive.time() < limit && !is_over()) {
      executive.runUntil(is_over, std::min(kStride, limit - executive.time()));
      if (progress && Clock::now() - shown > std::chrono::milliseconds(100)) {
        shown = Clock::now();
        progress(executive.time());
      }
    }
  } catch (const std::exception& error) {
    result.failures.emplace_back(error.what());
  }
  result.done = config.duration > 0 || watch->done();
  if (result.done && config.duration <= 0 && result.failures.empty()) executive.runFor(config.settling);
  result.simulated = executive.time();
  result.outcome = watch->status().outcome;
  if (watch->inCell()) {
    std::ostringstream text;
    text << "the session ends while the needle is in the cell, " << 1e6 * watch->status().depth << " um deep";
    result.warnings.push_back(text.str());
  }
  if (!result.done && executive.failures().empty() && result.failures.empty()) {
    std::ostringstream text;
    text << "neither the hand nor the injection was done within " << limit << " s";
    result.warnings.push_back(text.str());
  }
  executive.endAll();
  result.took = std::chrono::duration<double>(Clock::now() - begin).count();
  for (const auto& [node, error] : executive.failures()) result.failures.push_back(node + ": " + error);
  return result;
}

}  // namespace microinjection
