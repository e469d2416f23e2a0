#include "nodes/focus_node.h"

#include <cmath>
#include <opencv2/core/utility.hpp>
#include <sstream>

#include "nodes/imaging/image_input.h"
#include "nodes/runtime/conversions.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/orphan.h"
#include "nodes/runtime/run_node.h"

namespace microinjection {
namespace {

constexpr char kImageTopic[] = "microscope/image_raw";
constexpr double kPeriod = 0.02;  // s of wall time, of a step
constexpr double kFarWindow = 1;  // px, of the window from the tip
constexpr int kQueue = 1;

}  // namespace

const char* const FocusNode::kHelp =
    "focus: finds the plane in which the needle's tip is in focus.\n"
    "In: microscope/image_raw, vision/state, /focus/measured_js, /needle/measured_cp.\n"
    "Out: /focus/move_jp; action focus/find.\n";

FocusNode::Parameters FocusNode::readParameters(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.number("image_timeout", parameters.image_timeout, Range::positive());
  reader.number("largest_motion", parameters.largest_motion, Range::positive());
  reader.integer("core", parameters.core, Range::closed(1, 100));
  parameters.search = FocusSearchConfig::read(reader);
  reader.finish();
  return parameters;
}

FocusNode::FocusNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(readParameters(private_node)),
      node_(node),
      transport_(node),
      command_(node.advertise<sensor_msgs::JointState>("/focus/move_jp", 1)),
      action_(node, "focus/find", false),
      diagnostics_(node, private_node) {
  cv::setNumThreads(1);  // the other cores belong to the nodes at 1 kHz
  subscribers_ = {
      subscribeGuarded<cell_microinjection::VisionState>(
          node, "vision/state", kQueue,
          [this](const cell_microinjection::VisionState& message, const std::string&) { onVision(message); }),
      subscribeGuarded<sensor_msgs::JointState>(
          node, "/focus/measured_js", kQueue,
          [this](const sensor_msgs::JointState& message, const std::string&) { onFocus(message); }),
      subscribeGuarded<geometry_msgs::PoseStamped>(
          node, "/needle/measured_cp", kQueue,
          [this](const geometry_msgs::PoseStamped& message, const std::string&) { onNeedle(message); })};
  action_.registerGoalCallback([this] { onGoal(); });
  action_.registerPreemptCallback([this] {
    if (search_) end(false, "cancelled");
  });
  action_.start();
  diagnostics_.setHardwareID("none");
  diagnostics_.add("focus", this, &FocusNode::report);
  timer_ = node.createSteadyTimer(ros::WallDuration(kPeriod), [this](const ros::SteadyTimerEvent&) { step(); });
}

void FocusNode::run() { ros::spin(); }

std::optional<double> FocusNode::position() const {
  if (isOld(focus_arrival_)) return std::nullopt;
  return focus_;
}

void FocusNode::onFocus(const sensor_msgs::JointState& message) {
  focus_.reset();
  if (message.position.size() != 1 || !std::isfinite(message.position[0]))
    return MessageRefusals::ofProcess().add("/focus/measured_js", "position must be one finite number");
  focus_arrival_ = Arrival(message.header.stamp);
  if (isOld(focus_arrival_)) return MessageRefusals::ofProcess().add("/focus/measured_js", "it is old");
  focus_ = message.position[0];
}

void FocusNode::onNeedle(const geometry_msgs::PoseStamped& message) {
  const auto pose = validPose(&message);
  needle_ = pose ? std::optional<Eigen::Vector3d>(pose->translation()) : std::nullopt;
  needle_arrival_ = Arrival(message.header.stamp);
}

void FocusNode::onVision(const cell_microinjection::VisionState& message) {
  tip_.reset();
  const auto& seen = message.injection_pipette;
  tip_arrival_ = Arrival(message.header.stamp);
  tip_reason_ = isOld(tip_arrival_) ? "the image is old, or stamped ahead" : seen.reason;
  if (isOld(tip_arrival_) || seen.verdict == seen.NOT_FOUND) return;
  const Tip tip{message.header.stamp.toSec(), seen.verdict == seen.FOUND,
                TipWindow{{seen.x, seen.y}, seen.direction, parameters_.core}};
  tip_reason_ = "the tip's place is not finite";
  if (!std::isfinite(seen.x + seen.y + seen.direction)) return;
  tip_reason_ = seen.reason;
  tip_ = tip;
}

void FocusNode::onImage(const sensor_msgs::Image& message) {
  reading_.reset();
  blind_ = imageDefect(message);
  reading_arrival_ = Arrival(message.header.stamp);
  if (blind_.empty() && isOld(reading_arrival_)) blind_ = "the image is old, or stamped ahead";
  if (blind_.empty() && message.data == last_data_) blind_ = "the camera repeats its last image";
  if (!blind_.empty()) return MessageRefusals::ofProcess().add(kImageTopic, blind_);
  last_data_ = message.data;
  blind_ = "its format is wrong";  // until it was read: cv_bridge throws
  const Frame frame(pixelsOf(message));
  blind_ = frame.refusal();
  if (!blind_.empty()) return;
  reading_ = FocusSearch::Reading{message.header.stamp.toSec(), coreSharpness(frame, window_)};
}

void FocusNode::onGoal() {
  action_.acceptNewGoal();
  stopSearch();
  const std::optional<double> start = position();
  if (!start) return end(false, "the focus axis does not answer: /focus/measured_js is silent, old or invalid");
  if (!tip_ || isOld(tip_arrival_))
    return end(false, "the tip is not seen: " + (tip_ ? "the image is old" : tip_reason_));
  // Without any manipulator nothing moves the needle.
  const bool known = needle_ && !isOld(needle_arrival_);
  if (subscribers_.back().getNumPublishers() > 0 && !known)
    return end(false, "/needle/measured_cp is silent or invalid: it is not known whether the needle rests");
  start_ = *start;
  repeated_ = false;
  planes_ = 0;
  needle_at_start_ = needle_;
  begin(*start, *tip_);
  images_ = transport_.subscribe(kImageTopic, kQueue, [this](const sensor_msgs::ImageConstPtr& message) {
    runGuarded(kImageTopic, [&] { onImage(*message); });
  });
}

void FocusNode::begin(double start, const Tip& tip) {
  window_ = tip.window;
  reading_.reset();
  verified_since_.reset();
  rough_.reset();
  search_ = std::make_unique<FocusSearch>(parameters_.search, start, start_);
}

void FocusNode::move(double position) {
  sensor_msgs::JointState message;
  message.header.stamp = ros::Time::now();
  message.name = {"focus"};
  message.position = {position};
  command_.publish(message);
}

void FocusNode::step() {
  diagnostics_.update();
  endIfOrphaned(master_);
  if (!search_) return;
  if (needle_at_start_ && (!needle_ || isOld(needle_arrival_)))
    return end(false, "the needle's position is not known any more");
  if (needle_ && needle_at_start_ && (*needle_ - *needle_at_start_).norm() > parameters_.largest_motion)
    return end(false, "the needle moves: it must rest during the search");
  const double now = ros::Time::now().toSec();
  if (rough_) return verify(now);
  const auto goal = search_->step({now, position(), isOld(reading_arrival_) ? std::nullopt : reading_, blind_});
  if (goal) move(*goal);
  if (!search_->failure().empty()) {
    rough_ = repeated_ ? std::nullopt : search_->sharpest();
    if (!rough_) return end(false, search_->failure());
    move(*rough_);
    verified_since_ = now;
    return;
  }
  cell_microinjection::FindFocusFeedback feedback;
  feedback.plane = static_cast<int>(planes_ + search_->plane());
  feedback.planes = static_cast<int>(planes_ + search_->planes());
  feedback.height = position().value_or(std::nan(""));
  action_.publishFeedback(feedback);
  if (search_->done()) verify(now);
}

void FocusNode::verify(double now) {
  if (!verified_since_) verified_since_ = now;
  const bool seen = tip_ && tip_->stamp > *verified_since_ + parameters_.search.settle_time && tip_->stamp <= now;
  if (!seen || !tip_->found) {
    if (now - *verified_since_ > parameters_.search.image_time)
      end(false,
          "the tip is not found in the best plane: " + (tip_reason_.empty() ? "the images are stale" : tip_reason_));
    return;
  }
  const double beside = cv::norm(tip_->window.tip - window_.tip);
  if (beside <= kFarWindow && !rough_) return end(true, search_->report().text);
  if (repeated_) {
    std::ostringstream text;
    text << "the tip is seen at another place in each plane: " << beside << " px beside";
    return end(false, text.str());
  }
  repeated_ = true;
  planes_ += search_->plane();
  begin(rough_.value_or(search_->report().height), *tip_);
}

void FocusNode::stopSearch() {
  search_.reset();
  images_.shutdown();
}

// By value: the search that has the text ends here.
void FocusNode::end(bool success, std::string message) {  // NOLINT(performance-unnecessary-value-param)
  outcome_ = message;
  cell_microinjection::FindFocusResult result;
  result.success = static_cast<unsigned char>(success);
  result.message = message;
  result.height = result.interval = result.tip_height = std::nan("");
  if (search_) result.planes = static_cast<int>(planes_ + search_->plane());
  if (success) {
    result.height = search_->report().height;
    result.interval = search_->report().interval.half();
    result.tip_height = result.height - start_;
  } else if (search_) {
    // A cancelled search stops where it is; after another failure the focus is where the user had it.
    move(action_.isPreemptRequested() ? position().value_or(start_) : start_);
  }
  stopSearch();
  if (success) {
    action_.setSucceeded(result, message);
  } else if (action_.isPreemptRequested()) {
    action_.setPreempted(result, message);
  } else {
    action_.setAborted(result, message);
  }
}

void FocusNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, search_ ? "searches the focus" : "waits for a goal");
  if (search_ && !blind_.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, blind_);
  if (search_ && !position())
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR, "/focus/measured_js is silent");
  MessageRefusals::ofProcess().report(status);
  status.add("last goal", outcome_);
  status.add("planes", search_ ? planes_ + search_->plane() : planes_);
}

}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::FocusNode>(argc, argv, "focus", microinjection::Priority::kOrdinary);
}
