#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "nodes/bus/local_bus.h"

namespace microinjection {

class LocalPublisher;
class LocalSubscription;

/// A topic of a LocalNetwork with its ends.
struct LocalTopic {
  std::string name;
  const MessageType* type;
  std::vector<LocalPublisher*> publishers;
  std::vector<std::weak_ptr<LocalSubscription>> subscriptions;
  Alteration alteration;
};

class LocalSubscription : public RawSubscription {
 public:
  LocalSubscription(LocalBus& owner, LocalTopic& subscribed, std::uint32_t queue, RawHandler receive, Serving how)
      : bus(owner), topic(subscribed), limit(queue), handler(std::move(receive)), serving(how) {}
  ~LocalSubscription() override;

  std::size_t publishers() const override;
  /// The connection to a publisher, by its number.
  boost::shared_ptr<const void> connection(std::uint64_t publisher) {
    boost::shared_ptr<const void>& known = connections_[publisher];
    if (!known) known = boost::make_shared<int>(0);
    return known;
  }

  LocalBus& bus;
  LocalTopic& topic;
  const std::uint32_t limit;  ///< 0: none
  const RawHandler handler;
  const Serving serving;
  std::uint32_t waiting = 0;

 private:
  std::map<std::uint64_t, boost::shared_ptr<const void>> connections_;
};

class LocalPublisher : public RawPublisher {
 public:
  LocalPublisher(LocalBus& bus, LocalTopic* topic, bool latch, std::string name)
      : bus_(bus), topic_(topic), latch_(latch), name_(std::move(name)), number_(++bus.network_.publishers_) {
    if (topic_) topic_->publishers.push_back(this);
    ++bus.network_.changes_;
  }
  ~LocalPublisher() override {
    if (!topic_) return;
    auto& all = topic_->publishers;
    all.erase(std::remove(all.begin(), all.end(), this), all.end());
    ++bus_.network_.changes_;
  }

  void publish(const void* message) override {
    if (topic_ && bus_.connected_) send(topic_->type->copy(message, sequence_++));
  }
  void publishShared(const boost::shared_ptr<const void>& message) override {
    ++sequence_;
    if (topic_ && bus_.connected_) send(message);
  }
  std::size_t subscribers() const override;
  bool isSubscribedBy(const std::string& node) const override;
  const std::string& topic() const override { return name_; }

  void greet(const std::shared_ptr<LocalSubscription>& subscription) const {
    if (last_) subscription->bus.receive(subscription, delivery(*subscription, last_));
  }
  const std::string& node() const { return bus_.name(); }

 private:
  RawDelivery delivery(LocalSubscription& subscription, const boost::shared_ptr<const void>& message) const {
    return {message, bus_.name(), bus_.now(), latch_, subscription.connection(number_)};
  }
  void send(const boost::shared_ptr<const void>& message) {
    if (latch_) last_ = message;
    bus_.network_.send(*topic_, number_, latch_, {bus_.name(), message, 0});
  }

  LocalBus& bus_;
  LocalTopic* topic_;  ///< null: of another type
  bool latch_;
  std::string name_;
  std::uint64_t number_;
  std::uint32_t sequence_ = 0;
  boost::shared_ptr<const void> last_;
};

}  // namespace microinjection
