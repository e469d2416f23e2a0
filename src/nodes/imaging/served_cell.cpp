#include "nodes/imaging/served_cell.h"

#include <atomic>

#include "base/errors.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr char kService[] = "/cell_simulator/set_cell_parameters";
constexpr double kAnswerCheckPeriod = 0.01;  // s, of looking whether the answer has come

}  // namespace

struct ServedCell::Call {
  cell_microinjection::SetCellParameters parameters;
  ros::SteadyTime begin;
  bool answered = false;
  std::atomic<bool> done{false};  ///< what is above is complete

  void make(Bus& bus) {
    answered = bus.call(kService, parameters);
    done = true;
  }
};

ServedCell::ServedCell(Bus& bus, double timeout) : bus_(bus), timeout_(timeout) {}

ServedCell::~ServedCell() {
  // Ends a call that waits. The node is ending, so that nothing else needs the bus any more.
  if (isPending()) bus_.leave();
  if (thread_.joinable()) thread_.join();
}

bool ServedCell::isPending() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return call_ && !call_->done;
}

std::string ServedCell::change(const std::vector<std::string>& names, const std::vector<double>& values) {
  if (isPending()) throw ConfigError("cell_simulator has not answered an earlier request yet");
  const auto call = std::make_shared<Call>();
  call->parameters.request.name = names;
  call->parameters.request.value = values;
  call->begin = bus_.steady();
  bus_.isVirtual() ? call->make(bus_) : callInThread(call);
  if (!call->done)
    throw ConfigError("cell_simulator does not answer within " + std::to_string(timeout_) +
                      " s; it may still take the change over");
  if (!call->answered) throw ConfigError("cell_simulator does not answer");
  if (!call->parameters.response.success) throw ConfigError(call->parameters.response.message);
  return call->parameters.response.message;
}

void ServedCell::callInThread(const std::shared_ptr<Call>& call) {
  if (thread_.joinable()) thread_.join();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    call_ = call;
  }
  thread_ = std::thread([this, call] { call->make(bus_); });
  while (!call->done && bus_.isRunning() && secondsBetween(call->begin, bus_.steady()) < timeout_)
    bus_.pause(kAnswerCheckPeriod);
}

void ServedCell::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool pending = call_ && !call_->done;
  const double age = pending ? secondsBetween(call_->begin, bus_.steady()) : 0;
  if (age > timeout_) {
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "cell_simulator does not answer");
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, pending ? "waits for cell_simulator" : "no request waits");
  }
  status.add("age of the request (s)", age);
}

}  // namespace microinjection
