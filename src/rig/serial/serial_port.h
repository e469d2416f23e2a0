#pragma once

#include <sys/types.h>

#include <memory>
#include <string>

#include "base/config_reader.h"
#include "rig/serial/wire.h"

namespace microinjection {

struct SerialPortConfig {
  std::string path;             ///< of the serial device, or of a link to one, e.g. /dev/ttyUSB0
  int baud = 9600;              ///< bit/s; 8 data bits
  std::string parity = "none";  ///< none, even or odd
  int stop_bits = 1;            ///< 1 or 2
  /// none; rts_cts: RTS and CTS hold the sender back, so without the wires in the cable nothing is sent, not even a
  /// stop
  std::string handshake = "none";

  std::string frame() const;  ///< as data sheets write it, e.g. 8N1

  /// Requires `path`; the others are optional.
  static SerialPortConfig read(ConfigReader& reader, int default_baud);
};

/// A serial device, or a pseudo-terminal, without waiting. A pulled cable (hang-up, input/output error) closes it.
///
/// Boost.Asio does the work: libserialport 0.1.1 looks ports up in /sys and so refuses pseudo-terminals and links.
class SerialPort : public Wire {
 public:
  explicit SerialPort(const SerialPortConfig& config);
  ~SerialPort() override;

  void setGuardedStop(const std::string& bytes) override { guarded_stop_ = bytes; }
  GuardReport heartbeat() override;
  std::string open() override;  ///< what came while nobody listened is thrown away
  bool isOpen() const override;
  std::string read(double time) override;
  void write(const std::string& bytes, double time) override;

  pid_t guardProcess() const;  ///< of the stop guard; -1: there is none

 private:
  struct Line;  // Asio's headers are heavy
  SerialPortConfig config_;
  std::string guarded_stop_;
  std::unique_ptr<Line> line_;  // none: closed
};

}  // namespace microinjection
