#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nodes/bus/bus.h"

namespace microinjection {

class LocalBus;
struct LocalTopic;

/// What happens to a message on its way, for tests: see LocalNetwork::alter().
struct Passage {
  std::string sender;
  boost::shared_ptr<const void> message;
  double delay = 0;  ///< s until it arrives
};
/// The passages that leave where one was: none for a loss, two for a repetition, another message for damage.
using Alteration = std::function<std::vector<Passage>(const Passage&)>;

/// The topics, services, parameters and the virtual clock that the nodes of one process share: what the
/// ROS master and the network are for nodes on a RosBus. It keeps what a node could notice there:
///
/// - a subscription gets messages from its connection on, and first the last message of each publisher
///   that latches;
/// - a queue that is full drops its oldest message;
/// - a message is a copy, which its sender cannot change any more, with the sender's sequence number;
/// - a topic has any number of publishers and subscribers, of one type: others are reported and do not connect;
/// - a node that is gone has no ends of topics and services any more.
///
/// The time is also that of ros::Time::now(), for libraries that read it. One thread.
class LocalNetwork {
 public:
  explicit LocalNetwork(const ros::Time& start);
  ~LocalNetwork();
  LocalNetwork(const LocalNetwork&) = delete;

  ros::Time now() const { return now_; }
  void setTime(const ros::Time& now);

  /// `parameters`: the node's own; `remaps`: by resolved names.
  std::unique_ptr<LocalBus> connect(const std::string& node, const YAML::Node& parameters,
                                    const std::map<std::string, std::string>& remaps = {});
  /// Sets a parameter of the whole session, such as /robot_description.
  void setParameter(const std::string& name, const YAML::Node& value) { parameters_[name] = value; }
  YAML::Node parameter(const std::string& name) const;

  /// From now on `alteration` decides what becomes of each message of a topic; empty: nothing does.
  void alter(const std::string& topic, Alteration alteration);

  /// The time at which the first delayed message arrives; empty: there is none.
  std::optional<ros::Time> nextArrival() const;
  /// Has the delayed messages arrive whose time has come.
  void deliverDue();

  /// Counts the ends of topics that have come and gone.
  std::uint64_t changes() const { return changes_; }

 private:
  friend class LocalBus;
  friend class LocalPublisher;
  friend class LocalSubscription;
  struct Service {
    const ServiceType* type;
    LocalBus* owner;
    RawAnswer answer;
  };
  struct Flight {
    LocalTopic* topic;
    Passage passage;
    bool latched;
    std::uint64_t publisher;
  };

  LocalTopic* topic(const std::string& name, const MessageType& type);
  void send(LocalTopic& topic, std::uint64_t publisher, bool latched, const Passage& passage);

  ros::Time now_;
  std::map<std::string, std::unique_ptr<LocalTopic>> topics_;
  std::map<std::string, Service> services_;
  std::map<std::string, YAML::Node> parameters_;
  std::multimap<ros::Time, Flight> flights_;
  std::uint64_t publishers_ = 0;  ///< ever made, for their numbers
  std::uint64_t changes_ = 1;
};

}  // namespace microinjection
