#include "hardware/serial/serial_port.h"

#include <sys/file.h>
#include <termios.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/serial_port.hpp>
#include <boost/asio/write.hpp>
#include <cerrno>
#include <cstring>

#include "hardware/serial/line_mode.h"
#include "hardware/serial/stop_guard.h"

namespace microinjection {

namespace asio = boost::asio;
using boost::system::error_code;

SerialPortConfig SerialPortConfig::read(ConfigReader& reader, int default_baud) {
  SerialPortConfig config;
  config.baud = default_baud;
  reader.text("path", config.path, ConfigReader::kRequired);
  reader.integer("baud", config.baud, Range::positive());
  reader.choice("parity", config.parity, {"none", "even", "odd"});
  reader.integer("stop_bits", config.stop_bits, Range::closed(1, 2));
  reader.choice("handshake", config.handshake, {"none", "rts_cts"});
  return config;
}

std::string SerialPortConfig::frame() const {
  return std::string("8") + (parity == "even" ? "E" : parity == "odd" ? "O" : "N") + std::to_string(stop_bits);
}

/// Handlers run only in `context.poll()`, and so in the caller's thread.
struct SerialPort::Line {
  static constexpr std::size_t kMostUnsent = 1 << 16;  // bytes; a device that accepts none for so long is lost

  asio::io_context context{1};
  asio::serial_port port{context};
  std::array<char, 4096> buffer;
  std::string received;
  std::string unsent;   // not yet passed to the system
  std::string sending;  // must not move while it is being sent
  bool broken = false;
  StopGuard stop_guard;

  std::string open(const SerialPortConfig& config) {
    error_code error;
    port.open(config.path, error);
    if (error) return config.path + ": " + error.message();
    // Two programs on one line would corrupt each other's messages. Unlike TIOCEXCL, the lock ends
    // with the program.
    if (flock(port.native_handle(), LOCK_EX | LOCK_NB) != 0) return config.path + ": in use by another program";
    using Port = asio::serial_port_base;
    const auto set = [&](const auto& option) {
      if (!error) port.set_option(option, error);
    };
    set(Port::baud_rate(static_cast<unsigned>(config.baud)));
    set(Port::character_size(8));
    set(Port::parity(config.parity == "even"  ? Port::parity::even
                     : config.parity == "odd" ? Port::parity::odd
                                              : Port::parity::none));
    set(Port::stop_bits(config.stop_bits == 2 ? Port::stop_bits::two : Port::stop_bits::one));
    const bool hardware = config.handshake == "rts_cts";
    set(Port::flow_control(hardware ? Port::flow_control::hardware : Port::flow_control::none));
    if (error)
      return config.path + ": " + std::to_string(config.baud) + " baud, " + config.frame() + ": " + error.message();
    termios mode{};
    if (tcgetattr(port.native_handle(), &mode) != 0) return config.path + ": " + std::strerror(errno);
    if (const std::string changes = whatChangesBytes(mode); !changes.empty())
      return config.path + ": the system keeps a mode that changes bytes: " + changes;
    requestLowLatency(port.native_handle());
    tcflush(port.native_handle(), TCIFLUSH);
    receive();
    return "";
  }

  void receive() {
    port.async_read_some(asio::buffer(buffer), [this](const error_code& error, std::size_t size) {
      received.append(buffer.data(), size);
      if (error) {
        broken = true;
      } else {
        receive();
      }
    });
  }

  void send() {
    if (!sending.empty() || unsent.empty()) return;
    sending.swap(unsent);
    asio::async_write(port, asio::buffer(sending), [this](const error_code& error, std::size_t) {
      sending.clear();
      if (error) broken = true;
      if (!broken) send();
    });
  }

  void poll() {
    context.poll();
    if (context.stopped()) context.restart();
  }
};

SerialPort::SerialPort(const SerialPortConfig& config) : config_(config) {}
SerialPort::~SerialPort() = default;

/// heartbeat() tells when there is no guard.
void SerialPort::setGuardedStop(const std::string& bytes) {
  guarded_stop_ = bytes;
  if (line_ && !bytes.empty()) line_->stop_guard.begin(line_->port.native_handle(), bytes, stops_apart_);
}

void SerialPort::leaveToGuard() {
  if (line_) line_->stop_guard.leave();
  line_.reset();
}

std::string SerialPort::open() {
  line_ = std::make_unique<Line>();
  std::string reason = line_->open(config_);
  if (reason.empty() && !guarded_stop_.empty()) {
    reason = line_->stop_guard.begin(line_->port.native_handle(), guarded_stop_, stops_apart_);
    if (!reason.empty()) reason = config_.path + ": no stop guard: " + reason;
  }
  if (!reason.empty()) line_.reset();
  return reason;
}

bool SerialPort::isOpen() const { return line_ != nullptr; }

pid_t SerialPort::guardProcess() const { return line_ ? line_->stop_guard.process() : -1; }

Wire::GuardReport SerialPort::heartbeat() {
  if (!line_ || guarded_stop_.empty()) return {};
  GuardReport report = line_->stop_guard.heartbeat();
  if (!report.intervention.empty())
    line_->unsent.clear();  // a partly sent message is completed, so that the device understands the stop
  return report;
}

std::string SerialPort::read(double /*time*/) {
  if (!line_) return "";
  line_->poll();
  std::string result;
  result.swap(line_->received);
  if (line_->broken) line_.reset();
  return result;
}

void SerialPort::write(const std::string& bytes, double /*time*/) {
  if (!line_) return;
  // A program that resumes in the middle of a step must not restart a device that the guard has
  // stopped.
  if (!guarded_stop_.empty() && bytes != guarded_stop_ && line_->stop_guard.intervened()) return;
  line_->unsent += bytes;
  line_->send();
  line_->poll();
  if (line_->unsent.size() > Line::kMostUnsent) line_->broken = true;
  if (line_->broken && line_->received.empty()) line_.reset();
}

}  // namespace microinjection
