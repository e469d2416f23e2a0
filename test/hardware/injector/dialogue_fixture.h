#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "hardware/injector/serial_injector.h"
#include "hardware/injector/test_protocol.h"
#include "hardware/serial/scripted_wire.h"

namespace microinjection {

constexpr char kSetSetTrigger[] = R"yaml(
pulse:
  - {send: "P{pressure_hPa:1}", expect: OK}
  - {send: "T{duration_ms:0}", expect: OK}
  - {send: "G", expect: "OK|GONE"}
balance: [{send: "C{pressure_hPa:1}", expect: OK}, {send: "C", expect: "C=([0-9.]+)", confirm: pressure_hPa}]
stop: [{send: S, expect: OK}]
refuse: "ERR.*"
terminator: CRLF
)yaml";

class DialogueTest : public ::testing::Test {
 protected:
  explicit DialogueTest(const std::string& text = kSetSetTrigger)
      : injector{std::make_unique<ScriptedWire>(script), testProtocol(text), model} {
    answers = {{"P", "OK"}, {"T", "OK"}, {"G", "OK"}, {"C10.0", "OK"}, {"C", "C=10.0"}, {"S", "OK"}};
  }

  static InjectorModelConfig withBalance(double pressure) {
    InjectorModelConfig config;
    config.balance = pressure;
    return config;
  }

  /// The answer to a line is that of its whole, or of its letter; none: it is not answered.
  void run(double duration) {
    for (const double end = time + duration; time < end;) {
      injector.step(time += 0.01);
      for (; answered < script.sent.size(); ++answered) {
        std::string line = script.sent[answered];
        ASSERT_EQ(line.substr(line.size() - 2), "\r\n");
        line.resize(line.size() - 2);
        said.push_back(line);
        const std::string key = answers.count(line) ? line : line.substr(0, 1);
        if (answers.count(key)) script.incoming += answers[key] + "\r\n";
      }
    }
  }

  long count(const std::string& line) const { return std::count(said.begin(), said.end(), line); }

  InjectorModelConfig model = withBalance(1000);
  WireScript script;
  SerialInjector injector;
  std::map<std::string, std::string> answers;
  std::vector<std::string> said;
  std::size_t answered = 0;
  double time = 0;
};

}  // namespace microinjection
