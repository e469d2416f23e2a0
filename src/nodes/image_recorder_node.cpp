#include "nodes/image_recorder_node.h"

#include <cv_bridge/cv_bridge.h>

#include <algorithm>
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <utility>

#include "base/atomic_file.h"
#include "base/errors.h"
#include "nodes/imaging/image_input.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr char kOverlayTopic[] = "vision/image_overlay";
constexpr double kRecorderReportPeriod = 0.2;  // s
constexpr int kRecordedImagesQueue = 10;

}  // namespace

const char* const ImageRecorderNode::kHelp =
    "image_recorder: records the images with what was found in them, and a snapshot of each event.\n"
    "In: vision/image_overlay /controller/injection_state.\n"
    "Out: overlay.avi, overlay.avi.csv and snapshots in output_dir.\n";

ImageRecorderNode::ImageRecorderNode(Bus& bus) : diagnostics_(bus) {
  ConfigReader reader = parameterReader(bus);
  reader.path("output_dir", folder_, ConfigReader::kRequired);
  reader.number("rate", rate_, Range::closed(1, 1000));
  reader.finish();
  requireWritableFolder(folder_);
  video_ = std::make_unique<VideoFile>(folder_ + "/overlay.avi", rate_);
  states_ =
      subscribeGuarded(bus, "/controller/injection_state", kRecordedImagesQueue, &ImageRecorderNode::onState, this);
  images_ = subscribeImages(bus, kOverlayTopic, kRecordedImagesQueue,
                            [this](const sensor_msgs::Image& message) { onImage(message); });
  diagnostics_.add("recording", [this](diagnostic_updater::DiagnosticStatusWrapper& status) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, video_->frames() > 0 ? "recording" : "waits for an image");
    if (!error_.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR, error_);
    status.add("frames", video_->frames());
    status.add("snapshots", snapshots_);
  });
  timer_ = bus.timer(kRecorderReportPeriod, [this] { diagnostics_.update(); });
}

void ImageRecorderNode::onState(const cell_microinjection::InjectionStatus& message) {
  if (message.state == state_) return;
  state_ = message.state;
  // The name becomes a part of a file's.
  const bool plain =
      !state_.empty() && std::all_of(state_.begin(), state_.end(), [](char c) { return c >= 'a' && c <= 'z'; });
  events_.push_back(plain ? state_ : "state");
}

void ImageRecorderNode::onImage(const sensor_msgs::Image& message) {
  try {
    const cv::Mat image = cv_bridge::toCvShare(message, boost::shared_ptr<void const>(), "bgr8")->image;
    video_->write(image, message.header.stamp.toSec());
    const std::vector<std::string> events = std::exchange(events_, {});
    for (const std::string& event : events) saveSnapshot(image, event);
    error_.clear();
  } catch (const std::exception& error) {
    error_ = error.what();
    throw;
  }
}

void ImageRecorderNode::saveSnapshot(const cv::Mat& image, const std::string& event) {
  char number[16];
  std::snprintf(number, sizeof number, "%03d", snapshots_);
  const std::string path = folder_ + "/snapshot_" + number + "_" + event + ".png";
  if (!cv::imwrite(path, image)) throw WriteError(path, "the file refuses the image");
  ++snapshots_;
}

}  // namespace microinjection
