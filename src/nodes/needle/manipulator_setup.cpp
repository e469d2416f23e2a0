#include "nodes/needle/manipulator_setup.h"

#include <limits>

#include "base/errors.h"
#include "hardware/devices/driver_registry.h"
#include "hardware/manipulator/simulated_manipulator.h"
#include "hardware/serial/emulated_wire.h"
#include "hardware/serial/fault.h"
#include "nodes/needle/external_manipulator.h"

namespace microinjection {
namespace {

ManipulatorSetup makeSimulated(const ManipulatorGeometry& geometry, ConfigReader& reader) {
  const auto config = SimulatedManipulatorConfig::read(reader);
  reader.finish();
  auto device = std::make_unique<SimulatedManipulator>(geometry, config);
  SimulatedManipulator* simulated = device.get();
  ManipulatorSetup rig;
  rig.device = std::move(device);
  rig.true_joints = [simulated] { return simulated->trueJoints(); };
  rig.inject = [simulated](const std::string& text, double) {
    const Fault fault = parseFault(text);
    if (fault.kind != Fault::Kind::kError)
      throw ConfigError("fault " + text + ": the simulated rig has error:CODE only");
    simulated->injectFault("error " + fault.code + ", injected on request");
  };
  return rig;
}

ManipulatorSetup makeExternal(const ManipulatorGeometry& geometry, Cycle& cycle, ConfigReader& reader) {
  const auto config = ExternalManipulatorConfig::read(reader);
  reader.finish();
  auto device = std::make_unique<ExternalManipulator>(cycle, geometry, config);
  ExternalManipulator* external = device.get();
  ManipulatorSetup rig;
  rig.device = std::move(device);
  rig.report = [external](diagnostic_updater::DiagnosticStatusWrapper& status) { external->report(status); };
  return rig;
}

/// The cable between driver and emulator, which can be disconnected for a time.
class Cable {
 public:
  explicit Cable(EmulatedWire& wire) : wire_(wire) {}
  void disconnect(double until) {
    wire_.disconnectCable();
    until_ = until;
  }
  void step(double time) {
    if (time < until_) return;
    wire_.connectCable();
    until_ = std::numeric_limits<double>::infinity();
  }

 private:
  EmulatedWire& wire_;
  double until_ = std::numeric_limits<double>::infinity();  // s
};

double pullDuration(const std::string& text) {
  std::size_t end = 0;
  double duration = 0;
  try {
    duration = std::stod(text.substr(5), &end);
  } catch (const std::exception&) {
    end = 0;
  }
  if (end == 0 || end + 5 != text.size() || !(duration >= 0 && duration < 3600)) {
    throw ConfigError("fault " + text + ": must be pull:S with 0 <= S < 3600 s");
  }
  return duration;
}

ManipulatorSetup makeEmulated(const DriverEntry& rig, ConfigReader& reader, ConfigReader& emulator_reader) {
  const std::shared_ptr<ManipulatorEmulator> emulator = rig.make_emulator();
  double latency = 0;  // s
  emulator_reader.number("latency", latency, Range::closed(0, 1));
  emulator->configure(emulator_reader);
  auto wire = std::make_unique<EmulatedWire>(emulator, rig.default_baud, latency);
  const auto cable = std::make_shared<Cable>(*wire);  // the driver owns the wire and lives as long as the cable
  ManipulatorSetup result;
  result.device = rig.make_driver(reader, std::move(wire));
  result.before_step = [cable](double time) { cable->step(time); };
  result.inject = [cable, emulator](const std::string& text, double time) {
    if (text.rfind("pull:", 0) == 0) return cable->disconnect(time + pullDuration(text));
    emulator->inject(parseFault(text));
  };
  return result;
}

}  // namespace

ManipulatorSetup makeManipulatorSetup(const std::string& name, bool emulated, const ManipulatorGeometry& geometry,
                                      Cycle& cycle, ConfigReader reader, ConfigReader emulator) {
  if (name == "sim" || name == "external") {
    if (emulated) throw ConfigError("emulated = true: must be false with rig = " + name + ", which has no driver");
    return name == "sim" ? makeSimulated(geometry, reader) : makeExternal(geometry, cycle, reader);
  }
  const DriverEntry& rig = findDriver(name);
  if (emulated) return makeEmulated(rig, reader, emulator);
  ManipulatorSetup result;
  result.device = rig.make_driver(reader, nullptr);
  result.moves_in_real_time = true;
  return result;
}

}  // namespace microinjection
