#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace microinjection {

/// Sensapex's micromanipulator control protocol (SMCP 1.0) of the uMp-3 and uMp-4, from the maker's
/// public SDK (sensapex/umsdk, smcp1.h and libum.c): datagrams over UDP, port 55555, all numbers with
/// their high byte first.
///
///     bytes  0 version 0x10 | 1 extra | 2-3 receiver | 4-5 sender | 6-7 message
///            8-11 options   | 12-13 type             | 14-15 number of blocks
///     block  0-1 type of its data (6: 32-bit integers) | 2-3 how many | data
///
/// Positions are in nm. A speed is in um/s, or if it is negative in nm/s (libum sends speeds below
/// 1 um/s so). A request has a number, which its reply repeats: either an acknowledgement, which is
/// a header only ("received and understood"), or a response with data.
///
/// Not verified on a device: that speeds of axes in a second block keep it on a straight line, the
/// ramps, the noise of its positions, what it counts from after it was switched on, and that it says
/// HELLO then.
struct SensapexMessage {
  /// SMCP1_CMD_..., SMCP1_GET_..., SMCP1_NOTIFY_...
  enum Type : std::uint16_t { kStop = 1, kGetPositions = 14, kGetParameter = 16, kGoTo = 33, kHello = 100 };
  /// SMCP1_OPT_...
  enum Option : std::uint32_t {
    kRequest = 0x01,
    kAcknowledgement = 0x02,
    kNotification = 0x04,
    kError = 0x08,
    kWantsAcknowledgement = 0x10,
    kWantsResponse = 0x20
  };
  static constexpr std::int32_t kAxisCount = 0x105;      ///< parameter: number of axes
  static constexpr std::int32_t kUndefined = INT32_MAX;  ///< of a position: this axis is not moved
  static constexpr std::int32_t kSimultaneous = 1;       ///< of a go-to: all axes at once
  static constexpr std::uint16_t kPc = 0x29b;            ///< a number of a program, above 0x200

  std::uint16_t receiver = 0, sender = 0, number = 0, type = 0;
  std::uint32_t options = 0;
  std::vector<std::vector<std::int32_t>> blocks{};

  bool has(Option option) const { return (options & option) != 0; }
};

std::string sensapexBytes(const SensapexMessage& message);

/// Extracts the messages of a device to a program from received bytes. Others are skipped until the
/// next header.
class SensapexParser {
 public:
  explicit SensapexParser(std::uint16_t device) : device_(device) {}

  std::vector<SensapexMessage> feed(const std::string& bytes, double time);  ///< s
  /// Groups of bytes that were no message of the device.
  int malformed() const { return malformed_; }

 private:
  enum class Fit { kNo, kMaybe, kYes };
  Fit fit() const;
  std::optional<std::size_t> size() const;

  std::uint16_t device_;
  std::string bytes_;
  double last_ = 0;  // s, of the last byte
  bool skipping_ = false;
  int malformed_ = 0;
};

}  // namespace microinjection
