#include "injector/injector_protocol.h"

#include <gtest/gtest.h>

#include <map>

#include "base/errors.h"
#include "injector/test_protocol.h"

namespace microinjection {
namespace {

TEST(InjectorProtocol, ConfigurationIsStrict) {
  for (const auto& [text, message] : std::map<std::string, std::string>{
           {"{}", "pulse is missing"},
           {"{pulse: {send: 'P{force}', expect: OK}}", "{force} is not one of {pressure_Pa}"},
           {"{pulse: {send: 'P{pressure_Pa:x}', expect: OK}}", "one digit"},
           {"{pulse: {send: 'P{pressure_Pa', expect: OK}}", "a { without its }"},
           {"{balance: {send: '{duration_s}', expect: OK}}", "{duration_s} is not one of"},
           {"{balance: {send: 'P', expect: '('}}", "is no regular expression"},
           {"{query: {send: '?', expect: 'P=.*'}}", "must have a group"}}) {
    try {
      testProtocol(text);
      ADD_FAILURE() << text;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

TEST(InjectorProtocol, LinesHaveTheirUnitsAndDigits) {
  std::string text(kTestProtocol);
  text.replace(text.find("P{pressure_hPa:1} {duration_ms:0}"), 33,
               "{pressure_psi:4},{pressure_kPa:2},{pressure_Pa},{duration_s:3}");
  EXPECT_EQ(testProtocol(text).pulseLine({1, -6894.757293, 0.0125}), "-1.0000,-6.89,-6895,0.013\r");
  EXPECT_EQ(testProtocol().balanceLine(-1), "C0.0\r");  // no minus before a zero
  EXPECT_NEAR(testProtocol().asSent({1, 12344, 0.0126}).pressure, 12340, 1e-6);
  EXPECT_NEAR(testProtocol().asSent({1, 12344, 0.0126}).duration, 0.013, 1e-12);
}

}  // namespace
}  // namespace microinjection
