#include "nodes/imaging/served_cell.h"

#include <atomic>

#include "base/errors.h"
#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr char kService[] = "/cell_simulator/set_cell_parameters";
constexpr double kPeriod = 0.01;  // s, of looking whether the answer has come

}  // namespace

struct ServedCell::Call {
  cell_microinjection::SetCellParameters parameters;
  ros::SteadyTime begin = ros::SteadyTime::now();
  bool answered = false;
  std::atomic<bool> done{false};  ///< what is above is complete
};

ServedCell::ServedCell(ros::NodeHandle node, double timeout) : node_(node), timeout_(timeout) {}

ServedCell::~ServedCell() {
  // Ends a call that waits. The node is ending, so that nothing else needs ROS any more.
  if (isPending()) ros::shutdown();
  if (thread_.joinable()) thread_.join();
}

bool ServedCell::isPending() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return call_ && !call_->done;
}

std::string ServedCell::change(const std::vector<std::string>& names, const std::vector<double>& values) {
  if (isPending()) throw ConfigError("cell_simulator has not answered an earlier request yet");
  if (thread_.joinable()) thread_.join();
  const auto call = std::make_shared<Call>();
  call->parameters.request.name = names;
  call->parameters.request.value = values;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    call_ = call;
  }
  thread_ = std::thread([node = node_, call]() mutable {
    auto client = node.serviceClient<cell_microinjection::SetCellParameters>(kService);
    call->answered = client.call(call->parameters);
    call->done = true;
  });
  while (!call->done && ros::ok() && secondsBetween(call->begin, ros::SteadyTime::now()) < timeout_)
    ros::WallDuration(kPeriod).sleep();
  if (!call->done)
    throw ConfigError("cell_simulator does not answer within " + std::to_string(timeout_) +
                      " s; it may still take the change over");
  if (!call->answered) throw ConfigError("cell_simulator does not answer");
  if (!call->parameters.response.success) throw ConfigError(call->parameters.response.message);
  return call->parameters.response.message;
}

void ServedCell::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool pending = call_ && !call_->done;
  const double age = pending ? secondsBetween(call_->begin, ros::SteadyTime::now()) : 0;
  if (age > timeout_) {
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, "cell_simulator does not answer");
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, pending ? "waits for cell_simulator" : "no request waits");
  }
  status.add("age of the request (s)", age);
}

}  // namespace microinjection
