#include "operation/readiness/readiness.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace microinjection {
namespace {

/// From the devices towards the hand.
constexpr const char* kOrder[] = {"micromanipulator",
                                  "true_cell",
                                  "cell_simulator",
                                  "force_sensor",
                                  "injector",
                                  "injection_controller",
                                  "link_emulator",
                                  "teleoperation_follower",
                                  "haptic_bridge",
                                  "haptic_device",
                                  "keyboard_hand",
                                  "operator",
                                  "microscope",
                                  "camera",
                                  "vision"};
/// What only means that nobody asks for a motion.
constexpr const char* kNoAlarm[] = {"no injection is under way", "homing", "no valid target"};
constexpr const char* kMaster = "the ROS master is lost";

std::ptrdiff_t placeOf(const Hindrance& hindrance) {
  if (hindrance.reason.find(kMaster) != std::string::npos) return -1;
  return std::distance(std::begin(kOrder), std::find(std::begin(kOrder), std::end(kOrder), hindrance.node));
}

bool isAlarm(const std::string& hold_reason) {
  return std::find(std::begin(kNoAlarm), std::end(kNoAlarm), hold_reason) == std::end(kNoAlarm);
}

}  // namespace

Readiness::Readiness(std::vector<std::string> nodes, const Remedies& remedies)
    : expected_(std::move(nodes)), remedies_(remedies) {}

void Readiness::hearStatus(const std::string& node, const std::string& status, Hindrance::Level level,
                           const std::string& message, double time) {
  if (begin_ < 0) begin_ = time;
  Node& known = nodes_[node];
  known.heard = time;
  known.statuses[status] = {level, message};
}

void Readiness::hearLoop(const std::string& node, const std::string& hold_reason, double time) {
  if (begin_ < 0) begin_ = time;
  Node& known = nodes_[node];
  known.heard = time;
  known.has_loop = true;
  known.hold_reason = hold_reason;
}

Hindrance Readiness::hindrance(const std::string& node, const std::string& status, Hindrance::Level level,
                               const std::string& reason) const {
  Hindrance found{node, status, level, false, reason, "", ""};
  if (const std::optional<Remedies::Remedy> remedy = remedies_.of(reason)) {
    found.remedy = remedy->text;
    found.section = remedy->section;
  }
  return found;
}

std::vector<Hindrance> Readiness::hindrances(double time) const {
  std::vector<Hindrance> all;
  for (const auto& [name, node] : nodes_) {
    if (time - node.heard > kSilence) continue;  // what it said is no longer true
    bool said = false;
    for (const auto& [status, word] : node.statuses) {
      if (word.level == Hindrance::Level::kInformation) continue;
      all.push_back(hindrance(name, status, word.level, word.message));
      all.back().holds = !node.hold_reason.empty() && word.message.find(node.hold_reason) != std::string::npos;
      said = said || all.back().holds;
    }
    if (node.hold_reason.empty() || said) continue;
    const bool alarm = isAlarm(node.hold_reason);
    all.push_back(
        hindrance(name, "loop", alarm ? Hindrance::Level::kWarning : Hindrance::Level::kInformation, node.hold_reason));
    all.back().holds = true;
  }
  for (const std::string& name : expected_) {
    const auto known = nodes_.find(name);
    const double heard = known == nodes_.end() ? begin_ : known->second.heard;
    if (begin_ >= 0 && time - heard > kSilence)
      all.push_back(hindrance(name, "node", Hindrance::Level::kError, name + " is silent"));
  }
  std::stable_sort(all.begin(), all.end(), [](const Hindrance& a, const Hindrance& b) {
    const bool news_a = a.level == Hindrance::Level::kInformation, news_b = b.level == Hindrance::Level::kInformation;
    return news_a != news_b ? news_b : placeOf(a) < placeOf(b);
  });
  return all;
}

bool Readiness::isReady(double time) const {
  const std::vector<Hindrance> all = hindrances(time);
  const bool follows = std::any_of(nodes_.begin(), nodes_.end(), [](const auto& each) { return each.second.has_loop; });
  return follows && std::none_of(all.begin(), all.end(), [](const Hindrance& each) {
           return each.holds || each.level == Hindrance::Level::kError;
         });
}

}  // namespace microinjection
