#include "hardware/serial/udp_wire.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <thread>

namespace microinjection {
namespace {

/// A device on this machine, which waits for what is sent to it.
class UdpDevice {
 public:
  UdpDevice() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    socklen_t size = sizeof address;
    EXPECT_EQ(getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    port_ = ntohs(address.sin_port);
  }
  ~UdpDevice() { leave(); }
  void leave() {
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
  }
  std::string path() const { return "udp:127.0.0.1:" + std::to_string(port_); }
  std::string hear() {
    char bytes[256];
    socklen_t size = sizeof from_;
    const ssize_t heard = recvfrom(socket_, bytes, sizeof bytes, 0, reinterpret_cast<sockaddr*>(&from_), &size);
    return heard < 0 ? "" : std::string(bytes, static_cast<std::size_t>(heard));
  }
  void say(const std::string& bytes) {
    sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&from_), sizeof from_);
  }

 private:
  int socket_;
  int port_ = 0;
  sockaddr_in from_{};
};

/// Only what hangs takes so long.
bool awaited(const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::yield();
  }
  return true;
}

TEST(UdpWire, ReadsItsAddress) {
  const auto address = UdpAddress::parse("udp:169.254.10.1:55555");
  ASSERT_TRUE(address);
  EXPECT_EQ(address->host, "169.254.10.1");
  EXPECT_EQ(address->port, 55555);
  for (const char* other : {"/dev/ttyUSB0", "udp:", "udp:169.254.10.1", "udp:host:55555", "udp:1.2.3.4:0",
                            "udp:1.2.3.4:70000", "udp:1.2.3:5", "udp:1.2.3.4:x"}) {
    EXPECT_FALSE(UdpAddress::parse(other)) << other;
  }
}

TEST(UdpWire, CarriesDatagramsBothWays) {
  UdpDevice device;
  UdpWire wire(*UdpAddress::parse(device.path()));
  EXPECT_FALSE(wire.isOpen());
  ASSERT_EQ(wire.open(), "");
  EXPECT_TRUE(wire.isOpen());
  EXPECT_EQ(wire.read(0), "");
  wire.write(std::string("\x10\0a", 3), 0);
  EXPECT_EQ(device.hear(), std::string("\x10\0a", 3));
  wire.write("b", 0);
  EXPECT_EQ(device.hear(), "b");
  device.say("one");
  device.say(std::string("\0two", 4));
  std::string heard;
  EXPECT_TRUE(awaited([&] { return (heard += wire.read(0)).size() == 7; }));
  EXPECT_EQ(heard, std::string("one\0two", 7));
}

/// The host of a device that is not there says so, and the line is closed and may be opened again.
TEST(UdpWire, ADeviceThatIsNotThereClosesIt) {
  UdpDevice device;
  UdpWire wire(*UdpAddress::parse(device.path()));
  ASSERT_EQ(wire.open(), "");
  device.leave();
  EXPECT_TRUE(awaited([&] {
    wire.write("a", 0);
    wire.read(0);
    return !wire.isOpen();
  }));
  EXPECT_EQ(wire.open(), "");
}

/// What a wire that was left open has promised to stop, its guard stops.
TEST(UdpWire, TheGuardStopsADeviceWhenTheProgramStandsStill) {
  UdpDevice device;
  UdpWire wire(*UdpAddress::parse(device.path()));
  wire.setGuardedStop("STOP");
  ASSERT_EQ(wire.open(), "");
  wire.heartbeat();
  EXPECT_EQ(device.hear(), "STOP") << "no further heartbeat";
  std::string intervention;
  EXPECT_TRUE(awaited([&] { return !(intervention = wire.heartbeat().intervention).empty(); }));
}

TEST(UdpWire, IsMadeForItsPathsOnly) {
  SerialPortConfig config;
  config.path = "udp:127.0.0.1:55555";
  EXPECT_NE(dynamic_cast<UdpWire*>(makeWire(config).get()), nullptr);
  config.path = "/dev/ttyUSB0";
  EXPECT_NE(dynamic_cast<SerialPort*>(makeWire(config).get()), nullptr);
}

}  // namespace
}  // namespace microinjection
