#pragma once

#include <functional>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include "rig/devices/manipulator_emulator.h"

namespace microinjection {

/// An emulator half of whose replies arrive cut off, garbled, with foreign bytes, twice, after the next one, or forged;
/// its motion is untouched.
class DamagedReplies : public ManipulatorEmulator {
 public:
  /// `forge`: makes a reply that is well formed and false; none: nothing is forged.
  DamagedReplies(std::shared_ptr<ManipulatorEmulator> device, unsigned seed,
                 std::function<std::string(const std::string& reply, std::mt19937& random)> forge)
      : device_(std::move(device)), random_(seed), forge_(std::move(forge)) {}

  Eigen::Vector3d position() const override { return device_->position(); }
  int movesBegun() const override { return device_->movesBegun(); }
  bool moves() const override { return device_->moves(); }
  void shiftByHand(const Eigen::Vector3d& way) override { device_->shiftByHand(way); }

  void setDamaging(bool damaging) { damaging_ = damaging; }
  int damaged() const { return damaged_; }

 protected:
  void hear(const std::string& bytes, double time) override { device_->receive(bytes, time); }
  std::string say(double time) override {
    std::string reply = device_->send(time);
    if (reply.empty() || !damaging_) return reply;
    if (!held_.empty()) {  // the last one comes after this one
      ++damaged_;
      return reply + std::exchange(held_, "");
    }
    if (below(2) == 0) return reply;
    const std::string whole = reply;
    damage(reply);
    if (reply != whole) ++damaged_;
    return reply;
  }
  void checkError(const std::string&) const override {}
  void failNextCommand(const std::string&) override {}
  void interrupt(double) override {}

 private:
  std::size_t below(std::size_t end) { return std::uniform_int_distribution<std::size_t>(0, end - 1)(random_); }
  char byte() { return static_cast<char>(below(256)); }

  void damage(std::string& reply) {
    const std::size_t at = below(reply.size());
    switch (below(forge_ ? 10 : 9)) {
      case 0:  // cut off
        reply.resize(at);
        break;
      case 1:  // its begin is missing
        reply.erase(0, at + 1);
        break;
      case 2:
        reply.erase(at, 1);
        break;
      case 3:
        reply.insert(reply.begin() + static_cast<std::ptrdiff_t>(at), byte());
        break;
      case 4:  // one bit
        reply[at] = static_cast<char>(reply[at] ^ (1 << below(8)));
        break;
      case 5:  // noise of the same length
        for (char& each : reply) each = byte();
        break;
      case 6:  // noise before or behind
        for (std::size_t i = 0, more = 1 + below(40); i < more; ++i)
          reply.insert(below(2) ? reply.size() : 0, 1, byte());
        break;
      case 7:
        reply += reply;
        break;
      case 8:
        held_.swap(reply);
        break;
      default:
        reply = forge_(reply, random_);
    }
  }

  std::shared_ptr<ManipulatorEmulator> device_;
  std::mt19937 random_;
  std::function<std::string(const std::string&, std::mt19937&)> forge_;
  std::string held_;
  bool damaging_ = false;
  int damaged_ = 0;
};

}  // namespace microinjection
