#include "nodes/bus/local_bus.h"

#include <ros/console.h>
#include <sensor_msgs/Image.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "nodes/bus/local_topic.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {

LocalBus::LocalBus(LocalNetwork& network, std::string name, const YAML::Node& parameters,
                   const std::map<std::string, std::string>& remaps)
    : network_(network), name_(std::move(name)), parameters_(YAML::Clone(parameters)), remaps_(remaps) {}

LocalBus::~LocalBus() = default;

std::string LocalBus::resolve(const std::string& name) const {
  if (name.empty()) return "/";
  const std::string full = name[0] == '/' ? name : name[0] == '~' ? name_ + "/" + name.substr(1) : "/" + name;
  const auto remap = remaps_.find(full);
  return remap == remaps_.end() ? full : remap->second;
}

YAML::Node LocalBus::parameter(const std::string& name) const {
  if (name == "~") return YAML::Clone(parameters_);
  if (name[0] != '~') return network_.parameter(resolve(name));
  YAML::Node value = YAML::Clone(parameters_);
  std::string rest = name.substr(1);
  while (value.IsMap() && !rest.empty()) {
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    value.reset(value[rest.substr(0, slash)]);
    rest = rest.substr(std::min(slash + 1, rest.size()));
  }
  return value.IsDefined() && rest.empty() ? value : YAML::Node(YAML::NodeType::Null);
}

std::shared_ptr<RawPublisher> LocalBus::advertiseRaw(const MessageType& type, const std::string& topic, std::uint32_t,
                                                     bool latch) {
  const std::string name = resolve(topic);
  return std::make_shared<LocalPublisher>(*this, network_.topic(name, type), latch, name);
}

std::shared_ptr<RawPublisher> LocalBus::advertiseImages(const std::string& topic, std::uint32_t queue) {
  return advertiseRaw(messageType<sensor_msgs::Image>(), topic, queue, false);
}

std::shared_ptr<RawSubscription> LocalBus::subscribeRaw(const MessageType& type, const std::string& topic,
                                                        std::uint32_t queue, RawHandler handler, Serving serving) {
  LocalTopic* const subscribed = network_.topic(resolve(topic), type);
  if (!subscribed) return nullptr;
  const auto subscription = std::make_shared<LocalSubscription>(*this, *subscribed, queue, std::move(handler), serving);
  if (serving == Serving::kDrives) ++driving_;
  subscribed->subscriptions.push_back(subscription);
  ++network_.changes_;
  for (const LocalPublisher* publisher : subscribed->publishers) publisher->greet(subscription);
  return subscription;
}

Subscription LocalBus::subscribeImages(const std::string& topic, std::uint32_t queue, RawHandler handler) {
  return Subscription(
      subscribeRaw(messageType<sensor_msgs::Image>(), topic, queue, std::move(handler), Serving::kSampled));
}

BusHandle LocalBus::advertiseServiceRaw(const ServiceType& type, const std::string& service, RawAnswer answer,
                                        Serving) {
  const std::string name = resolve(service);
  if (network_.services_.count(name) > 0) ROS_ERROR_STREAM(name << ": is offered already; the newer one counts");
  network_.services_[name] = {&type, this, std::move(answer)};
  return BusHandle(static_cast<void*>(this), [this, name](void*) {
    const auto found = network_.services_.find(name);
    if (found != network_.services_.end() && found->second.owner == this) network_.services_.erase(found);
  });
}

/// As a server that is killed or frozen answers: not at all.
bool LocalBus::callRaw(const ServiceType& type, const std::string& service, void* call) {
  const auto found = network_.services_.find(resolve(service));
  if (!connected_ || found == network_.services_.end()) return false;
  const LocalBus& server = *found->second.owner;
  if (!server.connected_ || server.frozen_) return false;
  if (std::strcmp(found->second.type->md5, type.md5) != 0) return false;
  const RawAnswer answer = found->second.answer;
  found->second.owner->serve();  // what was sent before
  try {
    return type.answer(answer, call);
  } catch (const std::exception& error) {  // as roscpp does
    ROS_ERROR_STREAM(resolve(service) << " has failed: " << error.what());
    return false;
  }
}

BusHandle LocalBus::timer(double period, std::function<void()> task) {
  const auto timer = std::make_shared<Timer>(Timer{now() + durationOf(period), durationOf(period), std::move(task)});
  timers_.push_back(timer);
  return timer;
}

