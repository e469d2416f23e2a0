#include "hardware/devices/scientifica/scientifica_emulator.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "base/parse_number.h"

namespace microinjection {
namespace {

constexpr int kNotUnderstood = 3;

/// Which axis a word ends with; -1: none. "PX", "ABSZ".
int letterAxis(const std::string& word) { return static_cast<int>(std::string("XYZ").find(word.back())); }

/// Splits a command into words in capitals; "=" is one that says nothing ("px = 0").
std::vector<std::string> capitalWords(const std::string& command) {
  std::vector<std::string> words;
  std::istringstream stream(command);
  for (std::string word; stream >> word;) {
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char each) { return std::toupper(each); });
    if (word != "=") words.push_back(word);
  }
  return words;
}

}  // namespace

ScientificaEmulator::ScientificaEmulator(const ScientificaEmulatorConfig& config)
    : TextEmulator(config.answer_time), config_(config) {
  if (config_.scale == 0) config_.scale = isOld() ? -6.4 : 1600;
  switchOn();
}

/// Settings of a card as delivered (ScanImage, Micro-Manager); those of version 3 give the same
/// motion.
void ScientificaEmulator::switchOn() {
  position_.setZero();
  stopping_ = false;
  top_ = isOld() ? 30000 : 2344;
  first_ = isOld() ? 5000 : 391;
  acc_ = isOld() ? 500 : 19531;
  of_the_knobs_ = {{"JACC", 500}, {"JSPEED", 100}, {"JSSPEED", 10}, {"JDX", 0}, {"JDY", 0}, {"JDZ", 0}, {"ANGLE", 0}};
}

double ScientificaEmulator::stepsPerSecond(int top) const {
  return (isOld() ? top / (2 * 6.4) : top) * 1e-6 * kStepsPerMetre;
}

double ScientificaEmulator::acceleration() const { return (isOld() ? 250 * acc_ / 6.4 : acc_) * 1e-6 * kStepsPerMetre; }

void ScientificaEmulator::handleCommand(const std::string& command, double time) {
  const std::vector<std::string> words = capitalWords(command);
  if (words.empty()) return;
  if (words[0] == "STOP") {
    stopping_ = true;
    return reply("A", time);
  }
  if (words[0] == "ABS" || words[0] == "REL") return goTo(words, words[0] == "REL", time);
  if (words[0] == "ABSZ" && words.size() == 2) return goTo({"ABS", textOf(0), textOf(1), words[1]}, false, time);
  if (words[0] == "VJ") return goToEnds(words, time);
  if (words[0] == "ZERO") return count(Eigen::Vector3d::Zero(), time);
  if (words[0].size() == 2 && words[0][0] == 'P' && letterAxis(words[0]) >= 0 && words.size() == 2) {
    const auto value = parseNumber<long>(words[1]);
    Eigen::Vector3d counted = position_;
    counted[letterAxis(words[0])] = static_cast<double>(value.value_or(0)) * stepsPerCount();
    return value ? count(counted, time) : reply(error(kNotUnderstood), time);
  }
  if (words[0] == "DESC" && words.size() > 1) {
    description_ = command.substr(command.find(' ') + 1);
    return reply("A", time);
  }
  if (!replyToQuery(words, time) && !set(words, time)) reply(error(kNotUnderstood), time);
}

bool ScientificaEmulator::replyToQuery(std::vector<std::string> words, double time) {
  if (words.back() == "?") words.pop_back();  // "JDX ?"
  if (words.empty()) return false;
  const std::string& word = words[0];
  char text[64] = "";
  if (words.size() == 2 && word == "USTEP" && !isOld() && std::string("XYZ").find(words[1]) != std::string::npos) {
    std::snprintf(text, sizeof(text), "%.2f", config_.scale);
  } else if (words.size() != 1) {
    return false;
  } else if ((word == "UUX" || word == "UUY" || word == "UUZ") && isOld()) {
    std::snprintf(text, sizeof(text), "%.2f", config_.scale);
  } else if (word == "S") {
    std::snprintf(text, sizeof(text), "%d", !moves() ? 0 : stopping_ ? 5 : 3);
  } else if (word == "TOP" || word == "FIRST" || word == "ACC") {
    std::snprintf(text, sizeof(text), "%d", word == "TOP" ? top_ : word == "FIRST" ? first_ : acc_);
  } else if (word == "LIMITS") {
    std::snprintf(text, sizeof(text), "0");
  }
  std::string output = text;
  if (of_the_knobs_.count(word) > 0) output = std::to_string(of_the_knobs_.at(word));
  if (word == "CURRENT") output = "230 175";
  if (word == "SCIENTIFICA") output = config_.maker;
  if (word == "VER") output = config_.version;
  if (word == "DATE") output = "Scientifica " + config_.version + "\tJan 01 2020\t12:00:00";
  if (word == "TYPE") output = isOld() ? "1.05" : "3.05";
  if (word == "DESC") output = description_;
  if (word == "P" || word == "POS") output = textOf(0) + "\t" + textOf(1) + "\t" + textOf(2);
  if (word.size() == 2 && word[0] == 'P' && letterAxis(word) >= 0) output = textOf(letterAxis(word));
  if (output.empty()) return false;
  reply(output, time);
  return true;
}

