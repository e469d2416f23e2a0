#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros/spinner.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "nodes/bus/bus.h"
#include "nodes/bus/master_monitor.h"

namespace microinjection {

/// The bus of a node that is a process of its own: topics, services and parameters of roscpp.
///
/// A node steps when a kDrives or kWakes message arrives, so that a hand's motion passes the whole chain
/// at once. Without such an input, or when it is late, the node steps at its own rate. While the master
/// is lost (MasterMonitor) isLost() holds; when it is lost for long and the node is not busy, run() ends.
class RosBus : public Bus {
 public:
  /// Who watches the master. A program with a life of its own, such as rviz, does not end with its master.
  enum class Master { kWatched, kIgnored };

  /// Use after ros::init; one for each process that is a node. With Master::kIgnored nothing is ever lost; instead of
  /// run(), which is for nodes, such a program calls waitUntil() with time-out 0 in its own loop.
  explicit RosBus(Master master = Master::kWatched);
  ~RosBus() override;

  const std::string& name() const override;
  std::string resolve(const std::string& name) const override;
  ros::Time now() const override { return ros::Time::now(); }
  ros::SteadyTime steady() const override { return ros::SteadyTime::now(); }
  bool isVirtual() const override { return false; }
  YAML::Node parameter(const std::string& name) const override;
  std::shared_ptr<RawPublisher> advertiseImages(const std::string& topic, std::uint32_t queue) override;
  Subscription subscribeImages(const std::string& topic, std::uint32_t queue, RawHandler handler) override;
  BusHandle timer(double period, std::function<void()> task) override;
  std::vector<std::string> publishersOf(const std::string& topic) const override;
  bool isLost() const override { return master_ && master_->lost(); }
  void setStep(double period, std::function<void(const ros::Time&)> step) override;
  void onEnd(std::function<void()> task) override { end_ = std::move(task); }
  void stop() override { stopped_ = true; }
  bool isRunning() const override { return ros::ok() && !stopped_; }
  void setBusy(bool busy) override { busy_ = busy; }
  bool waitUntil(const std::function<bool()>& done, double timeout) override;
  void pause(double seconds) override;
  void leave() override { ros::shutdown(); }

  /// Steps, or serves a node that has no steps, until ROS shuts down or the node ends; then calls the task of
  /// onEnd().
  void run();

 protected:
  std::shared_ptr<RawPublisher> advertiseRaw(const MessageType& type, const std::string& topic, std::uint32_t queue,
                                             bool latch) override;
  std::shared_ptr<RawSubscription> subscribeRaw(const MessageType& type, const std::string& topic, std::uint32_t queue,
                                                RawHandler handler, Serving serving) override;
  BusHandle advertiseServiceRaw(const ServiceType& type, const std::string& service, RawAnswer answer,
                                Serving serving) override;
  bool callRaw(const ServiceType& type, const std::string& service, void* call) override;

 private:
  /// A queue of callbacks and the handle of what is served from it.
  struct Lane {
    Lane() { node.setCallbackQueue(&queue); }
    ros::CallbackQueue queue;
    ros::NodeHandle node;
  };

  bool shouldContinue();
  void runSteps();
  void serveOnly();
  /// The lane of a node's own thread, which starts with its first use.
  Lane& ownThread();

  std::unique_ptr<MasterMonitor> master_;  ///< null: ignored
  Lane waking_;                            ///< wakes the node's loop up
  Lane sampled_;                           ///< read before a step: to wake up for it would cost more than the step
  double period_ = 0;                      ///< s; 0: the node has no steps
  std::function<void(const ros::Time&)> step_;
  std::function<void()> end_;
  bool driven_ = false;     ///< a subscription starts steps
  bool triggered_ = false;  ///< its message has arrived
  std::atomic<bool> stopped_{false};
  bool busy_ = false;
  std::unique_ptr<Lane> own_;
  std::unique_ptr<ros::AsyncSpinner> own_thread_;  ///< last member: ends before what it serves
};

}  // namespace microinjection
