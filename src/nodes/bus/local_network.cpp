#include "nodes/bus/local_network.h"

#include <ros/console.h>

#include <cstring>
#include <stdexcept>
#include <utility>

#include "nodes/bus/local_topic.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {

LocalNetwork::LocalNetwork(const ros::Time& start) {
  ros::Time::init();  // else ros::Time::now() throws once the network is gone
  setTime(start);
}
LocalNetwork::~LocalNetwork() = default;

void LocalNetwork::setTime(const ros::Time& now) {
  now_ = now;
  ros::Time::setNow(now);
}

std::unique_ptr<LocalBus> LocalNetwork::connect(const std::string& node, const YAML::Node& parameters,
                                                const std::map<std::string, std::string>& remaps) {
  return std::unique_ptr<LocalBus>(new LocalBus(*this, node, parameters, remaps));
}

YAML::Node LocalNetwork::parameter(const std::string& name) const {
  const auto found = parameters_.find(name);
  return found == parameters_.end() ? YAML::Node(YAML::NodeType::Null) : YAML::Clone(found->second);
}

void LocalNetwork::alter(const std::string& name, Alteration alteration) {
  const auto found = topics_.find(name);
  if (found == topics_.end()) throw std::invalid_argument("no topic " + name);
  found->second->alteration = std::move(alteration);
}

/// Null when it has another type.
LocalTopic* LocalNetwork::topic(const std::string& name, const MessageType& type) {
  auto& topic = topics_[name];
  if (!topic) topic = std::make_unique<LocalTopic>(LocalTopic{name, &type, {}, {}, {}});
  const bool unused = topic->publishers.empty() && topic->subscriptions.empty();
  if (unused) topic->type = &type;
  if (std::strcmp(topic->type->md5, type.md5) == 0) return topic.get();
  ROS_ERROR_STREAM(name << ": is of type " << topic->type->name << " and not of " << type.name << ": not connected");
  return nullptr;
}

void LocalNetwork::send(LocalTopic& topic, std::uint64_t publisher, bool latched, const Passage& passage) {
  if (topic.alteration && passage.delay == 0) {
    for (const Passage& altered : topic.alteration(passage)) {
      const Flight flight{&topic, altered, latched, publisher};
      flights_.emplace(now_ + durationOf(altered.delay), flight);
    }
    return deliverDue();
  }
  for (std::size_t i = 0; i < topic.subscriptions.size(); ++i) {
    const auto subscription = topic.subscriptions[i].lock();
    if (subscription)
      subscription->bus.receive(subscription,
                                {passage.message, passage.sender, now_, latched, subscription->connection(publisher)});
  }
}

std::optional<ros::Time> LocalNetwork::nextArrival() const {
  if (flights_.empty()) return std::nullopt;
  return flights_.begin()->first;
}

void LocalNetwork::deliverDue() {
  while (!flights_.empty() && flights_.begin()->first <= now_) {
    Flight flight = std::move(flights_.begin()->second);
    flights_.erase(flights_.begin());
    flight.passage.delay = -1;  // has been altered
    send(*flight.topic, flight.publisher, flight.latched, flight.passage);
  }
}

}  // namespace microinjection