/// A number may have decimals (acq4: "TOP 500.000000"); they are dropped.
bool ScientificaEmulator::set(const std::vector<std::string>& words, double time) {
  const auto number = words.size() == 2 ? parseNumber<double>(words[1]) : std::nullopt;
  if (!number) return false;
  if (of_the_knobs_.count(words[0]) > 0) {
    of_the_knobs_[words[0]] = static_cast<int>(*number);
    reply("A", time);
    return true;
  }
  const bool speed = words[0] == "TOP" || words[0] == "FIRST";
  if (!speed && words[0] != "ACC") return false;
  const double least = !isOld() ? 1 : speed ? 1000 : 10, most = isOld() && !speed ? 1000 : isOld() ? 50000 : 1000000;
  if (!(*number >= least && *number <= most)) {
    reply("E", time);
    return true;
  }
  (words[0] == "TOP" ? top_ : words[0] == "FIRST" ? first_ : acc_) = static_cast<int>(*number);
  reply("A", time);
  return true;
}

/// Two numbers are x and y, three are all axes.
void ScientificaEmulator::goTo(const std::vector<std::string>& words, bool relative, double time) {
  Eigen::Vector3d end = position_;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const auto number = parseNumber<long>(words[i]);
    if (i > 3 || !number) return reply(error(kNotUnderstood), time);
    end[static_cast<Eigen::Index>(i) - 1] =
        (relative ? position_[static_cast<Eigen::Index>(i) - 1] : 0) + static_cast<double>(*number) * stepsPerCount();
  }
  if (words.size() < 3) return reply(error(kNotUnderstood), time);
  begin(end, time);
}

/// "VJ x y z": velocities of the axes; Micro-Manager sends its stage to its corner so. Here it goes
/// to its limits, straight and at the speed of any move.
void ScientificaEmulator::goToEnds(const std::vector<std::string>& words, double time) {
  Eigen::Vector3d end = position_;
  for (int i = 0; i < 3; ++i) {
    const auto velocity =
        words.size() == 4 ? parseNumber<double>(words[static_cast<std::size_t>(i) + 1]) : std::nullopt;
    if (!velocity) return reply(error(kNotUnderstood), time);
    if (*velocity != 0) end[i] = std::copysign(config_.travel * kStepsPerMetre, *velocity);
  }
  begin(end, time);
}

/// Begins a move with the speeds of now: acq4 sets others as soon as it has begun.
void ScientificaEmulator::begin(const Eigen::Vector3d& end, double time) {
  if (moves()) return;
  const double furthest = config_.travel * kStepsPerMetre;
  end_ = end.array().round().max(-furthest).min(furthest);
  reply("A", time);
  stopping_ = false;
  move_top_ = stepsPerSecond(top_);
  speed_ = move_least_ = std::min(stepsPerSecond(first_), move_top_);
  beginMoving();
}

/// Gives the present position other numbers, at rest.
void ScientificaEmulator::count(const Eigen::Vector3d& position, double time) {
  if (moves()) return reply("E", time);
  position_ = position;
  reply("A", time);
}

void ScientificaEmulator::move(double /*time*/, double dt) {
  // Small steps, so that the ramps do not depend on the calling rate.
  const double a = acceleration(), least = move_least_;
  for (double left = dt; left > 0 && moves(); left -= 0.2e-3) {
    const double h = std::min(left, 0.2e-3), distance = (end_ - position_).norm();
    const bool brakes = stopping_ || speed_ * speed_ / (2 * a) >= distance;
    speed_ = brakes ? std::max(speed_ - a * h, least) : std::min(speed_ + a * h, move_top_);
    if (speed_ * h >= distance) {
      position_ = end_;
      endMoving();
    } else {
      position_ += (end_ - position_) * (speed_ * h / distance);
    }
    if (stopping_ && speed_ <= least) {
      position_ = position_.array().round();
      endMoving();
    }
  }
  if (!moves()) stopping_ = false;
}

void ScientificaEmulator::interrupt(double /*time*/) {
  position_ = position_.array().round();
  endMoving();
  stopping_ = false;
}

std::string ScientificaEmulator::textOf(int axis) const {
  return std::to_string(std::lround(position_[axis] / stepsPerCount()));
}

}  // namespace microinjection
