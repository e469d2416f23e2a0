// A session on virtual time. Messages are bytes here, in ROS' own serialisation: cell_microinjection/session.py knows
// what they mean, from the classes that ROS has generated for Python.

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.h"
#include "nodes/executive/session_nodes.h"
#include "session/session.h"
#include "session/session_plan.h"

namespace microinjection {

namespace py = pybind11;

namespace {

constexpr char kNode[] = "python";  ///< the program's own node

class PySession {
 public:
  PySession(const std::string& session, const std::vector<std::string>& overrides,
            const std::vector<std::string>& without) {
    only_.emplace();
    Session loaded = Session::load(session, overrides);
    loaded.display.markers = false;  // nobody looks
    executive_ = std::make_unique<Executive>();
    executive_->add(kNode, [](Bus&) { return std::make_shared<int>(0); });
    SessionPlan plan = planOf(loaded, SessionClock::kVirtual);
    for (const std::string& name : without) leaveOut(plan, name);
    addNodes(*executive_, plan);
  }
  ~PySession() {
    is_running_ = false;  // nobody else has it any more
    close();
  }
  PySession(const PySession&) = delete;

  void close() {
    if (!executive_) return;
    executive();
    heard_.clear();
    said_.clear();
    executive_->endAll();
    executive_.reset();
    only_.reset();
  }

