#pragma once

#include <yaml-cpp/yaml.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "hardware/injector/injector_model.h"
#include "hardware/injector/injector_registry.h"
#include "hardware/injector/serial_injector.h"
#include "hardware/serial/emulated_wire.h"
#include "hardware/serial/serial_port.h"

namespace microinjection {

/// config/injectors/NAME.yaml, with what its user has to fill in.
inline YAML::Node injectorFile(const std::string& name) {
  YAML::Node file = YAML::LoadFile(MICROINJECTION_SOURCE_DIR "/config/injectors/" + name + ".yaml");
  if (name == "femtojet") file["serial"]["codes"]["inject"] = "901";  // the emulator's, which is made up
  return file;
}

struct InjectorFile {
  InjectorModelConfig model;
  SerialPortConfig port;
  InjectorProtocol protocol;

  explicit InjectorFile(const YAML::Node& file) {
    ConfigReader reader(file, "test");
    model = InjectorModelConfig::read(reader);
    ConfigReader serial = reader.section("serial");
    port = SerialPortConfig::read(serial, 9600);
    protocol = InjectorProtocol::read(serial);
    reader.finish();
  }
};

/// A device and what it truly does, in virtual time. `simulated` is the model, which is its own truth; the others are
/// drivers on the emulator's line.
class InjectorBench {
 public:
  static constexpr double kStep = 5e-3;      // s
  static constexpr double kPressure = 20e3;  // Pa, gauge, of all pulses

  explicit InjectorBench(const std::string& name)
      : InjectorBench(name, name == "simulated" ? YAML::Node() : injectorFile(name)) {}
  InjectorBench(const std::string& name, const YAML::Node& file, std::shared_ptr<DeviceEmulator> line_end = nullptr,
                std::shared_ptr<InjectorEmulator> emulator = nullptr)
      : emulator_(std::move(emulator)) {
    if (name == "simulated") {
      device_ = std::make_unique<InjectorModel>(InjectorModelConfig{});
      return;
    }
    const InjectorFile read(file);
    model_ = read.model;
    stops_ = !read.protocol.stop.empty();
    for (const Injector& each : injectors()) {
      if (each.name == name && !emulator_) emulator_ = each.make_emulator();
    }
    auto wire = std::make_unique<EmulatedWire>(line_end ? line_end : emulator_, read.port.baud);
    wire_ = wire.get();
    device_ = std::make_unique<SerialInjector>(std::move(wire), read.protocol, read.model);
  }

  void step(double dt = kStep) {
    device_->step(time_ += dt);
    const bool high = pressure() > 0.5 * (kPressure + model_.balance);
    if (high && !high_) ++begun_;
    if (!high && high_) ++ended_;
    under_pulse_ += high ? dt : 0;
    high_ = high;
  }
  void run(double duration) {
    for (const double end = time_ + duration; time_ < end;) step();
  }

  InjectorDevice& device() { return *device_; }
  InjectorEmulator& emulator() { return *emulator_; }
  EmulatedWire& wire() { return *wire_; }
  bool real() const { return emulator_ != nullptr; }
  bool stops() const { return stops_; }
  double balance() const { return model_.balance; }
  Eigen::Vector2d range() const { return model_.limits.pressure_range; }  ///< Pa
  double time() const { return time_; }

  // The truth.
  double pressure() const { return emulator_ ? emulator_->pressure() : device_->reading().pressure; }
  unsigned begun() const { return begun_; }           ///< pulses
  unsigned ended() const { return ended_; }           ///< of those
  double underPulse() const { return under_pulse_; }  ///< s, of all of them

 private:
  InjectorModelConfig model_;
  std::shared_ptr<InjectorEmulator> emulator_;
  std::unique_ptr<InjectorDevice> device_;
  EmulatedWire* wire_ = nullptr;
  bool stops_ = true;
  double time_ = 0, under_pulse_ = 0;
  bool high_ = false;
  unsigned begun_ = 0, ended_ = 0;
};

/// All of them.
inline std::vector<std::string> injectorNames() {
  std::vector<std::string> names{"simulated"};
  for (const Injector& each : injectors()) names.push_back(each.name);
  return names;
}

}  // namespace microinjection
