#pragma once

#include <ros/time.h>
#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "nodes/bus/message_refusals.h"
#include "nodes/bus/message_type.h"

namespace microinjection {

/// When a node handles a message, or answers the call of a service. A node with steps (Bus::setStep) handles what has
/// arrived right before a step, so that no input changes within one; a node without steps handles each message as it
/// arrives.
///
///                 on a RosBus                       on a LocalBus
///     kSampled    waits for the next step           the same
///     kDrives     starts a step                     starts a step, after that of its publisher in the same instant
///     kWakes      starts a step                     waits for the next step
///     kOwnThread  in a thread of its own, at once   waits for the next step
///
/// @pre kDrives and kWakes: the node has steps. A RosBus serves these messages in its loop of steps only.
enum class Serving {
  kSampled,    ///< what the node merely needs to know
  kDrives,     ///< data that flow downstream, such as the needle's pose for the cell: nobody waits for a period
  kWakes,      ///< feedback: on a LocalBus, where a message takes no time, it would close a circle within an instant
  kOwnThread,  ///< work so slow that it would delay a step; its handler must lock what it shares with the steps
};

/// A node's ends of topics, without the type of the message. The handles Publisher and Subscription share one each,
/// and the end leaves the topic with its last handle.
class RawPublisher {
 public:
  virtual ~RawPublisher() = default;
  /// Sends a copy of a message of the topic's type.
  virtual void publish(const void* message) = 0;
  /// Sends the message itself, for large ones such as images: it must never change again. On a LocalBus its
  /// subscribers share it, and its header keeps the number that the sender wrote there.
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

/// A message as a subscription receives it. `raw` is valid within the handler only.
template <typename Message>
struct Delivery {
  boost::shared_ptr<const Message> message;  ///< never null; may be kept
  const RawDelivery& raw;                    ///< sender, arrival, connection
};

/// A topic that a node publishes. One that is constructed by default is empty. Any thread may publish.
template <typename Message>
class Publisher {
 public:
  Publisher() = default;
  explicit Publisher(std::shared_ptr<RawPublisher> raw) : raw_(std::move(raw)) {}

  /// @pre not empty; see RawPublisher
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

/// A topic that a node receives: its handler is called as long as a copy of this handle exists.
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

/// One node's connection to its session: topics, services, parameters, timers and the clock. A node class knows
/// nothing else of ROS but its messages, so that the same class runs in two ways:
///
///     live: a process for each node            tests, simulate: one process
///     Node --> RosBus --> roscpp               Node --> LocalBus --+
///     wall time, sockets, real devices         Node --> LocalBus --+--> LocalNetwork
///                                              virtual time, one thread, the same bytes in each run
///
/// Three other ways to get there were considered (doc/design/bus_and_executive.md). A lock step over topics, which
/// the project had first, made each tick a round trip between all processes, needed a second topic for "no message in
/// this tick", and left commands, actions and diagnostics outside. Another implementation of roscpp's API, chosen by
/// the linker, would leave the nodes as they are; but that API is large, and a test would run against whatever part
/// of it somebody has written. A ROS master within the process would still pass messages through threads and sockets,
/// in an order that depends on the machine. This interface is smaller than each of the three, and what it leaves out
/// cannot differ between the two ways.
///
/// test/nodes/bus/bus_contract.h states what a node may rely on and runs on both buses. Diagnostics, actions
/// (ActionServer, GoalNode) and steps with typed inputs (Cycle) use nothing but this interface, and therefore work on
/// either. The templates below erase the type of a message (MessageType), because a function that a bus implements
/// has to be virtual, and a virtual function cannot be a template.
///
/// Names are ROS names: a relative one is below the root, one with ~ below the node, and remappings apply. Any thread
/// may read the clocks, pause, publish, and use what says so; the rest is for the node's own thread.
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

  /// A parameter, as YAML; "~": all of the node's own, as a map; "~a/b": one within the map `a`. Null: there is none.
  virtual YAML::Node parameter(const std::string& name) const = 0;

  /// A topic of the node. `queue`: messages that a slow subscriber may leave unsent, 0: any number; a LocalBus sends
  /// at once and needs none. `latch`: a later subscriber first receives the last message.
  template <typename Message>
  Publisher<Message> advertise(const std::string& topic, std::uint32_t queue, bool latch = false) {
    return Publisher<Message>(advertiseRaw(messageType<Message>(), topic, queue, latch));
  }
  /// As a camera's topic: on a RosBus with all of image_transport's transports.
  virtual std::shared_ptr<RawPublisher> advertiseImages(const std::string& topic, std::uint32_t queue) = 0;
  /// `handler`: void(const Delivery<Message>&). `queue`: messages that may wait for the node; a full queue drops its
  /// oldest one, 0 drops none. An exception of the handler ends the node: use subscribeGuarded() or a Cycle for what
  /// somebody else may send wrongly.
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

  /// `answer`: bool(Service::Request&, Service::Response&). An exception fails the call, not the node.
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
  /// Calls a service in `call`, which has the response afterwards. False: there is no such service, its server is
  /// frozen (on a LocalBus), or it fails. On a RosBus the call waits as long as the server takes, so a node with
  /// steps calls in a thread of its own. Any thread may call.
  template <typename Service>
  bool call(const std::string& service, Service& call) {
    return callRaw(serviceType<Service>(), service, &call);
  }

  /// Calls `task` in the node's thread, each `period` (s of steady time, > 0), for the first time after one period.
  virtual BusHandle timer(double period, std::function<void()> task) = 0;

  /// The nodes that publish a topic, without this one.
  virtual std::vector<std::string> publishersOf(const std::string& topic) const = 0;
  /// Whether the session's master is lost. No input counts then, because nobody new could send `disable`.
  virtual bool isLost() const = 0;

  /// Has the bus call `step` with the time of each step: when a message arrives that starts steps and, without such
  /// an input or when it is late by half a period, each `period` (s, > 0).
  virtual void setStep(double period, std::function<void(const ros::Time&)> step) = 0;
  /// `task` is called once when the node ends in good order: to publish last messages, to complete files.
  virtual void onEnd(std::function<void()> task) = 0;
  /// Ends the node after its present step or callback. Any thread may call.
  virtual void stop() = 0;
  virtual bool isRunning() const = 0;  ///< false: the node ends. Any thread may call
  /// Whether something moves or flows that this node must monitor even when the master is lost for long.
  virtual void setBusy(bool busy) = 0;
  /// Handles what arrives until `done` or for `timeout` (s); for constructors, and for programs with a loop of their
  /// own. In virtual time nothing arrives meanwhile: what waits already is handled once. @returns done()
  virtual bool waitUntil(const std::function<bool()>& done, double timeout) = 0;
  /// Lets messages leave before the next: waits live, and does nothing in virtual time.
  virtual void pause(double seconds) = 0;
  /// Leaves the session at once, so that calls of services that wait in other threads fail. For the destructor of a
  /// node with such a thread; nothing else works afterwards.
  virtual void leave() {}

  MessageRefusals& refusals() { return refusals_; }  ///< messages that this node did not take, for its diagnostics

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
