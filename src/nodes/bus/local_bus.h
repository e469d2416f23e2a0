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

/// The bus of a node among others of its process; see LocalNetwork. Whoever runs the session
/// (Executive) asks when the node is due, and has it step and serve what has arrived.
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
  bool waitUntil(const std::function<bool()>& done, double timeout) override;
  void pause(double) override {}

  /// The time at which the node steps or a timer of it is due, or `now` when something waits for it.
  ros::Time due() const;
  /// Serves what has arrived, runs the timers that are due, and steps if that is due. @returns whether
  /// there was anything to do. Exceptions are the node's.
  bool run();
  /// Runs the task of onEnd().
  void end();
  /// Cuts the node off as if its process had been killed: nothing that it does is heard any more.
  void disconnect() { connected_ = false; }
  /// As if its process were stopped: it neither steps nor answers, and what arrives waits.
  void setFrozen(bool frozen) { frozen_ = frozen; }
  void setLost(bool lost) { lost_ = lost; }
  /// The node does not step before this time, as if the machine had delayed it.
  void holdUntil(const ros::Time& time) { held_until_ = time; }

  /// Resolved topics that it publishes, and those whose messages start its steps.
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
  struct Waiting {
    std::weak_ptr<LocalSubscription> subscription;
    RawDelivery delivery;
  };
  struct Timer {
    ros::Time due;
    ros::Duration period;
    std::function<void()> task;
  };

  LocalBus(LocalNetwork& network, std::string name, const YAML::Node& parameters,
           const std::map<std::string, std::string>& remaps);
  void receive(const std::shared_ptr<LocalSubscription>& subscription, const RawDelivery& delivery);
  bool serve();
  bool runTimers();
  bool stepIfDue();

  LocalNetwork& network_;
  std::string name_;
  YAML::Node parameters_;
  std::map<std::string, std::string> remaps_;
  std::deque<Waiting> waiting_;
  std::vector<std::weak_ptr<Timer>> timers_;
  ros::Duration period_;  ///< zero: the node has no steps
  std::function<void(const ros::Time&)> step_;
  std::function<void()> end_;
  ros::Time deadline_, held_until_, stepped_;
  unsigned driving_ = 0;  ///< subscriptions that start steps
  bool triggered_ = false;
  bool connected_ = true, frozen_ = false, stopped_ = false, lost_ = false;
};

}  // namespace microinjection
