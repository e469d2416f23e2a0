// The emulated uMp against what the maker's SDK and its Python client send and expect; its driver plays no part.

#include "hardware/devices/sensapex/sensapex_emulator.h"

#include <gtest/gtest.h>

#include "base/errors.h"
#include "hardware/devices/line_client.h"

namespace microinjection {
namespace {

std::string hexOf(const std::string& bytes) {
  std::string text;
  for (const char each : bytes) {
    char two[4];
    std::snprintf(two, sizeof two, "%02x", static_cast<unsigned char>(each));
    text += two;
  }
  return text;
}

std::string bytesOfHex(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes += static_cast<char>(std::stoi(text.substr(i, 2), nullptr, 16));
  return bytes;
}

/// Datagrams as libum builds them: version and extra, receiver, sender 0x29b, number, options, type, blocks.
struct SensapexClient : LineClient {
  explicit SensapexClient(const SensapexEmulatorConfig& config = {})
      : SensapexClient(std::make_shared<SensapexEmulator>(config)) {}
  std::shared_ptr<SensapexEmulator> device;
  std::string asks(const std::string& message, double patience = 0.2) {
    return hexOf(answers(bytesOfHex(message), patience));
  }

 private:
  explicit SensapexClient(const std::shared_ptr<SensapexEmulator>& emulator)
      : LineClient(emulator, 4e6), device(emulator) {}
};

const std::string kToDevice =
    "1000"
    "0001"
    "029b";
const std::string kToClient =
    "1000"
    "029b"
    "0001";

TEST(SensapexEmulator, AnswersAPing) {
  SensapexClient client;
  EXPECT_EQ(client.asks(kToDevice + "0001"
                                    "00000011"
                                    "0000"
                                    "0000"),
            kToClient +
                "0001"
                "00000002"
                "0000"
                "0000");
}

/// um_get_axis_count and um_get_positions want an acknowledgement and a response.
TEST(SensapexEmulator, TellsItsAxesAndPositions) {
  for (const int axes : {3, 4}) {
    SensapexEmulatorConfig config;
    config.axes = axes;
    SensapexClient client(config);
    const std::string count = axes == 3 ? "00000003" : "00000004";
    EXPECT_EQ(client.asks(kToDevice + "0007"
                                      "00000031"
                                      "0010"
                                      "0001"
                                      "0006"
                                      "0001"
                                      "00000105"),
              kToClient +
                  "0007"
                  "00000002"
                  "0010"
                  "0000" +
                  kToClient +
                  "0007"
                  "00000000"
                  "0010"
                  "0001"
                  "0006"
                  "0002"
                  "00000105" +
                  count);
    client.device->shiftByHand({1e-6, -1e-6, 2e-6});
    const std::string fourth = axes == 3 ? "" : "00000000";
    EXPECT_EQ(client.asks(kToDevice + "0008"
                                      "00000021"
                                      "000e"
                                      "0000"),
              kToClient +
                  "0008"
                  "00000000"
                  "000e"
                  "0001"
                  "0006" +
                  (axes == 3 ? "0003" : "0004") +
                  "000003e8"
                  "fffffc18"
                  "000007d0" +
                  fourth);
  }
}

/// um_goto_position: x = 1000 um, the others stay, 500 um/s; the end is told to who asked for it.
TEST(SensapexEmulator, GoesToAPositionAndTellsItsEnd) {
  SensapexClient client;
  const std::string undefined = "7fffffff";
  EXPECT_EQ(client.asks(kToDevice +
                            "0001"
                            "00000051"
                            "0021"
                            "0001"
                            "0006"
                            "0005"
                            "000f4240" +
                            undefined + undefined + undefined + "000001f4",
                        1),
            kToClient +
                "0001"
                "00000002"
                "0021"
                "0000");
  EXPECT_TRUE(client.device->moves());
  EXPECT_NEAR(client.device->position().x(), 0.5e-3, 2e-6);
  EXPECT_EQ(hexOf(client.receive(1.2)), kToClient +
                                            "0001"
                                            "00000004"
                                            "0068"
                                            "0001"
                                            "0006"
                                            "0001"
                                            "00000000");
  EXPECT_NEAR((client.device->position() - Eigen::Vector3d(1e-3, 0, 0)).norm(), 0, 1e-12);
}

/// um_goto_position_ext: speeds of the axes in a second block, below 1 um/s in negative nm/s.
TEST(SensapexEmulator, AxesHaveSpeedsOfTheirOwn) {
  SensapexClient client;
  EXPECT_EQ(client.asks(kToDevice + "0001"
                                    "00000011"
                                    "0021"
                                    "0002"
                                    "0006"
                                    "0006"
                                    "000003e8"
                                    "000007d0"
                                    "00000064"
                                    "7fffffff"
                                    "00000002"
                                    "00000001"
                                    "0006"
                                    "0003"
                                    "00000001"
                                    "00000002"
                                    "ffffff9c",
                        0.51),
            kToClient +
                "0001"
                "00000002"
                "0021"
                "0000");
  EXPECT_NEAR(client.device->position().x(), 0.5e-6, 0.02e-6);
  EXPECT_NEAR(client.device->position().y(), 1e-6, 0.02e-6);
  EXPECT_NEAR(client.device->position().z(), 0.05e-6, 0.002e-6);
  client.receive(1);
  EXPECT_FALSE(client.device->moves());
}

TEST(SensapexEmulator, OneAxisAfterAnotherWithoutTheMode) {
  SensapexClient client;
  client.asks(kToDevice +
                  "0001"
                  "00000011"
                  "0021"
                  "0001"
                  "0006"
                  "0005"
                  "000f4240"
                  "000f4240"
                  "00000000"
                  "7fffffff"
                  "000003e8",
              0.5);
  EXPECT_GT(client.device->position().x(), 0.4e-3);
  EXPECT_EQ(client.device->position().y(), 0);
}

TEST(SensapexEmulator, StopsAndRefusesWhatItCannotDo) {
  SensapexClient client;
  const std::string go =
      "0021"
      "0001"
      "0006"
      "0003"
      "000f4240"
      "00000000"
      "00000000";
  client.asks(kToDevice +
                  "0001"
                  "00000011" +
                  go,
              0.1);
  ASSERT_TRUE(client.device->moves());
  EXPECT_EQ(client.asks(kToDevice +
                            "0002"
                            "00000011" +
                            go,
                        0.1),
            kToClient +
                "0002"
                "0000000a"
                "0021"
                "0000")
      << "it moves";
  EXPECT_EQ(client.asks(kToDevice + "0003"
                                    "00000011"
                                    "0001"
                                    "0000"),
            kToClient +
                "0003"
                "00000002"
                "0001"
                "0000");
  EXPECT_FALSE(client.device->moves());
  EXPECT_EQ(client.asks(kToDevice + "0004"
                                    "00000021"
                                    "004d"
                                    "0000"),
            kToClient +
                "0004"
                "00000008"
                "004d"
                "0000");
  client.device->inject(parseFault("error:1"));
  EXPECT_EQ(client.asks(kToDevice + "0005"
                                    "00000021"
                                    "000e"
                                    "0000"),
            kToClient +
                "0005"
                "00000008"
                "000e"
                "0000");
  EXPECT_EQ(client.asks("1000"
                        "0002"
                        "029b"
                        "0006"
                        "00000011"
                        "0000"
                        "0000"),
            "")
      << "another device";
  EXPECT_EQ(client.asks("2000"
                        "0001"
                        "029b"
                        "0007"
                        "00000011"
                        "0000"
                        "0000"),
            "")
      << "another version";
  EXPECT_THROW(client.device->inject(parseFault("error:x")), ConfigError);
}

TEST(SensapexEmulator, SaysHelloAndCountsFromZeroWhereItIsSwitchedOn) {
  SensapexClient client;
  client.device->shiftByHand({1e-6, 0, 0});
  client.device->inject(parseFault("error:RESET"));
  EXPECT_EQ(hexOf(client.receive(0.1)),
            "1000"
            "03ff"
            "0001"
            "0001"
            "00000004"
            "0064"
            "0000");
  EXPECT_EQ(client.device->position().norm(), 0);
}

}  // namespace
}  // namespace microinjection