std::vector<std::string> LocalBus::publishersOf(const std::string& topic) const {
  std::vector<std::string> nodes;
  const auto found = network_.topics_.find(resolve(topic));
  if (found == network_.topics_.end()) return nodes;
  for (const LocalPublisher* publisher : found->second->publishers) {
    if (publisher->node() != name_) nodes.push_back(publisher->node());
  }
  return nodes;
}

std::vector<std::string> LocalBus::topics() const {
  std::vector<std::string> names;
  for (const auto& topic : network_.topics_) names.push_back(topic.first);
  return names;
}

const MessageType* LocalBus::typeOf(const std::string& topic) const {
  const auto found = network_.topics_.find(resolve(topic));
  return found == network_.topics_.end() ? nullptr : found->second->type;
}

void LocalBus::setStep(double period, std::function<void(const ros::Time&)> step) {
  period_ = durationOf(period);
  step_ = std::move(step);
  deadline_ = now();
}

bool LocalBus::waitUntil(const std::function<bool()>& done, double) {
  serve();
  return done();
}

void LocalBus::receive(const std::shared_ptr<LocalSubscription>& subscription, const RawDelivery& delivery) {
  if (!connected_) return;
  if (subscription->limit > 0 && subscription->waiting == subscription->limit) {
    const auto oldest = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& waiting) {
      return waiting.subscription.lock() == subscription;
    });
    waiting_.erase(oldest);
    --subscription->waiting;
  }
  ++subscription->waiting;
  waiting_.push_back({subscription, delivery});
  if (subscription->serving == Serving::kDrives) triggered_ = true;
}

bool LocalBus::serve() {
  // What the handlers send to their own node waits for the next time.
  std::deque<Waiting> now_waiting;
  now_waiting.swap(waiting_);
  for (const Waiting& waiting : now_waiting) {
    if (const auto subscription = waiting.subscription.lock()) --subscription->waiting;
  }
  for (const Waiting& waiting : now_waiting) {
    if (const auto subscription = waiting.subscription.lock()) subscription->handler(waiting.delivery);
  }
  return !now_waiting.empty();
}

bool LocalBus::runTimers() {
  bool any = false;
  for (std::size_t i = 0; i < timers_.size(); ++i) {
    const auto timer = timers_[i].lock();
    if (!timer || timer->due > now()) continue;
    // After a delay a timer does not catch up.
    while (timer->due <= now()) timer->due += timer->period;
    timer->task();
    any = true;
  }
  timers_.erase(std::remove_if(timers_.begin(), timers_.end(), [](const auto& timer) { return timer.expired(); }),
                timers_.end());
  return any;
}

bool LocalBus::stepIfDue() {
  const ros::Time now = this->now();
  if (now == stepped_ || (!triggered_ && now < deadline_)) return false;
  // As on a RosBus: the node does not wait for an input that is late by half a period.
  if (driving_ > 0) {
    deadline_ = now + (triggered_ ? period_ + durationOf(period_.toSec() / 2) : period_);
  } else {
    deadline_ += period_;
    if (deadline_ <= now) deadline_ = now + period_;  // after a delay: do not catch up
  }
  triggered_ = false;
  stepped_ = now;
  serve();
  step_(now);
  return true;
}

bool LocalBus::run() {
  if (stopped_ || frozen_ || !connected_ || now() < held_until_) return false;
  const bool ticked = runTimers();
  if (step_) return stepIfDue() || ticked;
  return serve() || ticked;
}

ros::Time LocalBus::due() const {
  ros::Time due = ros::TIME_MAX;
  if (stopped_ || frozen_ || !connected_) return due;
  if (step_) due = triggered_ && stepped_ != now() ? now() : deadline_;
  if (!step_ && !waiting_.empty()) due = now();
  for (const auto& weak : timers_) {
    if (const auto timer = weak.lock()) due = std::min(due, timer->due);
  }
  return std::max(due, held_until_);
}

void LocalBus::end() {
  stopped_ = true;
  if (end_) std::exchange(end_, {})();
}

std::vector<std::string> LocalBus::published() const {
  std::vector<std::string> topics;
  for (const auto& [name, topic] : network_.topics_) {
    for (const LocalPublisher* publisher : topic->publishers) {
      if (publisher->node() == name_) topics.push_back(name);
    }
  }
  return topics;
}

std::vector<std::string> LocalBus::driving() const {
  std::vector<std::string> topics;
  for (const auto& [name, topic] : network_.topics_) {
    for (const auto& weak : topic->subscriptions) {
      const auto subscription = weak.lock();
      if (subscription && &subscription->bus == this && subscription->serving == Serving::kDrives)
        topics.push_back(name);
    }
  }
  return topics;
}

}  // namespace microinjection
