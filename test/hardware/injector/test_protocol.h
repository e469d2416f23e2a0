#pragma once

#include <string>

#include "hardware/injector/injector_protocol.h"

namespace microinjection {

constexpr char kTestProtocol[] = R"yaml(
pulse: [{send: "P{pressure_hPa:1} {duration_ms:0}", expect: "OK", timeout: 0.5}]
balance: [{send: "C{pressure_hPa:1}", expect: "OK", timeout: 0.5}]
query: {send: "?", expect: "=([-+]?[0-9]+\\.[0-9])", timeout: 0.5}
query_period: 0.2
pressure_unit: 100
refuse: "ERR.*"
terminator: CR
quiet: 0.1
)yaml";
constexpr char kStop[] = "stop: [{send: S, expect: OK}]\n";

inline InjectorProtocol testProtocol(const std::string& text = kTestProtocol) {
  ConfigReader reader(YAML::Load(text), "test");
  InjectorProtocol read = InjectorProtocol::read(reader);
  reader.finish();
  return read;
}

}  // namespace microinjection
