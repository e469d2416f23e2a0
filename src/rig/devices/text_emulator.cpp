#include "rig/devices/text_emulator.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "base/errors.h"

namespace microinjection {
namespace {

constexpr std::size_t kLongestCommand = 200;

}  // namespace

void TextEmulator::advance(double time) {
  const double dt = time - time_;
  time_ = std::max(time, time_);
  if (moving_ && dt > 0) move(time, dt);
}

void TextEmulator::process(const std::string& bytes, double time) {
  advance(time);
  for (const char each : bytes) {
    if (each != '\r' && each != '\n') {
      if (command_.size() < kLongestCommand) command_ += each;
      continue;
    }
    const std::string command = std::exchange(command_, "");
    if (command.empty()) continue;
    if (error_ >= 0) {
      reply(error(std::exchange(error_, -1)), time);
    } else {
      handleCommand(command, time);
    }
  }
}

void TextEmulator::checkError(const std::string& code) const {
  long number = 0;
  if (code == kReset || (isWhole(code, number) && number >= 0 && number <= 999)) return;
  throw ConfigError("fault = error:" + code + ": must be a number from 0 to 999, or RESET");
}

void TextEmulator::failNextCommand(const std::string& code) {
  if (code != kReset) {
    error_ = std::stoi(code);
    return;
  }
  command_.clear();
  dropReplies();
  error_ = -1;
  moving_ = false;
  switchOn();
}

std::vector<std::string> capitalWords(const std::string& command) {
  std::vector<std::string> words;
  std::istringstream stream(command);
  for (std::string word; stream >> word;) {
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char each) { return std::toupper(each); });
    words.push_back(word);
  }
  return words;
}

bool isWhole(const std::string& text, long& number) {
  char* end = nullptr;
  if (text.empty() || std::isspace(static_cast<unsigned char>(text[0]))) return false;
  number = std::strtol(text.c_str(), &end, 10);
  return *end == '\0' && text.size() <= 11;
}

}  // namespace microinjection
