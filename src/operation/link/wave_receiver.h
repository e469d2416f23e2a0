#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "base/config_reader.h"
#include "operation/link/link_packet.h"

namespace microinjection {

/// Jitter buffer: plays the integral U of a wave u (sqrt(W)) and its energy E = int u^2/2 dt (J)
/// from the packets, one period of the sender for each of the receiver. Lost packets are
/// interpolated: u = (U_2 - U_1) / (t_2 - t_1) has the right integral and, by Cauchy and Schwarz,
/// no more energy than was sent. Jitter delays the playout: when the packet of a period is missing,
/// the playout waits, and all later periods are delayed, too. A delay that was not needed for a
/// second is slowly removed. Allocates no memory.
class WavePlayout {
 public:
  struct Advance {
    Eigen::Vector3d integral = Eigen::Vector3d::Zero();  ///< sqrt(W) s, of this period
    double energy = 0;                                   ///< J, of this period
    bool underrun = false;                               ///< no packet came in time
  };

  void reset() { *this = WavePlayout(); }
  /// The sender begins with U = E = 0 before its packet 1. A receiver that misses its first kLength
  /// packets never begins.
  void receive(const TeleoperationPacket& packet);
  /// Empty before the first packet.
  std::optional<Advance> advance();
  std::uint64_t newest() const { return newest_; }  ///< sequence
  /// Periods that are not played yet.
  double buffered() const { return static_cast<double>(newest_) - playout_position_; }

 private:
  static constexpr int kLength = 2048;    // periods
  static constexpr int kObserved = 1000;  // periods, whose smallest buffer is the unneeded delay
  struct Sent {
    std::uint64_t sequence = 0;  // 0: none
    Eigen::Vector3d integral = Eigen::Vector3d::Zero();
    double energy = 0;
  };
  Sent at(double sequence) const;

  std::array<Sent, kLength> sent_;
  std::uint64_t newest_ = 0;
  double playout_position_ = 0;
  Sent last_;
  int observed_ = 0;                  // periods
  double smallest_buffer_ = kLength;  // periods
  double catch_up_ = 0;               // additional periods played per period
};

struct WaveReceiverConfig {
  double filter_time = 10e-3;    ///< s, of the low-pass that removes the network's ripple from a wave
  double highpass_loss = 0.1;    ///< 1, share of each change that is removed, see WaveReceiver
  double correction_time = 0.1;  ///< s, time in which the integral returns to the sender's
  double reserve = 2.5e-4;       ///< J, energy that may leave before any entered

  /// The keys of the same names.
  static WaveReceiverConfig read(ConfigReader& reader);
};

/// The wave at the receiving end of the channel. It is played and filtered, keeps its integral, and
/// never has more energy than entered plus the reserve. The filter's gain is one at rest and less
/// elsewhere: a held force passes undiminished, and the filter only removes energy. Between a
/// resting hand and a stiff body waves would travel back and forth; `highpass_loss` removes its
/// share of every change in each pass, through a low-pass of one round trip's time, at the price of
/// that share of a round trip as delay. While packets are late, the wave is held: half of the
/// reserve pays for it. The other half pays for correcting an excess of the integral, also when no
/// more packets come.
class WaveReceiver {
 public:
  explicit WaveReceiver(const WaveReceiverConfig& config) : config_(config) { reset(); }

  void reset();
  void receive(const TeleoperationPacket& packet) { playout_.receive(packet); }
  /// Returns the wave (sqrt(W)) for the next period dt (s), with the `round_trip` (s) of a packet.
  const Eigen::Vector3d& step(double round_trip, double dt);
  double margin() const { return in_ - out_; }             ///< J, energy in less energy out; at least -reserve
  double buffered() const { return playout_.buffered(); }  ///< periods
  std::uint64_t newest() const { return playout_.newest(); }

 private:
  WaveReceiverConfig config_;
  WavePlayout playout_;
  Eigen::Vector3d slow_, filtered_, wave_;     // sqrt(W)
  Eigen::Vector3d wanted_, emitted_integral_;  // sqrt(W) s
  double in_ = 0, out_ = 0, credit_ = 0;       // J
};

}  // namespace microinjection
