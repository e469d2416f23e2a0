#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "nodes/bus/local_bus.h"

namespace microinjection {

/// Makes a node on a bus, which outlives it. The destructor of what it returns ends the node; nobody else may hold
/// it.
using NodeFactory = std::function<std::shared_ptr<void>(Bus&)>;

/// A factory of a node class.
template <typename Node>
NodeFactory makeNode() {
  return [](Bus& bus) { return std::make_shared<Node>(bus); };
}

/// The nodes of a session in one thread, on virtual time: the same messages in every run, as fast as one core allows.
/// Tests, training runs and searches over many cells run sessions in this way.
///
///     instant 1    hand --> bridge --> controller --> micromanipulator --> cell --> sensor
///                                                                                      |
///     instant 2    hand --> bridge ...  <---------- force: feedback -------------------'
///
/// Time goes from one instant at which something is due to the next one. A common tick would be simpler; but each
/// node has its own rate, and the microscope at 30 Hz and the controller at 1 kHz have none in common. Within an
/// instant the nodes that are due have their turns in the order of the data flow: a node after those that publish its
/// kDrives inputs, others in the order in which they were added. What a node publishes arrives at once: downstream in
/// the same instant and upstream, as feedback, at the next step. A thread for each node would be nearer to a live
/// session, but its order is that of the machine, and no two runs would be alike.
///
/// Nodes without steps serve a message in the instant of its arrival, in further passes over all nodes, until none
/// has anything to do. doc/design/bus_and_executive.md has the table of inputs and the limits of virtual time.
///
/// A node that throws ends alone, as its process would; failures() has what it threw. Tests freeze, delay, kill and
/// restart nodes, and alter messages (network().alter()). Functions that name a node throw std::invalid_argument when
/// there is none of that name, or when it has ended and the function needs a living one.
class Executive {
 public:
  /// Virtual time begins at `start` (s). A simulated clock at 0 has not started.
  explicit Executive(double start = 1);
  ~Executive();
  Executive(const Executive&) = delete;

  LocalNetwork& network() { return network_; }
  double time() const;  ///< s since the start

  /// Constructs a node. `name`: without '/'; `parameters`: its private ones; `remaps`: from and to resolved names.
  /// @throws ConfigError naming the node when its constructor throws, std::invalid_argument when there is one of this
  ///   name
  void add(const std::string& name, NodeFactory factory, const YAML::Node& parameters = YAML::Node(YAML::NodeType::Map),
           const std::map<std::string, std::string>& remaps = {});

  /// Runs for this long (s). @throws ConfigError when nodes drive each other in a circle, or answer each other
  /// without end within an instant
  void runFor(double seconds);
  /// Runs until `done`, which is asked between instants, at the most for `limit` (s). @returns done()
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
  LocalBus& bus(const std::string& name);  ///< of a node that has not ended

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
