#include "operation/readiness/readiness.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace microinjection {
namespace {

/// From the devices towards the hand.
constexpr const char* kOrder[] = {"micromanipulator",
                                  "holder_rig",
                                  "true_cell",
                                  "cell_simulator",
                                  "force_sensor",
                                  "injector",
                                  "holder",
                                  "injection_controller",
                                  "link_emulator",
                                  "teleoperation_follower",
                                  "haptic_bridge",
                                  "haptic_device",
                                  "keyboard_hand",
                                  "virtual_hand",
                                  "microscope",
                                  "camera",
                                  "vision"};
/// What only means that nobody asks for a motion.
constexpr const char* kNoAlarm[] = {"no injection is under way", "homing", "no valid target"};
constexpr const char* kMaster = "the ROS master is lost";
constexpr const char* kLoops[] = {"micromanipulator", "injection_controller",
                                  "haptic_bridge"};  // they may hold the needle
constexpr std::size_t kMostKnown = 1000;             // reasons whose remedies are kept

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
  nodes_[node].heard = time;
  nodes_[node].statuses[status] = {message, time, level};
}

void Readiness::hearLoop(const std::string& node, const std::string& hold_reason, double time) {
  if (begin_ < 0) begin_ = time;
  nodes_[node].heard = time;
  nodes_[node].loop = Said{hold_reason, time};
}

Hindrance Readiness::hindrance(const std::string& node, const std::string& status, Hindrance::Level level,
                               const std::string& reason) const {
  Hindrance found{node, status, level, false, reason, "", ""};
  if (known_.size() > kMostKnown) known_.clear();
  const auto known = known_.find(reason);
  const auto& remedy =
      known != known_.end() ? known->second : known_.emplace(reason, remedies_.of(reason)).first->second;
  if (remedy) {
    found.remedy = remedy->text;
    found.section = remedy->section;
  }
  return found;
}

void Readiness::addOf(const std::string& name, const Node& node, double time, std::vector<Hindrance>& all) const {
  const bool has_loop = node.loop && isFresh(*node.loop, time);
  const std::string reason = has_loop ? node.loop->message : "";
  bool said = reason.empty();
  for (const auto& [status, word] : node.statuses) {
    if (word.level == Hindrance::Level::kInformation || !isFresh(word, time)) continue;
    all.push_back(hindrance(name, status, word.level, word.message));
    all.back().holds = !reason.empty() && word.message.find(reason) != std::string::npos;
    said = said || all.back().holds;
  }
  if (node.loop && !has_loop && time - node.heard <= kSilence)
    all.push_back(hindrance(name, "loop", Hindrance::Level::kError, "the loop of " + name + " is silent"));
  if (said) return;
  all.push_back(
      hindrance(name, "loop", isAlarm(reason) ? Hindrance::Level::kWarning : Hindrance::Level::kInformation, reason));
  all.back().holds = true;
}

void Readiness::addSilence(const std::string& name, double time, std::vector<Hindrance>& all) const {
  const auto known = nodes_.find(name);
  const bool was_heard = known != nodes_.end();
  if (begin_ < 0 || (was_heard && time - known->second.heard <= kSilence)) return;
  if (was_heard || time - begin_ > kStart)
    all.push_back(hindrance(name, "node", Hindrance::Level::kError, "the node " + name + " is silent"));
  else
    all.push_back(hindrance(name, "node", Hindrance::Level::kWarning, "the node " + name + " has not started yet"));
}

std::vector<Hindrance> Readiness::hindrances(double time) const {
  std::vector<Hindrance> all;
  for (const auto& [name, node] : nodes_) addOf(name, node, time, all);
  for (const std::string& name : expected_) addSilence(name, time, all);
  std::stable_sort(all.begin(), all.end(), [](const Hindrance& a, const Hindrance& b) {
    const bool news_a = a.level == Hindrance::Level::kInformation, news_b = b.level == Hindrance::Level::kInformation;
    return news_a != news_b ? news_b : placeOf(a) < placeOf(b);
  });
  return all;
}

bool Readiness::follows(const std::string& name, double time) const {
  const auto node = nodes_.find(name);
  return node != nodes_.end() && node->second.loop && isFresh(*node->second.loop, time) &&
         node->second.loop->message.empty();
}

bool Readiness::isReady(double time) const {
  for (const char* name : kLoops) {
    const bool has = std::find(expected_.begin(), expected_.end(), name) != expected_.end();
    if (has && !follows(name, time)) return false;
  }
  const std::vector<Hindrance> all = hindrances(time);
  return begin_ >= 0 && std::none_of(all.begin(), all.end(), [](const Hindrance& each) {
           return each.holds || each.status == "node" || each.level == Hindrance::Level::kError;
         });
}

}  // namespace microinjection
