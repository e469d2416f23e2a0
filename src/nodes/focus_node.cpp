#include "nodes/focus_node.h"

#include <cmath>
#include <opencv2/core/utility.hpp>
#include <sstream>

#include "base/errors.h"
#include "nodes/imaging/image_input.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr double kFocusPeriod = 0.02;  // s, of a step
constexpr double kFarWindow = 1;       // px, of the window from the tip
constexpr int kFocusQueue = 1;

}  // namespace

const char* const FocusNode::kHelp =
    "focus: finds the plane in which the needle's tip is in focus.\n"
    "In: microscope/image_raw, vision/state, /focus/measured_js, /needle/measured_cp.\n"
    "Out: /focus/move_jp; action focus/find.\n";

FocusNode::Parameters FocusNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.number("image_timeout", parameters.image_timeout, Range::positive());
  reader.number("largest_motion", parameters.largest_motion, Range::positive());
  reader.integer("core", parameters.core, Range::closed(1, 100));
  parameters.search = FocusSearchConfig::read(reader);
  reader.finish();
  return parameters;
}

FocusNode::FocusNode(Bus& bus)
    : GoalNode(bus, "focus/find", "focus", kFocusPeriod),
      parameters_(Parameters::read(bus)),
      command_(bus.advertise<sensor_msgs::JointState>("/focus/move_jp", 1)),
      vision_(subscribeMeasured(bus, "vision/state", kFocusQueue, &FocusNode::onVision, this)),
      focus_state_(subscribeMeasured(bus, "/focus/measured_js", kFocusQueue, &FocusNode::onFocus, this)),
      needle_state_(subscribeMeasured(bus, "/needle/measured_cp", kFocusQueue, &FocusNode::onNeedle, this)) {
  cv::setNumThreads(1);  // the other cores belong to the nodes at 1 kHz
}

std::optional<double> FocusNode::position() const {
  if (isOld(focus_receipt_)) return std::nullopt;
  return focus_;
}

void FocusNode::onFocus(const sensor_msgs::JointState& message) {
  focus_.reset();
  if (message.position.size() != 1 || !std::isfinite(message.position[0]))
    return bus_.refusals().add("/focus/measured_js", "position must be one finite number");
  focus_receipt_ = receive(message.header.stamp);
  if (isOld(focus_receipt_)) return bus_.refusals().add("/focus/measured_js", "it is old");
  focus_ = message.position[0];
}

void FocusNode::onNeedle(const geometry_msgs::PoseStamped& message) {
  const auto pose = validPose(&message);
  needle_ = pose ? std::optional<Eigen::Vector3d>(pose->translation()) : std::nullopt;
  needle_receipt_ = receive(message.header.stamp);
}

void FocusNode::onVision(const cell_microinjection::VisionState& message) {
  tip_.reset();
  const auto& seen = message.injection_pipette;
  tip_receipt_ = receive(message.header.stamp);
  tip_reason_ = isOld(tip_receipt_) ? "the image is old, or stamped ahead" : seen.reason;
  if (isOld(tip_receipt_) || seen.verdict == seen.NOT_FOUND) return;
  seen_size_ = {static_cast<int>(message.width), static_cast<int>(message.height)};
  const Tip tip{message.header.stamp.toSec(), seen.verdict == seen.FOUND,
                TipInImage{{seen.x, seen.y}, seen.direction, parameters_.core}};
  tip_reason_ = "the tip's place is not finite";
  if (!std::isfinite(seen.x + seen.y + seen.direction)) return;
  tip_reason_ = seen.reason;
  tip_ = tip;
}

void FocusNode::onImage(const sensor_msgs::Image& message) {
  reading_.reset();
  image_problem_ = imageDefect(message);
  reading_receipt_ = receive(message.header.stamp);
  if (image_problem_.empty() && isOld(reading_receipt_)) image_problem_ = "the image is old, or stamped ahead";
  if (image_problem_.empty() && data_.step(message.data, 1)) image_problem_ = "the camera repeats its last image";
  if (!image_problem_.empty()) return bus_.refusals().add(kImageTopic, image_problem_);
  size_ = {static_cast<int>(message.width), static_cast<int>(message.height)};
  if (!sizeChange(first_size_, size_).empty()) return;  // the window is not of this one: the search ends
  image_problem_ = "its format is wrong";               // until it was read: cv_bridge throws
  const Frame frame(pixelsOf(message));
  image_problem_ = frame.refusal();
  if (!image_problem_.empty()) return;
  reading_ = FocusSearch::Reading{message.header.stamp.toSec(), coreSharpness(frame, window_)};
}