  void runFor(double seconds) {
    if (!(seconds >= 0) || seconds > 1e6) throw ConfigError("seconds: must be from 0 to 1e6");
    const double end = executive().time() + seconds;
    while (executive().time() < end - 1e-9) {
      const double stride = std::min(kStride, end - executive().time());
      {
        const Running running(*this);
        const py::gil_scoped_release others;
        executive_->runFor(stride);
      }
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    if (executive().failures().empty()) return;
    std::vector<std::string> texts;
    for (const auto& [node, error] : executive().failures()) texts.push_back(node + ": " + error);
    throw ConfigError(texts);
  }
  double time() { return executive().time(); }

  /// From now on the newest messages of a topic are kept.
  std::string listen(const std::string& topic, std::uint32_t queue) {
    LocalBus& bus = executive().bus(kNode);
    Heard& heard = heard_[topic];
    if (heard.type && (heard.queue == 0 || (queue > 0 && queue <= heard.queue))) return heard.type->name;
    const MessageType* type = bus.typeOf(topic);
    if (!type) {
      heard_.erase(topic);
      throw ConfigError("topic = " + topic + ": no node has it; there are: " + join(bus.topics(), ", "));
    }
    heard.type = type;
    heard.queue = queue;  // a larger one than before takes its place
    heard.subscription = bus.subscribeAny(*type, topic, queue, [&heard](const RawDelivery& delivery) {
      heard.messages.push_back(delivery.message);
      if (heard.queue > 0 && heard.messages.size() > heard.queue) heard.messages.pop_front();
      heard.newest = delivery.message;
    });
    return type->name;
  }
  py::object newest(const std::string& topic) {
    listen(topic, 1);
    const Heard& heard = heard_.at(topic);
    if (!heard.newest) return py::none();
    return py::bytes(heard.type->serialize(heard.newest.get()));
  }
  /// Those since the last call.
  py::list take(const std::string& topic) {
    py::list messages;
    executive();
    const auto found = heard_.find(topic);
    if (found == heard_.end()) throw ConfigError("topic = " + topic + ": listen() comes before take()");
    Heard& heard = found->second;
    for (const auto& message : heard.messages) messages.append(py::bytes(heard.type->serialize(message.get())));
    heard.messages.clear();
    return messages;
  }

  std::string typeOf(const std::string& topic) {
    const MessageType* type = executive().bus(kNode).typeOf(topic);
    if (!type)
      throw ConfigError("topic = " + topic +
                        ": no node has it; there are: " + join(executive().bus(kNode).topics(), ", "));
    return type->name;
  }
  void say(const std::string& topic, const std::string& bytes) {
    typeOf(topic);
    const MessageType* type = executive().bus(kNode).typeOf(topic);
    auto& publisher = said_[topic];
    if (!publisher) publisher = executive().bus(kNode).advertiseAny(*type, topic, 10);
    const auto message = type->deserialize(bytes);
    if (!message) throw ConfigError("topic = " + topic + ": the message is no " + type->name);
    publisher->publish(message.get());
  }
  std::vector<std::string> topics() { return executive().bus(kNode).topics(); }

  void freeze(const std::string& node) { known(node), executive().freeze(node); }
  void thaw(const std::string& node) { known(node), executive().thaw(node); }
  void kill(const std::string& node) { known(node), executive().kill(node); }
  void restart(const std::string& node) {
    if (node == kNode) throw ConfigError("node = " + node + ": is this program's own");
    try {
      executive().restart(node);
    } catch (const std::invalid_argument& error) {
      throw ConfigError("node = " + node + ": " + error.what());
    }
  }
  void delay(const std::string& node, double seconds) { known(node), executive().delay(node, seconds); }

 private:
  static constexpr double kStride = 0.1;  // s, between two looks at signals
  struct Heard {
    const MessageType* type = nullptr;
    std::uint32_t queue = 0;  ///< 0: all
    Subscription subscription;
    std::deque<boost::shared_ptr<const void>> messages;
    boost::shared_ptr<const void> newest;
  };

  static void leaveOut(SessionPlan& plan, const std::string& name) {
    const auto found =
        std::find_if(plan.nodes.begin(), plan.nodes.end(), [&](const NodePlan& node) { return node.name == name; });
    std::vector<std::string> names;
    for (const NodePlan& node : plan.nodes) names.push_back(node.name);
    if (found == plan.nodes.end())
      throw ConfigError("without = " + name + ": the session has no such node; there are: " + join(names, ", "));
    plan.nodes.erase(found);
  }

  /// There is one virtual clock in a process.
  struct Only {
    Only() {
      if (open) throw ConfigError("a session is open in this process: close it first, or take another process");
      open = true;
    }
    ~Only() { open = false; }
    Only(const Only&) = delete;
    inline static bool open = false;
  };
  /// While the nodes run, other threads of Python may, too.
  struct Running {
    explicit Running(PySession& session) : is_running(session.is_running_) { is_running = true; }
    ~Running() { is_running = false; }
    Running(const Running&) = delete;
    bool& is_running;
  };
  Executive& executive() {
    if (!executive_) throw ConfigError("the session is closed");
    if (is_running_) throw ConfigError("the session runs: another thread must wait until run_for() has ended");
    return *executive_;
  }
  void known(const std::string& node) {
    bool runs = false;
    if (node == kNode) throw ConfigError("node = " + node + ": is this program's own");
    try {
      runs = executive().runs(node);
    } catch (const std::invalid_argument&) {  // there is none of this name
    }
    if (!runs) throw ConfigError("node = " + node + ": the session has no such node that runs");
  }

  bool is_running_ = false;  ///< changed with the GIL only
  std::optional<Only> only_;
  std::unique_ptr<Executive> executive_;
  std::map<std::string, Heard> heard_;
  std::map<std::string, std::shared_ptr<RawPublisher>> said_;
};

}  // namespace
}  // namespace microinjection

PYBIND11_MODULE(_session, module) {
  using namespace microinjection;
  py::module_::import("cell_microinjection._core");  // registers the errors
  py::class_<PySession>(module, "Session")
      .def(py::init<const std::string&, const std::vector<std::string>&, const std::vector<std::string>&>(),
           py::arg("session"), py::arg("overrides"), py::arg("without"))
      .def("close", &PySession::close)
      .def("run_for", &PySession::runFor, py::arg("seconds"))
      .def_property_readonly("time", &PySession::time)
      .def("listen", &PySession::listen, py::arg("topic"), py::arg("queue") = 1)
      .def("newest", &PySession::newest, py::arg("topic"))
      .def("take", &PySession::take, py::arg("topic"))
      .def("type_of", &PySession::typeOf, py::arg("topic"))
      .def("say", &PySession::say, py::arg("topic"), py::arg("message"))
      .def_property_readonly("topics", &PySession::topics)
      .def("freeze", &PySession::freeze, py::arg("node"))
      .def("thaw", &PySession::thaw, py::arg("node"))
      .def("kill", &PySession::kill, py::arg("node"))
      .def("restart", &PySession::restart, py::arg("node"))
      .def("delay", &PySession::delay, py::arg("node"), py::arg("seconds"));
}
