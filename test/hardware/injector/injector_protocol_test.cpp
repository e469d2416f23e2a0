#include "hardware/injector/injector_protocol.h"

#include <gtest/gtest.h>

#include <map>

#include "base/errors.h"
#include "hardware/injector/test_protocol.h"

namespace microinjection {
namespace {

TEST(InjectorProtocol, ConfigurationIsStrict) {
  for (const auto& [text, message] : std::map<std::string, std::string>{
           {"{}", "pulse is missing"},
           {"{pulse: []}", "must have at least one exchange"},
           {"{pulse: {send: P, expect: OK}}", "must be a list of maps"},
           {"{pulse: [{send: '', expect: OK}]}", "pulse/0/send = \"\": must not be empty"},
           {"{pulse: [{send: 'P{force}', expect: OK}]}", "{force} is not one of {pressure_Pa}"},
           {"{pulse: [{send: 'P{inject}', expect: OK}]}", "codes/inject is missing"},
           {"{codes: {inject: ''}, pulse: [{send: 'P{inject:3}', expect: OK}]}",
            "codes/inject = \"\": must be 3 letters"},
           {"{codes: {inject: 10}, pulse: [{send: 'P{inject:3}', expect: OK}]}",
            "codes/inject = 10: must be 3 letters"},
           {"{codes: {inject: '1.'}, pulse: [{send: 'P{inject:2}', expect: OK}]}", "must be 2 letters or digits"},
           {"{codes: {inject: ''}, pulse: [{send: P, expect: 'A{inject}'}]}", "codes/inject = \"\": must be letters"},
           {"{pulse: [{send: 'P{pressure_Pa:x}', expect: OK}]}", "the decimals, 0 to 9"},
           {"{pulse: [{send: 'P{pressure_Pa:12}', expect: OK}]}", "the decimals, 0 to 9"},
           {"{pulse: [{send: 'P{pressure_Pa', expect: OK}]}", "a { without its }"},
           {"{balance: [{send: '{duration_s}', expect: OK}]}", "{duration_s} is not one of"},
           {"{balance: [{send: 'P', expect: '('}]}", "is no regular expression"},
           {"{balance: [{send: 'P', expect: OK, confirm: pressure_Pa}]}", "must have a group"},
           {"{balance: [{send: 'P', expect: '(O)K', confirm: duration_s}]}", "must be one of: pressure_Pa"},
           {"{timed: true, pulse: [{send: P, expect: OK}]}", "needs stop"},
           {"{pulse: [{send: 'P{duration_s}', expect: OK}]}", "pulse_pressure is missing"},
           {"{pulse: [{send: 'P{pressure_Pa}', expect: OK}]}", "pulse_duration is missing"},
           {"{pulse_pressure: 1, pulse: [{send: 'P{pressure_Pa}', expect: OK}]}", "a line of pulse contains it"}}) {
    try {
      testProtocol(text);
      ADD_FAILURE() << text;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
}

TEST(InjectorProtocol, ANumberThatTheDeviceWouldTakeForAnotherIsRefused) {
  const InjectorProtocol protocol = testProtocol(
      "{pressure_unit: 200, largest: 255, refuse: E, pulse_duration: 1, pulse: [{send: '{pressure}', expect: OK}],"
      " balance: [{send: '{pressure}', expect: OK}]}");
  EXPECT_EQ(protocol.balanceRefusal(51e3), "");
  EXPECT_EQ(protocol.balanceRefusal(51.2e3), "balance pressure = 51200 Pa: 256 in the device's line, at most 255");
  EXPECT_EQ(protocol.refusal({1, 51e3, 1}), "");
  EXPECT_EQ(protocol.refusal({1, 51.2e3, 1}), "pulse pressure = 51200 Pa: 256 in the device's line, at most 255");
}

TEST(InjectorProtocol, AWholeLineIsConfirmedWithItsCount) {
  const InjectorProtocol protocol = testProtocol(
      "{refuse: E, pulse_pressure: 1, pulse_duration: 1, pulse: [{send: P, expect: OK}],"
      " balance: [{send: 'B{pressure_Pa}{count}', expect: 'heard (.*)', confirm: line}]}");
  InjectorProtocol::Values values = protocol.balanceValues(12);
  const auto misread = [&](const std::string& reply) {
    std::smatch groups;
    EXPECT_TRUE(std::regex_match(reply, groups, protocol.balance[0].expect));
    return InjectorProtocol::misread(protocol.balance[0], groups, values);
  };
  EXPECT_EQ(misread("heard B120"), "");
  values["count"] = 10;
  EXPECT_EQ(misread("heard B12A"), "");
  EXPECT_EQ(misread("heard B120"), "it has understood B120 instead of B12A");
}

/// A parameter server turns both \r and \r\n into \n, so a file that has them means another thing than it says.
TEST(InjectorProtocol, LineEndsAreNamesAndNoCharacters) {
  for (const auto& [text, message] : std::map<std::string, std::string>{
           {R"({terminator: "\r"})", "terminator = \\x0d: must be one of the names CR, LF, CRLF, and has a carriage"},
           {R"({terminator: "\r\n"})", "must be one of the names CR, LF, CRLF"},
           {R"({terminator: "\n"})", "and has a line feed (0x0A)"},
           {R"({terminator: ""})", "must be one of the names CR, LF, CRLF"},
           {R"({send_terminator: cr})", "send_terminator = cr: must be one of the names"},
           {R"({pulse: [{send: "P{pressure_Pa}\r", expect: OK}]})", "pulse/0/send"},
           {R"({pulse: [{send: "P{pressure_Pa}\r", expect: OK}]})", "a carriage return (0x0D)"},
           {R"({pulse: [{send: "P\x03", expect: OK}]})", "a control character (0x03)"},
           {R"({stop: [{send: S, expect: "OK\n"}]})", "stop/0/expect"},
           {R"({refuse: "ERR\n"})", "has a line feed (0x0A)"}}) {
    try {
      testProtocol(text);
      ADD_FAILURE() << text;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what() << message;
    }
  }
  const std::string base(kTestProtocol);
  EXPECT_EQ(testProtocol(base).framing.reply_end, "\r");
  EXPECT_EQ(testProtocol(base).framing.send_end, "\r");
  EXPECT_EQ(testProtocol(base + "send_terminator: CRLF\n").framing.send_end, "\r\n");
  EXPECT_EQ(testProtocol(base + "send_terminator: LF\n").framing.send_end, "\n");
}

std::string pulseLine(const std::string& text, const InjectionPulse& pulse) {
  const InjectorProtocol protocol = testProtocol(text);
  return protocol.pulse.back().send.fill(protocol.pulseValues(pulse));
}

std::string withPulse(const std::string& line) {
  std::string text(kTestProtocol);
  return text.replace(text.find("P{pressure_hPa:1} {duration_ms:0}"), 33, line);
}

TEST(InjectorProtocol, LinesHaveTheirUnitsAndDigits) {
  EXPECT_EQ(
      pulseLine(withPulse("{pressure_psi:4},{pressure_kPa:2},{pressure_Pa},{duration_s:3}"), {1, -6894.757293, 0.0125}),
      "-1.0000,-6.89,-6895,0.013");
  const InjectorProtocol protocol = testProtocol();
  EXPECT_EQ(protocol.balance[0].send.fill(protocol.balanceValues(-1)), "C0.0");  // no minus before a zero
  EXPECT_NEAR(protocol.asSent({1, 12344, 0.0126}).pressure, 12340, 1e-6);
  EXPECT_NEAR(protocol.asSent({1, 12344, 0.0126}).duration, 0.013, 1e-12);
}

TEST(InjectorProtocol, NumbersMayHaveLeadingZerosAndTheDevicesOwnUnit) {
  const std::string text =
      withPulse("#{pressure:06.3} {duration_s:05.1}") + "pressure_zero: -50.0e3\n";  // 100 Pa a unit
  EXPECT_EQ(pulseLine(text, {1, -49900, 1.26}), "#01.000 001.3");
  EXPECT_NEAR(testProtocol(text).asSent({1, -49890.04, 1}).pressure, -49890, 1e-6);
}

TEST(InjectorProtocol, WhatOnlyTheUserKnowsIsPutIn) {
  const std::string text = withPulse("C{inject:3}={pressure_Pa} {duration_s}") + "codes: {inject: \"012\"}\n";
  EXPECT_EQ(pulseLine(text, {1, 100, 1}), "C012=100 1");
  EXPECT_TRUE(
      std::regex_match("A012", testProtocol(text + "stop: [{send: S, expect: 'A{inject:3}'}]\n").stop[0].expect));
}

/// The digits of a line may make another pulse of one: a tenth is let through, more is refused by name.
TEST(InjectorProtocol, APulseThatTheLineCannotSayIsRefused) {
  const InjectorProtocol protocol = testProtocol();
  EXPECT_EQ(protocol.refusal({1, 12344, 0.0126}), "");
  EXPECT_EQ(protocol.refusal({1, 24, 0.1}), "pulse pressure = 24 Pa: the digits of the device's line make it 20 Pa");
  EXPECT_EQ(protocol.refusal({1, 1000, 1.4e-3}),
            "pulse duration = 0.0014 s: the digits of the device's line make it 0.001 s");
  EXPECT_EQ(protocol.balanceRefusal(4), "balance pressure = 4 Pa: the digits of the device's line make it 0 Pa");
  EXPECT_EQ(protocol.balanceRefusal(0), "");
}

TEST(InjectorProtocol, WhatNoLineSaysMustBeAsItIsSetAtTheDevice) {
  const InjectorProtocol protocol = testProtocol(withPulse("GO") + "pulse_pressure: 20.0e3\npulse_duration: 0.5\n");
  EXPECT_EQ(protocol.refusal({1, 20e3, 0.5}), "");
  EXPECT_EQ(protocol.refusal({1, 21e3, 0.5}), "pulse pressure = 21000 Pa: set by hand at the device, must be 20000 Pa");
  EXPECT_EQ(protocol.refusal({1, 20e3, 0.6}), "pulse duration = 0.6 s: set by hand at the device, must be 0.5 s");
}

}  // namespace
}  // namespace microinjection
