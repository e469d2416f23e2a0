#include "hardware/serial/udp_wire.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/parse_number.h"

namespace microinjection {
namespace {

constexpr char kScheme[] = "udp:";
constexpr std::size_t kLargestDatagram = 65536;  // bytes

bool toSocketAddress(const UdpAddress& address, sockaddr_in& result) {
  std::memset(&result, 0, sizeof result);
  result.sin_family = AF_INET;
  result.sin_port = htons(static_cast<std::uint16_t>(address.port));
  return inet_pton(AF_INET, address.host.c_str(), &result.sin_addr) == 1;
}

}  // namespace

std::optional<UdpAddress> UdpAddress::parse(const std::string& path) {
  const std::size_t scheme = sizeof kScheme - 1, colon = path.rfind(':');
  if (path.compare(0, scheme, kScheme) != 0 || colon < scheme) return std::nullopt;
  const auto port = parseNumber<int>(path.substr(colon + 1));
  UdpAddress address{path.substr(scheme, colon - scheme), port.value_or(0)};
  sockaddr_in unused;
  if (address.port < 1 || address.port > 65535 || !toSocketAddress(address, unused)) return std::nullopt;
  return address;
}

std::string UdpWire::open() {
  close();
  const std::string name = kScheme + address_.host + ":" + std::to_string(address_.port) + ": ";
  sockaddr_in device;
  toSocketAddress(address_, device);
  socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (socket_ < 0 || connect(socket_, reinterpret_cast<const sockaddr*>(&device), sizeof device) != 0) {
    const std::string reason = name + std::strerror(errno);
    close();
    return reason;
  }
  if (guarded_stop_.empty()) return "";
  guard_ = std::make_unique<StopGuard>();
  const std::string reason = guard_->begin(socket_, guarded_stop_);
  if (reason.empty()) return "";
  close();
  return name + "no stop guard: " + reason;
}

void UdpWire::close() {
  guard_.reset();
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

Wire::GuardReport UdpWire::heartbeat() { return guard_ ? guard_->heartbeat() : GuardReport{}; }

std::string UdpWire::read(double /*time*/) {
  std::string received;
  std::string datagram(kLargestDatagram, '\0');
  while (socket_ >= 0) {
    const ssize_t size = recv(socket_, datagram.data(), datagram.size(), 0);
    if (size >= 0) {
      received.append(datagram, 0, static_cast<std::size_t>(size));
    } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
      break;
    } else if (errno != EINTR) {
      close();  // nobody listens there, or the network is down
    }
  }
  return received;
}

void UdpWire::write(const std::string& bytes, double /*time*/) {
  if (socket_ < 0 || (guard_ && bytes != guarded_stop_ && guard_->intervened())) return;
  const ssize_t sent = send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) close();
}

std::unique_ptr<Wire> makeWire(const SerialPortConfig& config) {
  if (const auto address = UdpAddress::parse(config.path)) return std::make_unique<UdpWire>(*address);
  return std::make_unique<SerialPort>(config);
}

}  // namespace microinjection
