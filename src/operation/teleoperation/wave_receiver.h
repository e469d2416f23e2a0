#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "base/config_reader.h"
#include "operation/teleoperation/teleoperation_packet.h"

namespace microinjection {

/// The integral U of a wave u (sqrt(W)) and its energy E = int u^2/2 dt (J) as packets tell them, played one period of
/// the sender's for each of the receiver's. What is lost is interpolated: u = (U_2 - U_1) / (t_2 - t_1) has the right
/// integral and by Cauchy and Schwarz no more energy than what was sent. Jitter is taken up by playing late: a period
/// for which the packet has not come waits, and everything after it is that much later; what was never needed of that
/// for a second is played off slowly. Allocates nothing.
class WavePlayout {
 public:
  struct Advance {
    Eigen::Vector3d integral = Eigen::Vector3d::Zero();  ///< sqrt(W) s, since the period before
    double energy = 0;                                   ///< J, since the period before
    bool waits = false;                                  ///< nothing came in time
  };

  void reset() { *this = WavePlayout(); }
  /// The sender begins with U = E = 0 before its packet 1; who has heard none of its first kLength never begins.
  void receive(const TeleoperationPacket& packet);
  /// Empty before the first packet.
  std::optional<Advance> advance();
  std::uint64_t newest() const { return newest_; }  ///< sequence
  double buffered() const {
    return static_cast<double>(newest_) - playout_position_;
  }  ///< periods that wait to be played

 private:
  static constexpr int kLength = 2048;    // periods
  static constexpr int kObserved = 1000;  // periods, whose least buffer tells how much of it is not needed
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
  int observed_ = 0;        // periods
  double least_ = kLength;  // periods, buffered
  double faster_ = 0;       // 1
};

struct WaveReceiverConfig {
  double filter_time = 10e-3;    ///< s, of the low-pass that takes the ripple of the network off a wave
  double highpass_loss = 0.1;    ///< 1, share of a wave that passes a low-pass of one round trip's time
  double correction_time = 0.1;  ///< s, within which the integral is brought back to that of the sender
  double reserve = 2.5e-4;       ///< J, what may come out before anything went in

  /// The keys of the same names.
  static WaveReceiverConfig read(ConfigReader& reader);
};

/// A wave as it comes out of the channel: played, filtered, its integral kept, and never with more energy than came in
/// plus the reserve. The filter's gain is one at rest and nowhere more, so a force that is held passes undiminished and
/// the filter takes energy out only. Between a hand that stands and a stiff thing waves would go to and fro: the
/// `highpass_loss` takes its share of every change off in each pass, at the price of that share of a round trip as
/// delay. While packets are late the wave is held, which half of the reserve pays for; the other half is for giving
/// back what was too much of its integral, also when nothing more comes.
class WaveReceiver {
 public:
  explicit WaveReceiver(const WaveReceiverConfig& config) : config_(config) { reset(); }

  void reset();
  void receive(const TeleoperationPacket& packet) { playout_.receive(packet); }
  /// The wave (sqrt(W)) for the next period of dt (s); `round_trip` (s) of a packet.
  const Eigen::Vector3d& step(double round_trip, double dt);
  double margin() const { return in_ - out_; }             ///< J, played less let out; at least -reserve
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