void FocusNode::begin(const Goal&) {
  const std::optional<double> start = position();
  if (!start) throw ConfigError("the focus axis does not answer: /focus/measured_js is silent, old or invalid");
  if (!tip_ || isOld(tip_receipt_))
    throw ConfigError("the tip is not seen: " + (tip_ ? "the image is old" : tip_reason_));
  // Without any manipulator nothing moves the needle.
  const bool known = needle_ && !isOld(needle_receipt_);
  if (needle_state_.publishers() > 0 && !known)
    throw ConfigError("/needle/measured_cp is silent or invalid: it is not known whether the needle rests");
  start_ = *start;
  repeated_ = false;
  planes_ = 0;
  needle_at_start_ = needle_;
  size_ = first_size_ = seen_size_;
  beginSearch(*start, *tip_);
  images_ =
      subscribeImages(bus_, kImageTopic, kFocusQueue, [this](const sensor_msgs::Image& message) { onImage(message); });
}

void FocusNode::beginSearch(double start, const Tip& tip) {
  window_ = tip.window;
  reading_.reset();
  verified_since_.reset();
  rough_.reset();
  search_ = std::make_unique<FocusSearch>(parameters_.search, start, start_);
}

void FocusNode::move(double position) {
  sensor_msgs::JointState message;
  message.header.stamp = bus_.now();
  message.name = {"focus"};
  message.position = {position};
  command_.publish(message);
}

void FocusNode::step() {
  if (!isActive()) return;
  if (needle_at_start_ && (!needle_ || isOld(needle_receipt_)))
    return finish(false, "the needle's position is not known any more");
  if (needle_ && needle_at_start_ && (*needle_ - *needle_at_start_).norm() > parameters_.largest_motion)
    return finish(false, "the needle moves: it must rest during the search");
  if (const std::string change = sizeChange(first_size_, size_); !change.empty()) return finish(false, change);
  const double now = bus_.now().toSec();
  if (rough_) return verify(now);
  const auto goal = search_->step({now, position(), isOld(reading_receipt_) ? std::nullopt : reading_, image_problem_});
  if (goal) move(*goal);
  if (!search_->failure().empty()) {
    rough_ = repeated_ ? std::nullopt : search_->sharpest();
    if (!rough_) return finish(false, search_->failure());
    move(*rough_);
    verified_since_ = now;
    return;
  }
  cell_microinjection::FindFocusFeedback feedback;
  feedback.plane = static_cast<int>(planes_ + search_->plane());
  feedback.planes = static_cast<int>(planes_ + search_->planes());
  feedback.height = position().value_or(std::nan(""));
  publishFeedback(feedback);
  if (search_->done()) verify(now);
}

void FocusNode::verify(double now) {
  if (!verified_since_) verified_since_ = now;
  const bool seen = tip_ && tip_->stamp > *verified_since_ + parameters_.search.settle_time && tip_->stamp <= now;
  if (!seen || !tip_->found) {
    if (now - *verified_since_ > parameters_.search.image_time)
      finish(false,
             "the tip is not found in the best plane: " + (tip_reason_.empty() ? "the images are stale" : tip_reason_));
    return;
  }
  const double beside = cv::norm(tip_->window.tip - window_.tip);
  if (beside <= kFarWindow && !rough_) return finish(true, search_->report().text);
  if (repeated_) {
    std::ostringstream text;
    text << "the tip is seen at another place in each plane: " << beside << " px beside";
    return finish(false, text.str());
  }
  repeated_ = true;
  planes_ += search_->plane();
  beginSearch(rough_.value_or(search_->report().height), *tip_);
}

FocusNode::Result FocusNode::end(bool success) {
  Result result;
  result.height = result.interval = result.tip_height = std::nan("");
  if (search_) result.planes = static_cast<int>(planes_ + search_->plane());
  if (success) {
    result.height = search_->report().height;
    result.interval = search_->report().interval.half();
    result.tip_height = result.height - start_;
  } else if (search_) {
    // A cancelled search stops where it is; after another failure the focus is where the user had it.
    move(isPreempted() ? position().value_or(start_) : start_);
  }
  search_.reset();
  images_.shutdown();
  return result;
}

void FocusNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, search_ ? "searches the focus" : "waits for a goal");
  if (search_ && !image_problem_.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, image_problem_);
  if (search_ && !position())
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR, "/focus/measured_js is silent");
  bus_.refusals().report(status);
  status.add("last goal", outcome());
  status.add("planes", search_ ? planes_ + search_->plane() : planes_);
}

}  // namespace microinjection
