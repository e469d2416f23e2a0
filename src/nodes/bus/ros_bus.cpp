#include "nodes/bus/ros_bus.h"

#include <image_transport/image_transport.h>
#include <ros/publication.h>
#include <ros/topic_manager.h>
#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <utility>

#include "nodes/bus/ending.h"
#include "nodes/bus/lost_publishers.h"
#include "nodes/runtime/real_time.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

/// The shortest text that reads back as the same number, so that a message shows what the user
/// wrote.
std::string shortest(double value) {
  std::string text;
  for (int digits = 6; digits <= 17; ++digits) {
    std::ostringstream out;
    out.precision(digits);
    out << value;
    text = out.str();
    if (std::strtod(text.c_str(), nullptr) == value) break;
  }
  return text;
}

/// A value of the ROS parameter server as YAML. (XmlRpcValue has no const access.)
YAML::Node toYaml(XmlRpc::XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(value));
    case XmlRpc::XmlRpcValue::TypeInt:
      return YAML::Node(std::to_string(static_cast<int>(value)));
    case XmlRpc::XmlRpcValue::TypeDouble:
      return YAML::Node(shortest(static_cast<double>(value)));
    case XmlRpc::XmlRpcValue::TypeString:
      return YAML::Node(static_cast<std::string>(value));
    case XmlRpc::XmlRpcValue::TypeArray: {
      YAML::Node list(YAML::NodeType::Sequence);
      for (int i = 0; i < value.size(); ++i) list.push_back(toYaml(value[i]));
      return list;
    }
    case XmlRpc::XmlRpcValue::TypeStruct: {
      YAML::Node map(YAML::NodeType::Map);
      for (auto& item : value) map[item.first] = toYaml(item.second);
      return map;
    }
    default:
      return YAML::Node(YAML::NodeType::Null);
  }
}

const ros::WallDuration kLongestWait(0.1);

/// Asks roscpp, not the master: a connection that failed does not count.
bool hasConnection(const std::string& topic, const std::string& node) {
  const auto publication = ros::TopicManager::instance()->lookupPublication(topic);
  if (!publication) return false;
  XmlRpc::XmlRpcValue links;  // as in getBusInfo: id, the subscriber's name, ...
  links.setSize(0);
  publication->getInfo(links);
  for (int i = 0; i < links.size(); ++i) {
    if (static_cast<std::string>(links[i][1]) == node) return true;
  }
  return false;
}

class RosPublisher : public RawPublisher {
 public:
  RosPublisher(const MessageType& type, ros::Publisher publisher)
      : type_(type), publisher_(std::move(publisher)), topic_(publisher_.getTopic()) {}

  void publish(const void* message) override { type_.publish(publisher_, message); }
  void publishShared(const boost::shared_ptr<const void>& message) override {
    type_.publish_shared(publisher_, message);
  }
  std::size_t subscribers() const override { return publisher_.getNumSubscribers(); }
  bool isSubscribedBy(const std::string& node) const override { return hasConnection(topic_, node); }
  const std::string& topic() const override { return topic_; }

 private:
  const MessageType& type_;
  ros::Publisher publisher_;
  std::string topic_;
};

class RosImagePublisher : public RawPublisher {
 public:
  RosImagePublisher(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue)
      : publisher_(image_transport::ImageTransport(node).advertise(topic, queue)), topic_(publisher_.getTopic()) {}

  void publish(const void* message) override { publisher_.publish(*static_cast<const sensor_msgs::Image*>(message)); }
  void publishShared(const boost::shared_ptr<const void>& message) override {
    publisher_.publish(boost::static_pointer_cast<const sensor_msgs::Image>(message));
  }
  std::size_t subscribers() const override { return publisher_.getNumSubscribers(); }
  bool isSubscribedBy(const std::string& node) const override { return hasConnection(topic_, node); }
  const std::string& topic() const override { return topic_; }

 private:
  image_transport::Publisher publisher_;
  std::string topic_;
};

/// The first callback of a thread that must not delay the node's loop.
class LowerPriority : public ros::CallbackInterface {
 public:
  CallResult call() override {
    preferForThread(Priority::kOrdinary);
    return Success;
  }
};

class RosSubscription : public RawSubscription {
 public:
  explicit RosSubscription(ros::Subscriber subscriber) : subscriber_(std::move(subscriber)) {}
  std::size_t publishers() const override { return subscriber_.getNumPublishers(); }

 private:
  ros::Subscriber subscriber_;
};

/// By a transport of image_transport other than `raw`, which does not tell who sends an image.
class PackedImageSubscription : public RawSubscription {
 public:
  PackedImageSubscription(ros::NodeHandle& node, const std::string& topic, std::uint32_t queue,
                          MessageRefusals& refusals, const RawHandler& handler)
      : subscriber_(image_transport::ImageTransport(node).subscribe(
            topic, queue, [this, topic, &refusals, handler](const sensor_msgs::ImageConstPtr& image) {
              if (publishers() > 1) {
                return refusals.add(topic, "it is published by " + std::to_string(publishers()) +
                                               " nodes: none counts until one of them is left (rostopic info " + topic +
                                               "; rosnode cleanup, if one was killed)");
              }
              handler({image, "", ros::Time::now(), false, nullptr});
            })) {}
  std::size_t publishers() const override { return subscriber_.getNumPublishers(); }

 private:
  image_transport::Subscriber subscriber_;
};

}  // namespace

RosBus::RosBus(Master master) : master_(master == Master::kWatched ? std::make_unique<MasterMonitor>() : nullptr) {}
RosBus::~RosBus() = default;

const std::string& RosBus::name() const { return ros::this_node::getName(); }
std::string RosBus::resolve(const std::string& name) const { return ros::names::resolve(name); }

