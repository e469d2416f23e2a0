#include "hardware/sensor/volt_reading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>
#include <regex>

#include "hardware/sensor/serial_force_sensor.h"
#include "hardware/serial/scripted_wire.h"

namespace microinjection {
namespace {

VoltReadingConfig plain() {
  VoltReadingConfig config;
  config.voltage_range = {0, 5};
  config.matrix << 100e-6, 0, 5e-6, 200e-6;
  config.offset = Eigen::Vector2d(2.5, 2.25);
  return config;
}

std::string withChecksum(const std::string& body) {
  unsigned sum = 0;
  for (const unsigned char c : body) sum ^= c;
  char end[4];
  std::snprintf(end, sizeof end, "*%02X", sum);
  return body + end;
}

TEST(VoltReading, ReadsThePlainLineAndCalibratesIt) {
  const auto voltages = parseVoltages("3.5, 2.75\r", plain());
  ASSERT_TRUE(voltages);
  EXPECT_EQ(*voltages, Eigen::Vector2d(3.5, 2.75));
  EXPECT_LT((forceOfVoltages(*voltages, plain()) - Eigen::Vector2d(100e-6, 105e-6)).norm(), 1e-15);
  EXPECT_EQ((*parseVoltages("+1e-3,2.E0", plain()))[0], 1e-3);
}

TEST(VoltReading, RefusesEverythingElse) {
  for (const char* line :
       {"",     ",",     "1",   "1,",   ",1",   "1,2,3",    "1;2",      "1,nan",   "inf,1",   "0x1,1", "1,2 3",
        "1,2V", "1,--2", "1,.", ".5,1", "1,1e", "1,1e9999", "-0.001,1", "1,5.001", "1.2.3,1", "1,2\t", "1\n,2"}) {
    EXPECT_FALSE(parseVoltages(line, plain())) << "'" << line << "'";
  }
  EXPECT_FALSE(parseVoltages(std::string("1,2\0", 4), plain()));
}

TEST(VoltReading, FixedDigitsTellATruncatedNumber) {
  VoltReadingConfig config = plain();
  config.decimals = 4;
  EXPECT_TRUE(parseVoltages("1.2345,2.3456", config));
  EXPECT_FALSE(parseVoltages("1.2345,2.345", config));
  EXPECT_FALSE(parseVoltages("1.2345,2.34567", config));
  EXPECT_FALSE(parseVoltages("1,2", config));
}

TEST(VoltReading, PicksItsColumns) {
  VoltReadingConfig config = plain();
  config.columns = 4;
  config.first = 1;
  EXPECT_EQ(*parseVoltages("anything,1,2,ok", config), Eigen::Vector2d(1, 2));
}

TEST(VoltReading, ConfigurationIsStrict) {
  ConfigReader reader(YAML::Load("{separator: ',,', columns: 1, voltages: 2, matrix: [1, 2, 3]}"), "test");
  VoltReadingConfig::read(reader);
  try {
    reader.finish();
    FAIL();
  } catch (const std::exception& error) {
    for (const char* part : {"separator = ", "columns = 1: must hold", "matrix = ", "offset is missing"}) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << part << " in:\n" << error.what();
    }
  }
}

VoltReadingConfig configOf(const std::string& text) {
  ConfigReader reader(YAML::Load("{matrix: [1, 0, 0, 1], offset: [0, 0], " + text + "}"), "test");
  const VoltReadingConfig config = VoltReadingConfig::read(reader);
  reader.finish();
  return config;
}

/// A parameter server turns both \r and \r\n into \n.
TEST(VoltReading, LineEndsAndTabulatorsAreNames) {
  EXPECT_EQ(configOf("terminator: CRLF").terminator, "\r\n");
  EXPECT_EQ(configOf("terminator: CR").terminator, "\r");
  EXPECT_EQ(configOf("terminator: LF").terminator, "\n");
  EXPECT_EQ(configOf("columns: 2").terminator, "\n");
  EXPECT_EQ(*parseVoltages("1\t2", configOf("separator: TAB")), Eigen::Vector2d(1, 2));
  for (const char* raw : {R"(terminator: "\r\n")", R"(terminator: "\r")", R"(terminator: "\n")", R"(terminator: "")",
                          R"(separator: "\t")", R"(separator: "\r")"}) {
    EXPECT_THROW(configOf(raw), std::exception) << raw;
  }
}

/// One to three bytes dropped, changed or put in, or the end cut off.
std::string damaged(std::string line, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  if (below(4) == 0) return line.substr(0, below(line.size()));
  for (std::size_t n = 1 + below(3); n > 0 && !line.empty(); --n) {
    const std::size_t at = below(line.size());
    const char byte = static_cast<char>(below(2) == 0 ? "0123456789.,-+eE*\r "[below(19)] : below(256));
    switch (below(3)) {
      case 0:
        line.erase(at, 1);
        break;
      case 1:
        line[at] = byte;
        break;
      default:
        line.insert(at, 1, byte);
    }
  }
  return line;
}

TEST(VoltReading, ADamagedLineIsNeverMisread) {
  // An independent description of a good line; whatever is accepted must be one, and be read as the C library reads it.
  const std::regex good("( *[+-]?\\d+\\.\\d{4} *),( *[+-]?\\d+\\.\\d{4} *)\\r?");
  VoltReadingConfig config = plain();
  config.decimals = 4;
  std::mt19937 random(1);
  int accepted = 0;
  for (int i = 0; i < 100000; ++i) {
    const std::string line = damaged("1.2345,4.3210", random);
    const auto voltages = parseVoltages(line, config);
    if (!voltages) continue;
    ++accepted;
    std::smatch fields;
    ASSERT_TRUE(std::regex_match(line, fields, good)) << line;
    EXPECT_EQ((*voltages)[0], std::strtod(fields[1].str().c_str(), nullptr));
    EXPECT_EQ((*voltages)[1], std::strtod(fields[2].str().c_str(), nullptr));
  }
  EXPECT_GT(accepted, 100);  // digits turned into digits: only a checksum tells
}

TEST(VoltReading, WithAChecksumNoSingleErrorAndNoCutPasses) {
  VoltReadingConfig config = plain();
  config.checksum = "nmea";
  config.decimals = 4;
  const std::string line = withChecksum("1.2345,4.3210");
  ASSERT_TRUE(parseVoltages(line, config));
  for (std::size_t at = 0; at < line.size(); ++at) {
    EXPECT_FALSE(parseVoltages(line.substr(0, at), config));
    for (int byte = 0; byte < 256; ++byte) {
      std::string wrong = line;
      wrong[at] = static_cast<char>(byte);
      if (wrong != line) EXPECT_FALSE(parseVoltages(wrong, config)) << wrong;
    }
  }
}

class SerialForceSensorTest : public ::testing::Test {
 protected:
  SerialForceSensor make(const VoltReadingConfig& config = plain()) {
    return SerialForceSensor(std::make_unique<ScriptedWire>(script), config);
  }
  WireScript script;
};

TEST_F(SerialForceSensorTest, TheFirstLineMayBeTheEndOfOneAndIsSkipped) {
  SerialForceSensor sensor = make();
  script.incoming = "3.5,2.25\n";
  sensor.step(0);
  EXPECT_FALSE(sensor.reading());
  script.incoming = "3.5,2.2";
  sensor.step(1);
  EXPECT_FALSE(sensor.reading());
  script.incoming = "5\n";
  sensor.step(2);
  ASSERT_TRUE(sensor.reading());
  EXPECT_NEAR(sensor.reading()->force[0], 100e-6, 1e-12);
  EXPECT_EQ(sensor.reading()->time, 2);
  EXPECT_FALSE(sensor.reading()->saturated);
}

TEST_F(SerialForceSensorTest, CountsAndSkipsBadLines) {
  SerialForceSensor sensor = make();
  script.incoming = "\n3.5,2.25\n3.5;2.25\n9,9\n";
  sensor.step(0);
  EXPECT_EQ(sensor.goodLines(), 1U);
  EXPECT_EQ(sensor.badLines(), 2U);
  EXPECT_NEAR(sensor.reading()->force[0], 100e-6, 1e-12);
}

TEST_F(SerialForceSensorTest, OpensAgainAfterTheLineBroke) {
  script.refusal = "no such device";
  SerialForceSensor sensor = make();
  sensor.step(0);
  EXPECT_EQ(sensor.errorText(), "no such device");
  script.refusal.clear();
  sensor.step(0.5);
  EXPECT_EQ(script.opened, 0);  // once a second
  script.incoming = "\n3.5,2.25\n";
  sensor.step(1.5);
  EXPECT_EQ(sensor.errorText(), "");
  EXPECT_TRUE(sensor.reading());
  script.open = false;
  sensor.step(1.6);
  EXPECT_FALSE(sensor.reading());
  EXPECT_EQ(sensor.errorText(), "the line broke");
  script.incoming = "5,2.25\n3.5,5\n";  // the rest of 2.5,2.25
  sensor.step(3);
  EXPECT_EQ(sensor.goodLines(), 2U);
  EXPECT_TRUE(sensor.reading()->saturated);
}

TEST_F(SerialForceSensorTest, RandomBytesDoNoHarmAndItFindsBackIntoStep) {
  VoltReadingConfig config = plain();
  config.checksum = "nmea";
  config.decimals = 4;
  SerialForceSensor sensor = make(config);
  const std::string line = withChecksum("3.5000,2.2500") + "\n";
  std::mt19937 random(2);
  script.incoming = "\n";
  sensor.step(0);
  for (int i = 1; i <= 100000; ++i) {
    for (std::size_t n = random() % 40; n > 0; --n) script.incoming += static_cast<char>(random());
    script.incoming += "\n" + line;
    sensor.step(i);
    ASSERT_EQ(sensor.goodLines(), static_cast<unsigned>(i));  // that line, and none of the noise
    ASSERT_EQ(sensor.reading()->time, i);
    ASSERT_NEAR(sensor.reading()->force[0], 100e-6, 1e-12);
  }
  EXPECT_GT(sensor.badLines(), 50000U);
}

}  // namespace
}  // namespace microinjection
