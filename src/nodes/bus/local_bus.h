#pragma once

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "nodes/bus/local_network.h"

namespace microinjection {

class LocalPublisher;
class LocalSubscription;

/// The bus of one node among others of its process, which a LocalNetwork joins. It has neither a thread nor a clock
/// of its own: whoever runs the session (Executive) asks when the node is due, sets the network's time, and has the
/// node do what is due then.
///
///     others publish --> LocalNetwork --> receive(): waiting_, a queue in the order of arrival
///                                             |
///     Executive: due() --> time --> run():    v
///         timers that are due, then   with steps:      serve() --> handlers, then the step
///                                     without steps:   serve() --> handlers
///
/// A publisher could call its subscribers' handlers directly. Handlers would then run within each other's steps, to
/// any depth, and see half of what the publisher is about to do. With a queue, a handler runs only when its own node
/// has its turn, so that the order of all that happens follows from the session and not from the stack. What a node
/// sends to itself waits for its next turn, for the same reason.
///
/// A node steps as on a RosBus: when a kDrives message has come, else after its period; and 1.5 periods after a
/// driven step if the next message is late by half a period. It steps once in an instant at the most, and after a
/// delay it does not catch up, which a RosBus does for up to ten periods. A node without steps serves messages in the
/// instant in which they arrive.
///
/// The functions from due() on are the Executive's, some of them for faults on purpose: a process that is killed,
/// stopped or late, and a lost master.
///
/// @pre The LocalNetwork outlives the bus, and the bus its node.
class LocalBus : public Bus {
 public:
  ~LocalBus() override;

  const std::string& name() const override { return name_; }
  std::string resolve(const std::string& name) const override;
  ros::Time now() const override { return network_.now(); }
  ros::SteadyTime steady() const override { return ros::SteadyTime(network_.now().sec, network_.now().nsec); }
  bool isVirtual() const override { return true; }
  YAML::Node parameter(const std::string& name) const override;
  std::shared_ptr<RawPublisher> advertiseImages(const std::string& topic, std::uint32_t queue) override;
  Subscription subscribeImages(const std::string& topic, std::uint32_t queue, RawHandler handler) override;
  BusHandle timer(double period, std::function<void()> task) override;
  std::vector<std::string> publishersOf(const std::string& topic) const override;
  bool isLost() const override { return lost_; }
  void setStep(double period, std::function<void(const ros::Time&)> step) override;
  void onEnd(std::function<void()> task) override { end_ = std::move(task); }
  void stop() override { stopped_ = true; }
  bool isRunning() const override { return !stopped_; }
  void setBusy(bool) override {}
  /// Handles what waits, once: nobody else can publish while this node has its turn.
  bool waitUntil(const std::function<bool()>& done, double timeout) override;
  void pause(double) override {}

  /// The time of the node's next step or timer, or now() when a message waits that starts its turn; ros::TIME_MAX:
  /// nothing is due, as of a node that has stopped, is frozen or is cut off.
  ros::Time due() const;
  /// The node's turn: runs the timers that are due, and steps or serves what has arrived. @returns whether there was
  /// anything to do. Throws what the node throws.
  bool run();
  /// Ends the node in good order: runs the task of onEnd(), once. Throws what the task throws.
  void end();
  /// Cuts the node off as if its process had been killed: nothing that it does is heard any more.
  void disconnect() { connected_ = false; }
  /// As if its process were stopped: the node neither steps nor answers calls, and what arrives waits in its queues.
  void setFrozen(bool frozen) { frozen_ = frozen; }
  void setLost(bool lost) { lost_ = lost; }  ///< see isLost()
  /// The node gets no turn before this time, as if the machine had delayed it.
  void holdUntil(const ros::Time& time) { held_until_ = time; }

  /// For programs that know topics by name only: the names, the type of one (null: no node has it), and its ends.
  std::vector<std::string> topics() const;
  const MessageType* typeOf(const std::string& topic) const;
  Subscription subscribeAny(const MessageType& type, const std::string& topic, std::uint32_t queue,
                            RawHandler handler) {
    return Subscription(subscribeRaw(type, topic, queue, std::move(handler), Serving::kSampled));
  }
  std::shared_ptr<RawPublisher> advertiseAny(const MessageType& type, const std::string& topic, std::uint32_t queue) {
    return advertiseRaw(type, topic, queue, false);
  }

  /// Resolved topics that the node publishes, and those whose messages start its steps: the Executive orders nodes by
  /// them.
  std::vector<std::string> published() const;
  std::vector<std::string> driving() const;

 protected:
  std::shared_ptr<RawPublisher> advertiseRaw(const MessageType& type, const std::string& topic, std::uint32_t queue,
                                             bool latch) override;
  std::shared_ptr<RawSubscription> subscribeRaw(const MessageType& type, const std::string& topic, std::uint32_t queue,
                                                RawHandler handler, Serving serving) override;
  BusHandle advertiseServiceRaw(const ServiceType& type, const std::string& service, RawAnswer answer,
                                Serving serving) override;
  bool callRaw(const ServiceType& type, const std::string& service, void* call) override;

 private:
  friend class LocalNetwork;
  friend class LocalPublisher;
  friend class LocalSubscription;
  /// A message that the node has not handled yet. One whose subscription has ended meanwhile is dropped.
  struct Waiting {
    std::weak_ptr<LocalSubscription> subscription;
    RawDelivery delivery;
  };
  struct Timer {
    ros::Time due;
    ros::Duration period;
    std::function<void()> task;
  };

  /// For LocalNetwork::connect(). `parameters`: the node's own, which are copied; `remaps`: from and to resolved
  /// names.
  LocalBus(LocalNetwork& network, std::string name, const YAML::Node& parameters,
           const std::map<std::string, std::string>& remaps);
  /// Queues a message. A full subscription drops its oldest one.
  void receive(const std::shared_ptr<LocalSubscription>& subscription, const RawDelivery& delivery);
  bool serve();      ///< handles what waits now; what its handlers send to their own node waits on
  bool runTimers();  ///< those that are due; one that is late is called once
  bool stepIfDue();

  LocalNetwork& network_;
  std::string name_;
  YAML::Node parameters_;
  std::map<std::string, std::string> remaps_;
  std::deque<Waiting> waiting_;
  std::vector<std::weak_ptr<Timer>> timers_;  ///< the node holds each by its BusHandle
  ros::Duration period_;                      ///< zero: the node has no steps
  std::function<void(const ros::Time&)> step_;
  std::function<void()> end_;
  /// Of the next step if no message starts one; before which there is no turn; of the last step.
  ros::Time deadline_, held_until_, stepped_;
  unsigned driving_ = 0;    ///< subscriptions that start steps
  bool triggered_ = false;  ///< a message has come that starts a step
  bool connected_ = true, frozen_ = false, stopped_ = false, lost_ = false;
};

}  // namespace microinjection
