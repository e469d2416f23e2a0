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

/// A message on its way, for tests that lose or damage it: see LocalNetwork::alter().
struct Passage {
  std::string sender;  ///< node
  boost::shared_ptr<const void> message;
  double delay = 0;  ///< s until it arrives, >= 0
};
/// The passages that leave where one was: none for a loss, two for a repetition, another message for damage.
using Alteration = std::function<std::vector<Passage>(const Passage&)>;

/// The topics, services, parameters and the virtual clock that the nodes of one process share: what the ROS master
/// and the network are for nodes on a RosBus. A message reaches all queues within publish(), unless a test has
/// altered its topic:
///
///     publish() --> unaltered: LocalBus::receive() of each subscription, at once
///         |
///         '-------> Alteration --> 0, 1, 2, ... passages --> flights_, by time of arrival
///                                                               |
///                                  nextArrival(), deliverDue() -+--> receive() of each subscription
///
/// A network that merely called functions would be simpler, and nodes would come to rely on what no real one gives:
/// an order of start that suits them, messages that are never lost, an object that both ends share. So this one keeps
/// what a node could notice on a RosBus, and test/nodes/bus/bus_contract.h holds both to it:
///
/// - a subscription gets messages from its connection on, and first the last message of each publisher that latches;
/// - a queue that is full drops its oldest message;
/// - a message is a copy, which its sender cannot change any more, with the sender's sequence number (one that is
///   published shared is no copy, and has the number that its sender wrote);
/// - a topic has any number of publishers and subscribers, of one type: others are reported and do not connect;
/// - a node that is gone has no ends of topics and services any more.
///
/// The time is also that of ros::Time::now(), because libraries such as actionlib read that. There is one such time
/// in a process, which therefore has one network at a time. All functions are for one thread.
///
/// @pre A network outlives its buses.
class LocalNetwork {
 public:
  /// `start`: above 0, which stands for a simulated clock that has not started.
  explicit LocalNetwork(const ros::Time& start);
  ~LocalNetwork();
  LocalNetwork(const LocalNetwork&) = delete;

  ros::Time now() const { return now_; }
  void setTime(const ros::Time& now);

  /// `node`: its full name, such as /vision. `parameters`: the node's own, a map; `remaps`: from and to resolved
  /// names.
  std::unique_ptr<LocalBus> connect(const std::string& node, const YAML::Node& parameters,
                                    const std::map<std::string, std::string>& remaps = {});
  /// Sets a parameter of the whole session, such as /robot_description.
  void setParameter(const std::string& name, const YAML::Node& value) { parameters_[name] = value; }
  YAML::Node parameter(const std::string& name) const;  ///< a copy; null: there is none

  /// From now on `alteration` decides what becomes of each message of a topic (resolved name); empty: each arrives as
  /// it is. The last message of a latching publisher, which a later subscriber gets, is not altered.
  /// @throws std::invalid_argument when nobody has published or subscribed the topic yet
  void alter(const std::string& topic, Alteration alteration);

  /// The time at which the first delayed message arrives; empty: there is none.
  std::optional<ros::Time> nextArrival() const;
  /// Has the delayed messages arrive whose time has come.
  void deliverDue();

  /// Counts the ends of topics that have come and gone: the Executive sorts its nodes anew when this number changes.
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
  /// A passage that has not arrived yet.
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
