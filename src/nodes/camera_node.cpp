#include "nodes/camera_node.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>

#include "base/errors.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kCameraReportPeriod = 0.2;  // s of wall time
constexpr double kRepeated = 0.005;          // s, after a frame that was repeated
constexpr double kEndPatience = 1;           // s, at the end, for a read that is under way
constexpr double kRetry = 0.5;               // s, before a device is opened again
constexpr double kLargestExposure = 10;      // s ago; a larger difference means that the driver has another clock

FrameSourceConfig readSource(ConfigReader& reader, double& silence) {
  reader.number("silence", silence, Range::positive());
  FrameSourceConfig config = FrameSourceConfig::read(reader);
  reader.finish();
  return config;
}

}  // namespace

const char* const CameraNode::kHelp =
    "camera: a camera of the microscope, a folder of images or a video.\n"
    "Out: microscope/image_raw microscope/camera_info.\n";

CameraNode::CameraNode(Bus& bus) : bus_(bus), images_(bus), reported_(bus.steady()), diagnostics_(bus) {
  ConfigReader reader = parameterReader(bus);
  const FrameSourceConfig config = readSource(reader, silence_);
  if (bus.isVirtual() && config.source == "device")
    throw ConfigError(bus.name() + ": source = device (" + config.device.device +
                      "): a camera does not follow virtual time; allowed are folder and video");
  stream_ = std::make_unique<CameraStream>(config, [config] { return makeFrameSource(config); });
  diagnostics_.add("frames", this, &CameraNode::report);
  published_ = static_cast<std::int64_t>(reported_.toNSec());
  timer_ = bus.timer(kCameraReportPeriod, [this] { diagnostics_.update(); });
  if (bus.isVirtual()) {
    frames_ = bus.timer(stream_->period(), [this] {
      if (stream_->state().ended) return;
      if (const std::optional<CameraFrame> frame = stream_->next()) publish(*frame);
    });
    return;
  }
  thread_ = std::thread([this] {
    grab();
    stopped_ = true;
  });
}

CameraNode::~CameraNode() {
  stop_ = true;
  const ros::SteadyTime begin = bus_.steady();
  while (thread_.joinable() && !stopped_ && secondsBetween(begin, bus_.steady()) < kEndPatience) bus_.pause(kRepeated);
  if (thread_.joinable() && !stopped_) {
    ROS_WARN("the camera's read does not return: this process ends without it");
    bus_.leave();
    std::_Exit(EXIT_SUCCESS);  // no destructors: the thread still uses what they would destroy
  }
  if (thread_.joinable()) thread_.join();
}

void CameraNode::grab() {
  auto due = std::chrono::steady_clock::now();
  const auto period =
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(stream_->period()));
  while (!stop_ && bus_.isRunning()) {
    const unsigned repeated = stream_->state().repeated;
    const std::optional<CameraFrame> frame = stream_->next();
    const CameraStreamState state = stream_->state();
    if (state.ended) return;
    if (!frame) {
      bus_.pause(state.repeated == repeated ? kRetry : kRepeated);
      continue;
    }
    due = std::max(due + period, std::chrono::steady_clock::now() - period);  // after a stall: do not catch up
    std::this_thread::sleep_until(due);
    publish(*frame);
  }
}

/// V4L2 stamps frames on the monotonic clock.
ros::Time CameraNode::exposureTime(const CameraFrame& frame) const {
  const ros::Time now = bus_.now();
  if (stream_->period() > 0 || !frame.stamp) return now;
  const double age = 1e-9 * static_cast<double>(bus_.steady().toNSec()) - *frame.stamp;
  return age >= 0 && age < kLargestExposure ? now - ros::Duration(age) : now;
}

void CameraNode::publish(const CameraFrame& frame) {
  runGuarded(bus_.refusals(), "microscope/image_raw", [&] {
    images_.publish(frame.image, exposureTime(frame));
    published_ = static_cast<std::int64_t>(bus_.steady().toNSec());
  });
}

void CameraNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ros::SteadyTime now = bus_.steady();
  const CameraStreamState state = stream_->state();
  const double age = 1e-9 * static_cast<double>(static_cast<std::int64_t>(now.toNSec()) - published_);
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "publishing");
  if (!state.settings.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, state.settings);
  if (!state.report.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, state.report);
  if (state.ended) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, "the recording has ended");
  } else if (age > silence_) {
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR,
                        state.repeated > 0 ? "the camera repeats its last frame" : "the camera delivers no frame");
  }
  bus_.refusals().report(status);
  status.add("rate (Hz)", (state.frames - reported_frames_) / std::max(1e-9, secondsBetween(reported_, now)));
  status.add("frames", state.frames);
  if (!state.has.empty()) status.add("the camera has", state.has);
  status.add("repeated frames, dropped", state.repeated);
  status.add("times opened", state.opened);
  status.add("age of the last frame (s)", age);
  reported_frames_ = state.frames;
  reported_ = now;
}

}  // namespace microinjection
