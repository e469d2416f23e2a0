#include "rig/devices/scientifica/scientifica_emulator.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "base/parse_number.h"

namespace microinjection {
namespace {

constexpr int kNotUnderstood = 3;

/// Splits a command into words in capitals.
std::vector<std::string> capitalWords(const std::string& command) {
  std::vector<std::string> words;
  std::istringstream stream(command);
  for (std::string word; stream >> word;) {
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char each) { return std::toupper(each); });
    words.push_back(word);
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
  if (words[0] == "ZERO") {
    if (moves()) return reply("E", time);
    position_.setZero();
    return reply("A", time);
  }
  if (!replyToQuery(words, time) && !set(words, time)) reply(error(kNotUnderstood), time);
}

bool ScientificaEmulator::replyToQuery(const std::vector<std::string>& words, double time) {
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
  if (word == "SCIENTIFICA") output = config_.maker;
  if (word == "VER") output = config_.version;
  if (word == "DATE") output = "Scientifica " + config_.version + "\tJan 01 2020\t12:00:00";
  if (word == "TYPE") output = isOld() ? "1.05" : "3.05";
  if (word == "DESC") output = "PatchStar";
  if (word == "P" || word == "POS") output = positionText();
  if (output.empty()) return false;
  reply(output, time);
  return true;
}

bool ScientificaEmulator::set(const std::vector<std::string>& words, double time) {
  const auto number = words.size() == 2 ? parseNumber<long>(words[1]) : std::nullopt;
  if (!number) return false;
  const bool speed = words[0] == "TOP" || words[0] == "FIRST";
  if (!speed && words[0] != "ACC") return false;
  const long least = !isOld() ? 1 : speed ? 1000 : 10, most = isOld() && !speed ? 1000 : isOld() ? 50000 : 1000000;
  if (*number < least || *number > most) {
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
  if (moves()) return;
  const double furthest = config_.travel * kStepsPerMetre;
  end_ = end.array().round().max(-furthest).min(furthest);
  reply("A", time);
  stopping_ = false;
  speed_ = std::min(stepsPerSecond(first_), stepsPerSecond(top_));
  beginMoving();
}

void ScientificaEmulator::move(double /*time*/, double dt) {
  // Small steps, so that the ramps do not depend on the calling rate.
  const double a = acceleration(), least = std::min(stepsPerSecond(first_), stepsPerSecond(top_));
  for (double left = dt; left > 0 && moves(); left -= 0.2e-3) {
    const double h = std::min(left, 0.2e-3), distance = (end_ - position_).norm();
    const bool brakes = stopping_ || speed_ * speed_ / (2 * a) >= distance;
    speed_ = brakes ? std::max(speed_ - a * h, least) : std::min(speed_ + a * h, stepsPerSecond(top_));
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

std::string ScientificaEmulator::positionText() const {
  std::string text;
  for (int i = 0; i < 3; ++i) text += (i > 0 ? "\t" : "") + std::to_string(std::lround(position_[i] / stepsPerCount()));
  return text;
}

}  // namespace microinjection
