#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>

#include "hardware/injector/serial_injector.h"
#include "hardware/injector/test_protocol.h"
#include "hardware/serial/scripted_wire.h"

namespace microinjection {

class SerialInjectorTest : public ::testing::Test {
 protected:
  explicit SerialInjectorTest(const std::string& text = kTestProtocol)
      : injector{std::make_unique<ScriptedWire>(script), testProtocol(text), model} {}

  static InjectorModelConfig withBalance(double pressure) {
    InjectorModelConfig config;
    config.balance = pressure;
    return config;
  }

  /// Steps for a time (s) and answers each line but pulses as a device in order would.
  void run(double duration) {
    for (const double end = time + duration; time < end;) {
      injector.step(time += 0.01);
      if (script.sent.size() == answered) continue;
      const std::string line = script.sent.back();
      answered = script.sent.size();
      pulses += line[0] == 'P' ? 1 : 0;
      if (deaf) continue;
      if (line[0] == 'S' && stops_ignored-- > 0) continue;
      script.incoming = line[0] == '?' ? "=10.0\r" : line[0] == 'P' ? pulse_reply : "OK\r";
    }
  }

  InjectorModelConfig model = withBalance(1000);
  WireScript script;
  SerialInjector injector;
  double time = 0;
  std::size_t answered = 0;
  int pulses = 0;  // that the device has heard
  bool deaf = false;
  int stops_ignored = 0;
  std::string pulse_reply = "OK\r";
};

class StoppedSerialInjectorTest : public SerialInjectorTest {
 protected:
  StoppedSerialInjectorTest() : SerialInjectorTest(std::string(kTestProtocol) + kStop) {}
  long stops() const { return std::count(script.sent.begin(), script.sent.end(), "S\r"); }
};

}  // namespace microinjection