YAML::Node RosBus::parameter(const std::string& name) const {
  XmlRpc::XmlRpcValue value;
  if (!ros::param::get(name == "~" ? this->name() : resolve(name), value)) return YAML::Node(YAML::NodeType::Null);
  return toYaml(value);
}

std::shared_ptr<RawPublisher> RosBus::advertiseRaw(const MessageType& type, const std::string& topic,
                                                   std::uint32_t queue, bool latch) {
  return std::make_shared<RosPublisher>(type, type.advertise(sampled_.node, resolve(topic), queue, latch));
}

std::shared_ptr<RawPublisher> RosBus::advertiseImages(const std::string& topic, std::uint32_t queue) {
  return std::make_shared<RosImagePublisher>(sampled_.node, topic, queue);
}

std::shared_ptr<RawSubscription> RosBus::subscribeRaw(const MessageType& type, const std::string& topic,
                                                      std::uint32_t queue, RawHandler handler, Serving serving) {
  const std::string resolved = resolve(topic);
  switch (serving) {
    case Serving::kOwnThread:
      return std::make_shared<RosSubscription>(type.subscribe(ownThread().node, resolved, queue, handler));
    case Serving::kSampled:
      return std::make_shared<RosSubscription>(type.subscribe(sampled_.node, resolved, queue, handler));
    default:
      driven_ = true;
      return std::make_shared<RosSubscription>(
          type.subscribe(waking_.node, resolved, queue, [this, handler](const RawDelivery& delivery) {
            handler(delivery);
            triggered_ = true;
          }));
  }
}

Subscription RosBus::subscribeImages(const std::string& topic, std::uint32_t queue, RawHandler handler) {
  if (image_transport::TransportHints().getTransport() == "raw") {
    const MessageType& type = messageType<sensor_msgs::Image>();
    return Subscription(subscribeRaw(type, topic, queue, std::move(handler), Serving::kSampled));
  }
  return Subscription(std::make_shared<PackedImageSubscription>(sampled_.node, topic, queue, refusals(), handler));
}

BusHandle RosBus::advertiseServiceRaw(const ServiceType& type, const std::string& service, RawAnswer answer,
                                      Serving serving) {
  ros::NodeHandle& node = serving == Serving::kOwnThread ? ownThread().node : sampled_.node;
  return std::make_shared<ros::ServiceServer>(type.advertise(node, resolve(service), answer));
}

bool RosBus::callRaw(const ServiceType& type, const std::string& service, void* call) {
  ros::NodeHandle node;
  return type.call(node, resolve(service), call);
}

BusHandle RosBus::timer(double period, std::function<void()> task) {
  return std::make_shared<ros::SteadyTimer>(sampled_.node.createSteadyTimer(
      ros::WallDuration(period), [task = std::move(task)](const ros::SteadyTimerEvent&) { task(); }));
}

std::vector<std::string> RosBus::publishersOf(const std::string& topic) const {
  return publishersAtMaster()[resolve(topic)];
}

void RosBus::setStep(double period, std::function<void(const ros::Time&)> step) {
  period_ = period;
  step_ = std::move(step);
}

bool RosBus::waitUntil(const std::function<bool()>& done, double timeout) {
  const ros::SteadyTime begin = steady();
  const ros::WallDuration wait(std::min(0.01, timeout));
  for (bool in_time = true; in_time && isRunning() && !done(); in_time = secondsBetween(begin, steady()) <= timeout)
    sampled_.queue.callAvailable(wait);
  return done();
}

void RosBus::pause(double seconds) { ros::WallDuration(seconds).sleep(); }

RosBus::Lane& RosBus::ownThread() {
  if (!own_) {
    own_ = std::make_unique<Lane>();
    own_->queue.addCallback(boost::make_shared<LowerPriority>());
    own_thread_ = std::make_unique<ros::AsyncSpinner>(1, &own_->queue);
    own_thread_->start();
  }
  return *own_;
}

bool RosBus::shouldContinue() {
  if (master_) master_->step(steady());
  if (master_ && master_->masterLostForLong() && !busy_) {
    ROS_ERROR("the ROS master has been away for too long, and nothing moves: this node ends");
    stopped_ = true;
  }
  return isRunning() && !shutdownRequested();
}

void RosBus::run() {
  // The first line of a node's log waits for a parameter of rosout from the master, so log it before
  // stepping.
  ROS_INFO("runs");
  step_ ? runSteps() : serveOnly();
  if (end_) end_();
}

void RosBus::runSteps() {
  constexpr int kLongSteps = 3;  // one behind the other; a single one is a stall
  int long_steps = 0;
  ros::SteadyTime deadline = steady();
  while (shouldContinue()) {
    const ros::WallDuration wait(secondsBetween(steady(), deadline));
    waking_.queue.callAvailable(std::clamp(wait, ros::WallDuration(0), kLongestWait));
    const ros::SteadyTime now = steady();
    if (!triggered_ && now < deadline) continue;
    // The node does not wait for an input that is late by half a period.
    deadline =
        driven_ ? now + ros::WallDuration((triggered_ ? 1.5 : 1.0) * period_) : deadline + ros::WallDuration(period_);
    if (deadline <= now) deadline = now + ros::WallDuration(period_);  // after a delay: do not catch up
    triggered_ = false;
    sampled_.queue.callAvailable();
    step_(this->now());
    // Where the processors do too much: a loop in real time that never sleeps would leave nothing to the ROS master.
    long_steps = secondsBetween(now, steady()) > period_ ? long_steps + 1 : 0;
    if (long_steps >= kLongSteps) pause(period_);
  }
}

void RosBus::serveOnly() {
  while (shouldContinue()) sampled_.queue.callAvailable(kLongestWait);
}

}  // namespace microinjection
