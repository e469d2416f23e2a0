#include "virtual_session.h"

#include <algorithm>
#include <cstdlib>

#include "nodes/executive/node_registry.h"
#include "nodes/executive/session_nodes.h"

namespace microinjection {
namespace {

constexpr char kUserFolders[][16] = {"XDG_DATA_HOME", "XDG_CACHE_HOME", "ROS_HOME"};

std::filesystem::path temporaryFolder() {
  std::string path = (std::filesystem::temp_directory_path() / "session_test_XXXXXX").string();
  if (!mkdtemp(path.data())) throw std::runtime_error("no temporary folder: " + path);
  return path;
}

void merge(YAML::Node base, const YAML::Node& more) {
  for (const auto& entry : more) {
    const auto key = entry.first.as<std::string>();
    if (entry.second.IsMap() && base[key] && base[key].IsMap()) {
      merge(base[key], entry.second);
    } else {
      base[key] = entry.second;
    }
  }
}

/// Of an external rig all else is as for a simulated one, unless a test says otherwise.
std::vector<std::string> completed(std::vector<std::string> overrides) {
  if (std::find(overrides.begin(), overrides.end(), "rig.name:=external") == overrides.end()) return overrides;
  for (const std::string key : {"rig.allow_network:=true", "sensor.source:=simulated", "injector:=simulated",
                                "injection.auto_enable:=true", "injection.start_when_enabled:=true"}) {
    const auto is_of_key = [&](const std::string& other) { return other.rfind(key.substr(0, key.find('=')), 0) == 0; };
    if (std::none_of(overrides.begin(), overrides.end(), is_of_key)) overrides.push_back(key);
  }
  return overrides;
}

}  // namespace

HeardDiagnostics::HeardDiagnostics(Bus& bus) {
  subscription_ = bus.subscribe<diagnostic_msgs::DiagnosticArray>("/diagnostics", 0, [this](const auto& delivery) {
    for (const auto& status : delivery.message->status) {
      newest_[status.name] = status;
      said_[status.name].push_back(status.message);
    }
  });
}

const diagnostic_msgs::DiagnosticStatus* HeardDiagnostics::of(const std::string& name) const {
  const auto found = newest_.find(name);
  return found == newest_.end() ? nullptr : &found->second;
}

std::string HeardDiagnostics::text(const std::string& name) const {
  const auto* status = of(name);
  return status ? status->message : "";
}

std::string HeardDiagnostics::value(const std::string& name, const std::string& key) const {
  const auto* status = of(name);
  if (!status) return "";
  for (const auto& entry : status->values) {
    if (entry.key == key) return entry.value;
  }
  return "";
}

bool HeardDiagnostics::ever(const std::string& name, const std::string& text) const {
  const auto said = said_.find(name);
  if (said == said_.end()) return false;
  return std::any_of(said->second.begin(), said->second.end(),
                     [&](const std::string& message) { return message.find(text) != std::string::npos; });
}

void HeardDiagnostics::clear() {
  newest_.clear();
  said_.clear();
}

UserFolders::UserFolders() : path_(temporaryFolder()) {
  for (const char* name : kUserFolders) {
    if (const char* value = std::getenv(name)) before_[name] = value;
    setenv(name, path_.c_str(), 1);
  }
}

UserFolders::~UserFolders() {
  for (const char* name : kUserFolders) {
    const auto before = before_.find(name);
    before == before_.end() ? unsetenv(name) : setenv(name, before->second.c_str(), 1);
  }
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

VirtualSession::VirtualSession(const std::vector<std::string>& overrides, const std::string& file)
    : session_(Session::load(file, completed(overrides), MICROINJECTION_SOURCE_DIR)),
      plan_(planOf(session_, SessionClock::kVirtual)) {
  executive_.add("world", [this](Bus& bus) { return world_ = std::make_shared<TestNode>(bus); });
  executive_.add("diagnostics_probe",
                 [this](Bus& bus) { return diagnostics_ = std::make_shared<HeardDiagnostics>(bus); });
  if (session_.rig.external()) {
    stage_ = std::make_unique<LabStage>(plan_.parameters["robot_description"].Scalar());
    executive_.add("my_rig", [this](Bus& bus) { return std::make_shared<LabStageNode>(bus, *stage_); });
  }
  SessionPlan frames_only = plan_;
  frames_only.nodes.clear();
  addNodes(executive_, frames_only);
}

VirtualSession::~VirtualSession() {
  world_.reset();  // the executive's is the last one, and ends before its bus
  diagnostics_.reset();
  executive_.endAll();
}

YAML::Node VirtualSession::parameters(const std::string& name, const std::string& changes) const {
  const NodePlan* const node = plan_.node(name);
  if (!node) throw std::invalid_argument("the session has no node " + name);
  YAML::Node parameters = YAML::Clone(node->parameters);
  merge(parameters, YAML::Load(changes));
  return parameters;
}

void VirtualSession::add(const std::string& name, const std::string& changes) {
  const YAML::Node changed = parameters(name, changes);
  const NodePlan& node = *plan_.node(name);
  executive_.add(name, nodeFactory(node.program), changed, node.remaps);
  added_.push_back(name);
}

void VirtualSession::add(const std::string& name, const std::string& program, const YAML::Node& parameters,
                         const std::map<std::string, std::string>& remaps) {
  executive_.add(name, nodeFactory(program), parameters, remaps);
  added_.push_back(name);
}

void VirtualSession::start() {
  for (const NodePlan& node : plan_.nodes) {
    if (std::find(added_.begin(), added_.end(), node.name) == added_.end()) add(node.name);
  }
}

TestNode& VirtualSession::addTestNode(const std::string& name, double period) {
  std::shared_ptr<TestNode> node;
  executive_.add(name, [&](Bus& bus) { return node = std::make_shared<TestNode>(bus, period); });
  return *node;
}

void VirtualSession::checkFailures() {
  if (failures_expected_) return;
  for (const auto& [node, error] : executive_.failures())
    ADD_FAILURE() << "the node " << node << " has ended: " << error;
}

void VirtualSession::run(double seconds) {
  executive_.runFor(seconds);
  checkFailures();
}

bool VirtualSession::until(const std::function<bool()>& done, double limit) {
  const bool reached = executive_.runUntil(done, limit);
  checkFailures();
  return reached;
}

std::string testFile(const std::string& path) { return MICROINJECTION_SOURCE_DIR "/test/nodes/" + path; }

}  // namespace microinjection
