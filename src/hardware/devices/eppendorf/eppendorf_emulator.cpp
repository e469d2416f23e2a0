#include "hardware/devices/eppendorf/eppendorf_emulator.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <optional>
#include <regex>

#include "base/parse_number.h"

namespace microinjection {
namespace {

constexpr int kUnknownCommand = 1, kNotRemote = 2, kParameters = 3, kBusy = 4;  // assumed

/// Whole numbers, separated by spaces or by their signs; empty for any other text.
std::optional<std::vector<long>> numbersIn(const std::string& text) {
  static const std::regex form(R"(( *[ +-]\d+)* *)"), number(R"([+-]?\d+)");
  if (!std::regex_match(text, form)) return std::nullopt;
  std::vector<long> numbers;
  for (std::sregex_iterator each(text.begin(), text.end(), number), end; each != end; ++each) {
    const auto value = parseNumber<long>(each->str());
    if (!value) return std::nullopt;
    numbers.push_back(*value);
  }
  return numbers;
}

}  // namespace

std::string EppendorfEmulator::error(int code) const {
  char text[16];
  std::snprintf(text, sizeof(text), "ERR=%03d", code);
  return text;
}

void EppendorfEmulator::handleCommand(const std::string& command, double time) {
  std::string name = command.substr(0, 4);
  name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  const auto numbers = numbersIn(command.substr(std::min<std::size_t>(4, command.size())));
  const bool goes = name == "C006" || name == "C007" || name == "C012";
  if (!numbers || numbers->size() != (goes ? 6u : 0u)) return reply(error(kParameters), time);
  if ((goes || name == "C008") && !remote_) return reply(error(kNotRemote), time);
  if (name == "C001") return reply("A001 5181 V1.08", time);
  if (name == "C009" || name == "C010") return reply(positionText(name == "C009"), time);
  if (name == "C013") {
    at_end_ = "A013";
    return moves() ? void() : comeToRest(time);
  }
  if (goes) {
    if (moves()) return reply(error(kBusy), time);
    goTo(*numbers, name == "C006" ? 1 : 1e-6 / config_.microstep, name == "C012" ? "" : "A" + name.substr(1));
    return name == "C012" ? reply("A012", time) : void();
  }
  if (name != "C003" && name != "C004" && name != "C005" && name != "C008") return reply(error(kUnknownCommand), time);
  if (name != "C005" || config_.manual_stops) stop();
  if (name == "C003") position_.setZero();
  remote_ = name == "C004" || (remote_ && name != "C005");
  reply("A" + name.substr(1), time);
}

/// `unit`: microsteps, of the numbers.
void EppendorfEmulator::goTo(const std::vector<long>& numbers, double unit, const std::string& reply_at_end) {
  const double furthest = std::round(config_.travel / config_.microstep);
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(i);
    speeds_[i] = static_cast<double>(std::abs(numbers[at + 3])) * unit;
    const double goal = std::round(static_cast<double>(numbers[at]) * unit);
    end_[i] = speeds_[i] == 0 ? position_[i] : std::clamp(goal, -furthest, furthest);
  }
  at_end_ = reply_at_end;
  beginMoving();
}

void EppendorfEmulator::move(double time, double dt) {
  for (int i = 0; i < 3; ++i) {
    const double left = end_[i] - position_[i], step = speeds_[i] * dt;
    position_[i] = std::abs(left) <= step ? end_[i] : position_[i] + std::copysign(step, left);
  }
  if (position_ == end_) comeToRest(time);
}

void EppendorfEmulator::comeToRest(double time) {
  endMoving();
  if (!at_end_.empty()) reply(at_end_ == "A013" ? at_end_ : at_end_ + " " + std::to_string(limits()), time);
  at_end_.clear();
}

void EppendorfEmulator::stop() {
  position_ = position_.array().round();
  endMoving();
  at_end_.clear();
}

void EppendorfEmulator::interrupt(double /*time*/) { stop(); }

void EppendorfEmulator::switchOn() {
  at_end_.clear();
  position_.setZero();
  remote_ = false;
}

void EppendorfEmulator::shiftByHand(const Eigen::Vector3d& displacement) {
  position_ = (position_ + displacement / config_.microstep).array().round();
}

int EppendorfEmulator::limits() const {
  const double furthest = std::round(config_.travel / config_.microstep);
  int bits = 0;
  for (int i = 0; i < 3; ++i) {
    if (position_[i] <= -furthest) bits |= 1 << (2 * i);
    if (position_[i] >= furthest) bits |= 2 << (2 * i);
  }
  return bits;
}

std::string EppendorfEmulator::positionText(bool in_microsteps) const {
  std::string text = in_microsteps ? "A009" : "A010";
  for (int i = 0; i < 3; ++i) {
    const double value = in_microsteps ? position_[i] : position_[i] * config_.microstep * 1e6;
    char number[24];
    std::snprintf(number, sizeof(number), config_.signs_separate && i > 0 ? "%+.*f" : " %.*f",
                  config_.decimals && !in_microsteps ? 2 : 0, std::abs(value) < 0.005 ? 0.0 : value);
    text += std::string(number) == " -0" ? " 0" : number;
  }
  return text + " " + std::to_string(limits());
}

}  // namespace microinjection
