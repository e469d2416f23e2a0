#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "nodes/bus/local_bus.h"

namespace microinjection {

/// Makes a node on a bus; its destructor ends the node.
using NodeFactory = std::function<std::shared_ptr<void>(Bus&)>;

/// A factory of a node class.
template <typename Node>
NodeFactory makeNode() {
  return [](Bus& bus) { return std::make_shared<Node>(bus); };
}

/// The nodes of a session in one thread, on virtual time: the same messages in every run.
///
/// Time goes from one instant at which something is due to the next. At each instant the nodes that are
/// due step in the order of the data flow: a node after those that publish its kDrives inputs, others in
/// the order in which they were added. What a node publishes arrives at once: downstream in the same
/// instant, and upstream, as feedback, at the next step. Nodes without steps serve a message in the
/// instant of its arrival.
///
/// A node that throws ends, as its process would; failures() tells. Tests freeze, delay, kill and restart
/// nodes, and alter messages (network().alter()).
class Executive {
 public:
  /// Virtual time begins at `start` (s). A simulated clock at 0 has not started.
  explicit Executive(double start = 1);
  ~Executive();
  Executive(const Executive&) = delete;

  LocalNetwork& network() { return network_; }
  double time() const;  ///< s since the start

  /// Constructs a node. @throws ConfigError naming the node that failed, std::invalid_argument when there
  /// is one of this name
  void add(const std::string& name, NodeFactory factory, const YAML::Node& parameters = YAML::Node(YAML::NodeType::Map),
           const std::map<std::string, std::string>& remaps = {});

  /// @throws ConfigError when nodes drive each other in a circle, or answer each other without end
  void runFor(double seconds);
  /// Runs until `done`, at the most for `limit` (s). @returns done()
  bool runUntil(const std::function<bool()>& done, double limit);

  void freeze(const std::string& name);   ///< as SIGSTOP: it neither steps nor serves, messages wait
  void thaw(const std::string& name);     ///< as SIGCONT
  void kill(const std::string& name);     ///< as SIGKILL: the others hear nothing of its end
  void end(const std::string& name);      ///< as SIGTERM: in good order
  void restart(const std::string& name);  ///< constructs it again, with the same parameters
  void restart(const std::string& name, const YAML::Node& parameters);
  void delay(const std::string& name, double seconds);  ///< it steps `seconds` late, once
  void loseMaster(bool lost);                           ///< of all nodes
  /// Ends all nodes in good order, the last added first.
  void endAll();

  bool runs(const std::string& name) const;
  /// What nodes that have ended by themselves threw, by name.
  const std::map<std::string, std::string>& failures() const { return failures_; }
  LocalBus& bus(const std::string& name);

 private:
  struct Member {
    std::string name;
    NodeFactory factory;
    YAML::Node parameters;
    std::map<std::string, std::string> remaps;
    std::unique_ptr<LocalBus> bus;
    std::shared_ptr<void> node;  ///< null: it has ended; destroyed before its bus, and held by nobody else then
  };

  Member& member(const std::string& name);
  void construct(Member& member);
  void destroy(Member& member);
  /// Sorts order_ by the data flow.
  void sort();
  bool advance(const ros::Time& limit);
  void runInstant();
  bool run(Member& member);

  LocalNetwork network_;
  ros::Time start_;
  std::vector<std::unique_ptr<Member>> members_;
  std::vector<Member*> order_;
  std::uint64_t sorted_ = 0;  ///< the network's changes() that order_ knows
  std::map<std::string, std::string> failures_;
};

}  // namespace microinjection
