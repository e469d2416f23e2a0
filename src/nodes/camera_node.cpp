#include "nodes/camera_node.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>

#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/orphan.h"
#include "nodes/runtime/run_node.h"

namespace microinjection {
namespace {

constexpr double kReportPeriod = 0.2;    // s of wall time
constexpr double kRepeated = 0.005;      // s, after a frame that was repeated
constexpr double kEndPatience = 1;       // s, at the end, for a read that is under way
constexpr double kRetry = 0.5;           // s, before a device is opened again
constexpr double kLargestExposure = 10;  // s ago; a larger difference means that the driver has another clock

FrameSourceConfig readSource(ConfigReader& reader, double& silence) {
  reader.number("silence", silence, Range::positive());
  FrameSourceConfig config = FrameSourceConfig::read(reader);
  reader.finish();
  return config;
}

/// V4L2 stamps frames on the monotonic clock.
ros::Time exposureTime(const CameraFrame& frame, double period) {
  const ros::Time now = ros::Time::now();
  if (period > 0 || !frame.stamp) return now;
  const double age = 1e-9 * static_cast<double>(ros::SteadyTime::now().toNSec()) - *frame.stamp;
  return age >= 0 && age < kLargestExposure ? now - ros::Duration(age) : now;
}

}  // namespace

const char* const CameraNode::kHelp =
    "camera: a camera of the microscope, a folder of images or a video.\n"
    "Out: microscope/image_raw microscope/camera_info.\n";

CameraNode::CameraNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : images_(node), reported_(ros::SteadyTime::now()), diagnostics_(node, private_node) {
  ConfigReader reader = parameterReader(private_node);
  const FrameSourceConfig config = readSource(reader, silence_);
  stream_ = std::make_unique<CameraStream>(config, [config] { return makeFrameSource(config); });
  diagnostics_.setHardwareID(config.source == "device" ? config.device.device : config.path);
  diagnostics_.add("frames", this, &CameraNode::report);
  published_ = static_cast<std::int64_t>(reported_.toNSec());
  timer_ = node.createSteadyTimer(ros::WallDuration(kReportPeriod), [this](const ros::SteadyTimerEvent&) {
    diagnostics_.update();
    endIfOrphaned(master_);
  });
  thread_ = std::thread([this] {
    grab();
    stopped_ = true;
  });
}

CameraNode::~CameraNode() {
  stop_ = true;
  const ros::SteadyTime begin = ros::SteadyTime::now();
  while (thread_.joinable() && !stopped_ && secondsBetween(begin, ros::SteadyTime::now()) < kEndPatience)
    ros::WallDuration(kRepeated).sleep();
  if (thread_.joinable() && !stopped_) {
    ROS_WARN("the camera's read does not return: this process ends without it");
    ros::shutdown();
    std::_Exit(EXIT_SUCCESS);  // no destructors: the thread still uses what they would destroy
  }
  if (thread_.joinable()) thread_.join();
}

void CameraNode::run() { ros::spin(); }

void CameraNode::grab() {
  auto due = std::chrono::steady_clock::now();
  const auto period =
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(stream_->period()));
  while (!stop_ && ros::ok()) {
    const unsigned repeated = stream_->state().repeated;
    const std::optional<CameraFrame> frame = stream_->next();
    const CameraStreamState state = stream_->state();
    if (state.ended) return;
    if (!frame) {
      ros::WallDuration(state.repeated == repeated ? kRetry : kRepeated).sleep();
      continue;
    }
    due = std::max(due + period, std::chrono::steady_clock::now() - period);  // after a stall: do not catch up
    std::this_thread::sleep_until(due);
    runGuarded("microscope/image_raw", [&] {
      images_.publish(frame->image, exposureTime(*frame, stream_->period()));
      published_ = static_cast<std::int64_t>(ros::SteadyTime::now().toNSec());
    });
  }
}

void CameraNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const CameraStreamState state = stream_->state();
  const double age = 1e-9 * static_cast<double>(static_cast<std::int64_t>(now.toNSec()) - published_);
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "publishing");
  if (!state.report.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, state.report);
  if (state.ended) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "the recording has ended");
  } else if (age > silence_) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR,
                        state.repeated > 0 ? "the camera repeats its last frame" : "the camera delivers no frame");
  }
  MessageRefusals::ofProcess().report(status);
  status.add("rate (Hz)", (state.frames - reported_frames_) / std::max(1e-9, secondsBetween(reported_, now)));
  status.add("frames", state.frames);
  status.add("repeated frames, dropped", state.repeated);
  status.add("times opened", state.opened);
  status.add("age of the last frame (s)", age);
  reported_frames_ = state.frames;
  reported_ = now;
}

}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::CameraNode>(argc, argv, "camera", microinjection::Priority::kOrdinary);
}
