#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "hardware/devices/manipulator_emulator.h"

namespace microinjection {

struct SensapexEmulatorConfig {
  int device = 1;             ///< its number in the network
  int axes = 3;               ///< 3 or 4
  double travel = 10e-3;      ///< m, from 0 to each end
  double answer_time = 1e-3;  ///< s, from the end of a request to its reply
  double jitter = 0;          ///< m, by which positions at rest differ
};

/// Emulates a Sensapex uMp-3 or uMp-4. It is based on the maker's SDK (smcp1.h and libum.c of
/// sensapex/umsdk) and its Python client, not on the driver: PING, STOP, GET_VERSION, GET_PARAMETER
/// (number of axes), GET_POSITIONS and GOTO_POS with one speed or one for each axis, together or one
/// axis after another; acknowledgements, responses, the notifications of a position, of the end of a
/// drive and HELLO. A request of something else gets an error.
///
/// Assumed: constant speeds without ramps; it counts from 0 where it was switched on, and says HELLO
/// then; a go-to while moving is an error. An injected error answers the next request, which is not
/// executed.
class SensapexEmulator : public ManipulatorEmulator {
 public:
  explicit SensapexEmulator(const SensapexEmulatorConfig& config = {}) : config_(config) {}

  Eigen::Vector3d position() const override { return Eigen::Vector3d(at_[0], at_[1], at_[2]) * 1e-9; }
  int movesBegun() const override { return moves_begun_; }
  bool moves() const override { return moving_; }
  void shiftByHand(const Eigen::Vector3d& displacement) override {
    for (std::size_t i = 0; i < 3; ++i) at_[i] = std::round(at_[i] + displacement[static_cast<Eigen::Index>(i)] * 1e9);
  }
  void shiftFourthAxis(double displacement) { at_[3] += displacement * 1e9; }  ///< m

 protected:
  void process(const std::string& bytes, double time) override;
  void advance(double time) override;
  void checkError(const std::string& code) const override;
  void failNextCommand(const std::string& code) override;
  void interrupt(double time) override;

 private:
  struct Request {
    unsigned sender = 0, number = 0, options = 0, type = 0;
    std::vector<std::vector<std::int32_t>> blocks;
  };

  std::size_t messageSize() const;
  Request take(std::size_t size);
  void handle(const Request& request, double time);
  bool goTo(const Request& request);
  std::vector<std::int32_t> positions();
  void stop();
  void say(unsigned receiver, unsigned number, unsigned options, unsigned type,
           const std::vector<std::int32_t>& numbers, double time);

  SensapexEmulatorConfig config_;
  std::string received_;
  double last_byte_ = 0;                          // s
  std::array<double, 4> at_{}, end_{}, speed_{};  // nm, nm, nm/s
  bool moving_ = false, together_ = true, fails_ = false;
  unsigned driver_ = 0, notifications_ = 0;  // whom the end of a drive is told, and how many there were
  int moves_begun_ = 0, jitters_ = 0;
  double time_ = 0;  // s
};

}  // namespace microinjection
