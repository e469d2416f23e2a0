#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hardware/serial/serial_port.h"
#include "hardware/serial/stop_guard.h"
#include "hardware/serial/wire.h"

namespace microinjection {

/// Where a device listens for datagrams.
struct UdpAddress {
  std::string host;  ///< a number such as 169.254.10.1, not a name: nothing waits for a name server
  int port = 0;

  /// Of "udp:HOST:PORT"; empty for any other text.
  static std::optional<UdpAddress> parse(const std::string& path);
};

/// Datagrams to and from one device over UDP, non-blocking. Each write() is a datagram; those that
/// were received are read one after another. Replies come to the port from which it sends. A
/// datagram may be lost; a device that is not there is told only by a host that answers for it.
/// Stops are guarded as those of a SerialPort are.
class UdpWire : public Wire {
 public:
  explicit UdpWire(UdpAddress address) : address_(std::move(address)) {}
  ~UdpWire() override { close(); }
  UdpWire(const UdpWire&) = delete;
  UdpWire& operator=(const UdpWire&) = delete;

  void setGuardedStop(const std::string& bytes) override { guarded_stop_ = bytes; }
  GuardReport heartbeat() override;
  std::string open() override;
  bool isOpen() const override { return socket_ >= 0; }
  std::string read(double time) override;
  void write(const std::string& bytes, double time) override;

 private:
  void close();

  UdpAddress address_;
  std::string guarded_stop_;
  int socket_ = -1;
  std::unique_ptr<StopGuard> guard_;
};

/// The wire to a configured device: "udp:HOST:PORT" as its path is a UdpWire, any other path a
/// SerialPort.
std::unique_ptr<Wire> makeWire(const SerialPortConfig& config);

}  // namespace microinjection
