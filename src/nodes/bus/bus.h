#pragma once

#include <ros/time.h>
#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nodes/bus/message_refusals.h"
#include "nodes/bus/message_type.h"
#include "nodes/bus/service_type.h"

namespace microinjection {

/// When a node handles what arrives. A node whose Cycle is on the bus handles messages right before
/// a step; a node without one, on arrival.
enum class Serving {
  kSampled,    ///< does not start a step
  kDrives,     ///< starts a step. On a LocalBus the publisher's node steps before this one: data flows downstream
  kWakes,      ///< feedback that starts a step on a RosBus, and none on a LocalBus, where it would close a loop
  kOwnThread,  ///< on a RosBus in a thread of its own, so that slow work delays no step; else kSampled
};

/// A node's ends of topics. The handles below own one each; a topic ends with its last handle.
class RawPublisher {
 public:
  virtual ~RawPublisher() = default;
  virtual void publish(const void* message) = 0;
  /// Without a copy: the message must never change again.
  virtual void publishShared(const boost::shared_ptr<const void>& message) = 0;
  virtual std::size_t subscribers() const = 0;
  virtual bool isSubscribedBy(const std::string& node) const = 0;
  virtual const std::string& topic() const = 0;  ///< resolved
};
class RawSubscription {
 public:
  virtual ~RawSubscription() = default;
  virtual std::size_t publishers() const = 0;
};

/// A message as a subscription receives it.
template <typename Message>
struct Delivery {
  boost::shared_ptr<const Message> message;
  const RawDelivery& raw;  ///< sender, arrival, connection
};

/// A topic that a node publishes; empty after construction by default. Any thread may publish.
template <typename Message>
class Publisher {
 public:
  Publisher() = default;
  explicit Publisher(std::shared_ptr<RawPublisher> raw) : raw_(std::move(raw)) {}

  void publish(const Message& message) const { raw_->publish(&message); }
  void publish(const boost::shared_ptr<const Message>& message) const { raw_->publishShared(message); }
  std::size_t subscribers() const { return raw_ ? raw_->subscribers() : 0; }  ///< connections, this node's own too
  bool isSubscribedBy(const std::string& node) const { return raw_ && raw_->isSubscribedBy(node); }
  std::string topic() const { return raw_ ? raw_->topic() : ""; }
  void shutdown() { raw_.reset(); }
  explicit operator bool() const { return raw_ != nullptr; }

 private:
  std::shared_ptr<RawPublisher> raw_;
};

/// A topic that a node receives.
class Subscription {
 public:
  Subscription() = default;
  explicit Subscription(std::shared_ptr<RawSubscription> raw) : raw_(std::move(raw)) {}

  std::size_t publishers() const { return raw_ ? raw_->publishers() : 0; }  ///< connections, this node's own too
  void shutdown() { raw_.reset(); }
  explicit operator bool() const { return raw_ != nullptr; }

 private:
  std::shared_ptr<RawSubscription> raw_;
};

/// A service that a node offers, or a timer of a node: it ends with its last handle.
using BusHandle = std::shared_ptr<void>;

/// One node's connection to its session: topics, services, parameters, timers and the clock. Nodes
/// know nothing else of ROS, so that the same class runs
///
/// - live, as a process of its own, on a RosBus: topics of roscpp, the wall's time;
/// - in one process with all others on a LocalBus: virtual time, one thread, the same bytes in each
///   run (nodes/executive/executive.h).
///
/// test/nodes/bus has one contract that both keep. Names are ROS names: relative ones are below the
/// root, those with ~ below the node; remappings apply.
class Bus {
 public:
  virtual ~Bus() = default;

  virtual const std::string& name() const = 0;  ///< of the node, such as /cell_simulator
  virtual std::string resolve(const std::string& name) const = 0;

  virtual ros::Time now() const = 0;           ///< the session's time; zero: a simulated clock has not started
  virtual ros::SteadyTime steady() const = 0;  ///< never set back; for durations
  /// Whether all nodes share one thread and a virtual clock. Then a node must not start a thread, wait,
  /// or depend on the wall's time.
  virtual bool isVirtual() const = 0;

  /// A parameter, as YAML; "~": all of the node's own. Null: there is none.
  virtual YAML::Node parameter(const std::string& name) const = 0;

