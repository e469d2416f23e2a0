#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

#include "base/config_reader.h"
#include "hardware/serial/wire.h"

namespace microinjection {

struct SerialPortConfig {
  std::string path;             ///< of the serial device or a link to it, e.g. /dev/ttyUSB0
  int baud = 9600;              ///< bit/s; 8 data bits
  std::string parity = "none";  ///< none, even or odd
  int stop_bits = 1;            ///< 1 or 2
  /// none or rts_cts. With rts_cts nothing is sent without these wires in the cable, not even a
  /// stop.
  std::string handshake = "none";

  std::string frame() const;  ///< as in data sheets, e.g. 8N1

  /// Requires `path`; the others are optional.
  static SerialPortConfig read(ConfigReader& reader, int default_baud);
};

/// A serial device or pseudo-terminal, non-blocking. A disconnected cable (hang-up, input/output
/// error) closes it.
///
/// It uses Boost.Asio, because libserialport 0.1.1 searches ports in /sys and so rejects
/// pseudo-terminals and links.
class SerialPort : public Wire {
 public:
  explicit SerialPort(const SerialPortConfig& config);
  ~SerialPort() override;

  void setGuardedStop(const std::string& bytes) override;
  void setStopsApart(double apart) override { stops_apart_ = apart; }
  void leaveToGuard() override;
  GuardReport heartbeat() override;
  std::string open() override;  ///< discards bytes received before
  bool isOpen() const override;
  std::string read(double time) override;
  void write(const std::string& bytes, double time) override;

  pid_t guardProcess() const;  ///< of the stop guard; -1: none

 private:
  struct Line;  // hides Asio's large headers
  SerialPortConfig config_;
  std::string guarded_stop_;
  double stops_apart_ = 0;      // s
  std::unique_ptr<Line> line_;  // null: closed
};

}  // namespace microinjection
