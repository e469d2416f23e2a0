#pragma once

#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "hardware/devices/manipulator_emulator.h"
#include "hardware/serial/damage.h"

namespace microinjection {

/// An emulator half of whose replies arrive cut off, garbled, with foreign bytes, twice, after the next one, or forged;
/// its motion is untouched.
class DamagedReplies : public ManipulatorEmulator {
 public:
  /// `forge`: makes a reply that is well formed and false; none: nothing is forged.
  DamagedReplies(std::shared_ptr<ManipulatorEmulator> device, unsigned seed,
                 std::function<std::string(const std::string& reply, std::mt19937& random)> forge)
      : device_(std::move(device)), damage_(seed), forge_(std::move(forge)) {}

  Eigen::Vector3d position() const override { return device_->position(); }
  int movesBegun() const override { return device_->movesBegun(); }
  bool moves() const override { return device_->moves(); }
  void shiftByHand(const Eigen::Vector3d& way) override { device_->shiftByHand(way); }

  void setDamaging(bool damaging) { damaging_ = damaging; }
  int damaged() const { return damaged_; }

 protected:
  void process(const std::string& bytes, double time) override { device_->receive(bytes, time); }
  std::string produce(double time) override {
    const std::string reply = device_->send(time);
    if (reply.empty() || !damaging_) return reply;
    if (!damage_.holds() && damage_.below(2) == 0) return reply;
    const bool forges = forge_ && !damage_.holds() && damage_.below(10) == 0;
    const std::string arrives = forges ? forge_(reply, damage_.random()) : damage_(reply);
    if (arrives != reply) ++damaged_;
    return arrives;
  }
  void checkError(const std::string&) const override {}
  void failNextCommand(const std::string&) override {}
  void interrupt(double) override {}

 private:
  std::shared_ptr<ManipulatorEmulator> device_;
  Damage damage_;
  std::function<std::string(const std::string&, std::mt19937&)> forge_;
  bool damaging_ = false;
  int damaged_ = 0;
};

}  // namespace microinjection
