#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "lab_stage.h"
#include "nodes/executive/executive.h"
#include "session/session.h"
#include "session/session_plan.h"
#include "test_node.h"

namespace microinjection {

/// What nodes say on /diagnostics.
class HeardDiagnostics {
 public:
  explicit HeardDiagnostics(Bus& bus);

  /// The newest status, such as "haptic_bridge: loop"; null: none yet.
  const diagnostic_msgs::DiagnosticStatus* of(const std::string& name) const;
  /// Its message; empty: none yet.
  std::string text(const std::string& name) const;
  /// A value of it by its key; empty: there is none.
  std::string value(const std::string& name, const std::string& key) const;
  /// Whether a message of this status has ever contained a text, since the last clear().
  bool ever(const std::string& name, const std::string& text) const;
  void clear();

 private:
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> newest_;
  std::map<std::string, std::vector<std::string>> said_;
  Subscription subscription_;
};

/// A folder for the files that nodes keep for a user; it ends with this object.
class UserFolders {
 public:
  UserFolders();
  ~UserFolders();
  UserFolders(const UserFolders&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::map<std::string, std::string> before_;  ///< the environment
};

/// Nodes in this process, on virtual time, with the parameters that a session gives them, and the test's own node,
/// "world". Files that nodes keep for a user go into a folder of the test's own.
///
/// Nodes are taken from the plan of a session file (default: config/sessions/default.yaml), with overrides such as
/// "hand.device:=none": all of them at once with start(), or one by one with add(), each with changed parameters. With
/// rig.name:=external a stage and its node, "my_rig", take part, with the simulated sensor and injector.
class VirtualSession {
 public:
  explicit VirtualSession(const std::vector<std::string>& overrides = {}, const std::string& file = "default");
  ~VirtualSession();
  VirtualSession(const VirtualSession&) = delete;

  /// Adds all nodes of the plan that were not added yet, in its order.
  void start();
  /// Adds a node of the plan, by its name. `changes`: YAML, which its parameters take over key by key.
  void add(const std::string& name, const std::string& changes = "{}");
  /// Adds a node that the plan does not have, with just these parameters.
  void add(const std::string& name, const std::string& program, const YAML::Node& parameters,
           const std::map<std::string, std::string>& remaps = {});
  /// The parameters that add() would give.
  YAML::Node parameters(const std::string& name, const std::string& changes = "{}") const;
  /// A second node of the test's own; `period`: s, of its steps.
  TestNode& addTestNode(const std::string& name, double period = 1e-3);

  TestNode& world() { return *world_; }
  /// Null unless the rig is external.
  LabStage* stage() { return stage_.get(); }
  Executive& executive() { return executive_; }
  const HeardDiagnostics& diagnostics() const { return *diagnostics_; }
  HeardDiagnostics& diagnostics() { return *diagnostics_; }
  const Session& session() const { return session_; }
  /// A folder that ends with the session.
  const std::filesystem::path& folder() const { return folders_.path(); }
  ros::Time now() const { return world_->bus().now(); }

  /// Fails the test when a node ends by an error that was not expected, see expectFailure().
  void run(double seconds);
  bool until(const std::function<bool()>& done, double limit = 20);
  void expectFailures() { failures_expected_ = true; }

  template <typename Service>
  typename Service::Response call(const std::string& service, const typename Service::Request& request = {}) {
    Service call;
    call.request = request;
    EXPECT_TRUE(world_->bus().call(service, call)) << service << " does not answer";
    return call.response;
  }

 private:
  void checkFailures();

  UserFolders folders_;
  Session session_;
  SessionPlan plan_;
  Executive executive_;
  std::unique_ptr<LabStage> stage_;
  std::shared_ptr<TestNode> world_;
  std::shared_ptr<HeardDiagnostics> diagnostics_;
  std::vector<std::string> added_;
  bool failures_expected_ = false;
};

/// The path of a file below test/nodes.
std::string testFile(const std::string& path);

}  // namespace microinjection
