#include "nodes/haptic/keyboard_adapter.h"

#include <cstdio>
#include <map>

namespace microinjection {
namespace {

constexpr double kTextPeriod = 0.1;  // s

constexpr char kKeys[] =
    "arrows: left, right, up (out of the cell), down (into it)   page up, page down: away, to you   hold a key to "
    "move\n"
    "e enable   h hold   i inject   w withdraw (home)   r release   d disable   + - longer and shorter steps   space: "
    "release   q quit\n";

const std::map<std::string, Eigen::Vector3d>& directions() {
  static const std::map<std::string, Eigen::Vector3d> all{{"left", {-1, 0, 0}},   {"right", {1, 0, 0}},
                                                          {"up", {0, 0, 1}},      {"down", {0, 0, -1}},
                                                          {"page_up", {0, 1, 0}}, {"page_down", {0, -1, 0}}};
  return all;
}

const std::map<std::string, std::string>& commands() {
  static const std::map<std::string, std::string> all{{"e", "enable"}, {"h", "hold"},    {"i", "inject"},
                                                      {"w", "home"},   {"r", "release"}, {"d", "disable"}};
  return all;
}

}  // namespace

KeyboardConfig KeyboardConfig::read(ConfigReader& reader) {
  KeyboardConfig config;
  config.hand = GoalHandConfig::read(reader);
  reader.number("lead", config.hand.lead, Range::positive());
  reader.number("step", config.step, Range::positive());
  return config;
}

KeyboardAdapter::KeyboardAdapter(Cycle& cycle, const KeyboardConfig& config)
    : config_(config), hand_(config.hand), session_(cycle) {
  std::fputs(kKeys, stdout);
}

void KeyboardAdapter::execute(const std::string& key) {
  if (const auto direction = directions().find(key); direction != directions().end()) {
    hand_.moveBy(config_.step * direction->second);
    return;
  }
  hand_.release();  // any other key ends the motion
  if (const auto command = commands().find(key); command != commands().end()) commands_.push_back(command->second);
  if (key == "+") config_.step *= 2;
  if (key == "-") config_.step /= 2;
  if (key == "q") ended_ = true;
}

std::optional<HandReading> KeyboardAdapter::read(const Cycle::Tick& tick) {
  const std::string typed = terminal_.read();
  for (const char byte : typed) {
    if (const auto key = keys_.feed(byte)) execute(*key);
  }
  if (typed.empty() && keys_.wait(tick.dt)) execute("other");
  HandReading reading;
  reading.position = hand_.step(tick.dt);
  reading.stamp = tick.now;
  reading.operator_present = hand_.present();
  return reading;
}

void KeyboardAdapter::render(const Eigen::Vector3d& force, const Cycle::Tick& tick) {
  if (!isDue(shown_, tick.now, kTextPeriod)) return;
  shown_ = tick.now;
  char felt[64];
  std::snprintf(felt, sizeof felt, "[%s] at the hand %.2f N, ", hand_.present() ? "moving" : "at rest", force.norm());
  const std::string reason = hand_.present() && !session_.held().empty() ? " (" + session_.held() + ")" : "";
  terminal_.show(felt + session_.text() + reason);
}

}  // namespace microinjection