  template <typename Message>
  Publisher<Message> advertise(const std::string& topic, std::uint32_t queue, bool latch = false) {
    return Publisher<Message>(advertiseRaw(messageType<Message>(), topic, queue, latch));
  }
  /// As a camera's topic: on a RosBus with all of image_transport's transports.
  virtual std::shared_ptr<RawPublisher> advertiseImages(const std::string& topic, std::uint32_t queue) = 0;
  /// `handler`: void(const Delivery<Message>&). Its exceptions end the node; see subscribeGuarded.
  template <typename Message, typename Handler>
  Subscription subscribe(const std::string& topic, std::uint32_t queue, Handler handler,
                         Serving serving = Serving::kSampled) {
    return Subscription(subscribeRaw(
        messageType<Message>(), topic, queue,
        [handler](const RawDelivery& raw) {
          handler(Delivery<Message>{boost::static_pointer_cast<const Message>(raw.message), raw});
        },
        serving));
  }
  /// Images of a camera, by the transport that the parameter ~image_transport names.
  virtual Subscription subscribeImages(const std::string& topic, std::uint32_t queue, RawHandler handler) = 0;

  /// `answer`: bool(Service::Request&, Service::Response&). Served like a topic.
  template <typename Service, typename Answer>
  BusHandle advertiseService(const std::string& service, Answer answer, Serving serving = Serving::kSampled) {
    using Request = typename Service::Request;
    using Response = typename Service::Response;
    return advertiseServiceRaw(
        serviceType<Service>(), service,
        [answer](void* request, void* response) {
          return static_cast<bool>(answer(*static_cast<Request*>(request), *static_cast<Response*>(response)));
        },
        serving);
  }
  /// Calls a service in `call`, which has the response afterwards. False: there is no such service, or
  /// it fails. It waits as long as the server takes. Of any thread.
  template <typename Service>
  bool call(const std::string& service, Service& call) {
    return callRaw(serviceType<Service>(), service, &call);
  }

  /// Calls `task` in the node's thread, each `period` (s of steady time).
  virtual BusHandle timer(double period, std::function<void()> task) = 0;

  /// The nodes that publish a topic, without this one.
  virtual std::vector<std::string> publishersOf(const std::string& topic) const = 0;
  /// Whether the session's master is lost: no input counts.
  virtual bool isLost() const = 0;

  /// Has run() call `step` with the time of each step: when a kDrives input arrives and, without one or
  /// when it is late by half a period, each `period` (s).
  virtual void setStep(double period, std::function<void(const ros::Time&)> step) = 0;
  /// Called once when run() has ended in good order: to publish last messages, to complete files.
  virtual void onEnd(std::function<void()> task) = 0;
  /// Ends run() after the present step or callback. Of any thread.
  virtual void stop() = 0;
  virtual bool isRunning() const = 0;  ///< false: the node ends. Of any thread
  /// Whether something moves or flows that this node must monitor even when the master is lost for long.
  virtual void setBusy(bool busy) = 0;
  /// Handles what arrives until `done` or for `timeout` (s); for constructors. @returns done()
  virtual bool waitUntil(const std::function<bool()>& done, double timeout) = 0;
  /// Lets messages leave before the next: waits live, and does nothing in virtual time.
  virtual void pause(double seconds) = 0;
  /// Leaves the session at once: calls of services that wait in other threads fail. For the destructor of
  /// a node with such a thread; nothing else works afterwards.
  virtual void leave() {}

  MessageRefusals& refusals() { return refusals_; }

 protected:
  virtual std::shared_ptr<RawPublisher> advertiseRaw(const MessageType& type, const std::string& topic,
                                                     std::uint32_t queue, bool latch) = 0;
  virtual std::shared_ptr<RawSubscription> subscribeRaw(const MessageType& type, const std::string& topic,
                                                        std::uint32_t queue, RawHandler handler, Serving serving) = 0;
  virtual BusHandle advertiseServiceRaw(const ServiceType& type, const std::string& service, RawAnswer answer,
                                        Serving serving) = 0;
  virtual bool callRaw(const ServiceType& type, const std::string& service, void* call) = 0;

 private:
  MessageRefusals refusals_;
};

}  // namespace microinjection
