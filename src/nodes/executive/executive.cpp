#include "nodes/executive/executive.h"

#include <ros/console.h>

#include <algorithm>
#include <exception>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/errors.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

/// Passes over the nodes in one instant, after which they answer each other without end.
constexpr int kMostPasses = 1000;

}  // namespace

Executive::Executive(double start) : network_(ros::Time() + durationOf(start)), start_(network_.now()) {}

Executive::~Executive() {
  for (auto member = members_.rbegin(); member != members_.rend(); ++member) {
    (*member)->node.reset();
    (*member)->bus.reset();
  }
}

double Executive::time() const { return 1e-9 * static_cast<double>(network_.now().toNSec() - start_.toNSec()); }

void Executive::add(const std::string& name, NodeFactory factory, const YAML::Node& parameters,
                    const std::map<std::string, std::string>& remaps) {
  for (const auto& member : members_) {
    if (member->name == name) throw std::invalid_argument("there is a node " + name + " already");
  }
  auto member = std::make_unique<Member>();
  member->name = name;
  member->factory = std::move(factory);
  member->parameters = parameters;
  member->remaps = remaps;
  construct(*member);
  members_.push_back(std::move(member));
}

void Executive::construct(Member& member) {
  ros::console::setFixedFilterToken("node", "/" + member.name);
  member.bus = network_.connect("/" + member.name, member.parameters, member.remaps);
  try {
    member.node = member.factory(*member.bus);
  } catch (const std::exception& error) {
    member.bus.reset();
    throw ConfigError("node " + member.name + ": " + error.what());
  }
}

void Executive::destroy(Member& member) {
  if (member.node.use_count() > 1) throw std::logic_error("the node " + member.name + " would outlive its bus");
  member.node.reset();
  member.bus.reset();
}

Executive::Member& Executive::member(const std::string& name) {
  for (const auto& member : members_) {
    if (member->name == name) return *member;
  }
  throw std::invalid_argument("there is no node " + name);
}

LocalBus& Executive::bus(const std::string& name) {
  Member& found = member(name);
  if (!found.bus) throw std::invalid_argument("the node " + name + " has ended");
  return *found.bus;
}

bool Executive::runs(const std::string& name) const {
  return const_cast<Executive*>(this)->member(name).node != nullptr;
}

void Executive::freeze(const std::string& name) { bus(name).setFrozen(true); }
void Executive::thaw(const std::string& name) { bus(name).setFrozen(false); }

void Executive::kill(const std::string& name) {
  bus(name).disconnect();
  destroy(member(name));
}

void Executive::end(const std::string& name) {
  bus(name).end();
  destroy(member(name));
}

void Executive::restart(const std::string& name) {
  Member& again = member(name);
  if (again.node) kill(name);
  failures_.erase(name);
  construct(again);
}

void Executive::restart(const std::string& name, const YAML::Node& parameters) {
  member(name).parameters = parameters;
  restart(name);
}

void Executive::delay(const std::string& name, double seconds) {
  bus(name).holdUntil(network_.now() + durationOf(seconds));
}

void Executive::loseMaster(bool lost) {
  for (const auto& member : members_) {
    if (member->bus) member->bus->setLost(lost);
  }
}

void Executive::endAll() {
  for (auto member = members_.rbegin(); member != members_.rend(); ++member) {
    if (!(*member)->node) continue;
    try {
      (*member)->bus->end();
    } catch (const std::exception& error) {
      failures_[(*member)->name] = error.what();
    }
    destroy(**member);
  }
}

void Executive::sort() {
  std::map<std::string, std::vector<Member*>> publishers;
  for (const auto& member : members_) {
    if (!member->bus) continue;
    for (const std::string& topic : member->bus->published()) publishers[topic].push_back(member.get());
  }
  order_.clear();
  std::set<const Member*> done;
  std::vector<Member*> path;  // from a node to those that it waits for
  const std::function<void(Member&)> place = [&](Member& member) {
    if (done.count(&member) > 0) return;
    const auto again = std::find(path.begin(), path.end(), &member);
    if (again != path.end()) {
      std::string circle;
      for (auto one = again; one != path.end(); ++one) circle += (*one)->name + " waits for ";
      throw ConfigError("these nodes drive each other in a circle: " + circle + member.name);
    }
    path.push_back(&member);
    for (const std::string& topic : member.bus->driving()) {
      for (Member* const upstream : publishers[topic]) {
        if (upstream != &member) place(*upstream);
      }
    }
    path.pop_back();
    done.insert(&member);
    order_.push_back(&member);
  };
  for (const auto& member : members_) {
    if (member->bus) place(*member);
  }
  sorted_ = network_.changes();
}

bool Executive::run(Member& member) {
  if (!member.node) return false;
  ros::console::setFixedFilterToken("node", "/" + member.name);
  try {
    const bool any = member.bus->run();
    if (member.bus->isRunning()) return any;
    member.bus->end();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM(error.what());
    failures_[member.name] = error.what();
  }
  destroy(member);
  return true;
}

void Executive::runInstant() {
  network_.deliverDue();
  bool any = true;
  for (int pass = 0; any; ++pass) {
    if (pass == kMostPasses)
      throw ConfigError("at " + std::to_string(time()) + " s nodes answer each other without end");
    if (sorted_ != network_.changes()) sort();
    any = false;
    const std::vector<Member*> order = order_;
    for (Member* const member : order) any = run(*member) || any;
  }
}

bool Executive::advance(const ros::Time& limit) {
  ros::Time next = network_.nextArrival().value_or(ros::TIME_MAX);
  for (const auto& member : members_) {
    if (member->node) next = std::min(next, member->bus->due());
  }
  if (next > limit) return false;
  network_.setTime(std::max(next, network_.now()));
  runInstant();
  return true;
}

void Executive::runFor(double seconds) {
  const ros::Time end = network_.now() + durationOf(seconds);
  while (advance(end)) {
  }
  network_.setTime(end);
}

bool Executive::runUntil(const std::function<bool()>& done, double limit) {
  const ros::Time end = network_.now() + durationOf(limit);
  while (!done()) {
    if (advance(end)) continue;
    network_.setTime(end);
    return done();
  }
  return true;
}

}  // namespace microinjection
