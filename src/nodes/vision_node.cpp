#include "nodes/vision_node.h"

#include <cell_microinjection/SetCellParameters.h>
#include <cv_bridge/cv_bridge.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <opencv2/core/utility.hpp>
#include <sstream>

#include "base/atomic_file.h"
#include "base/cpu_time.h"
#include "base/errors.h"
#include "nodes/imaging/calibration_path.h"
#include "nodes/imaging/measured_scene.h"
#include "nodes/imaging/vision_messages.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"
#include "nodes/runtime/orphan.h"
#include "nodes/runtime/run_node.h"
#include "vision/calibration/calibration_file.h"

namespace microinjection {
namespace {

constexpr char kImageTopic[] = "microscope/image_raw";
constexpr char kCellService[] = "/cell_simulator/set_cell_parameters";
constexpr double kReportPeriod = 0.2;          // s of wall time
constexpr std::size_t kLeastImages = 3;        // of a measurement
constexpr std::uint32_t kLargestSide = 16384;  // px
constexpr int kQueue = 1;                      // an image that waited is of no use

/// The pixels of a message, which are not copied; empty: their format is not known.
cv::Mat pixelsOf(const sensor_msgs::Image& message) {
  const auto unowned = boost::shared_ptr<void const>();
  return cv_bridge::toCvShare(message, unowned)->image;
}

std::string micrometres(double value, double interval) {
  std::ostringstream text;
  text.precision(4);
  text << 1e6 * value << " +- ";
  text.precision(2);
  text << 1e6 * interval << " um";
  return text.str();
}

}  // namespace

const char* const VisionNode::kHelp =
    "vision: finds cell and pipettes in the microscope's images.\n"
    "In: microscope/image_raw.\n"
    "Out: vision/state vision/image_overlay, service vision/measure_cell.\n";

VisionNode::Parameters VisionNode::readParameters(const ros::NodeHandle& private_node) {
  Parameters parameters;
  ConfigReader reader = parameterReader(private_node);
  reader.text("scene", parameters.scene);
  reader.text("calibration", parameters.calibration);
  reader.number("pixel_size", parameters.pixel_size, Range::closed(0, 1e-4));
  reader.number("image_timeout", parameters.image_timeout, Range::positive());
  reader.boolean("overlay", parameters.overlay);
  reader.integer("measured_images", parameters.measured_images, Range::closed(static_cast<double>(kLeastImages), 1000));
  parameters.tracker = SpecimenTrackerConfig::read(reader);
  reader.finish();
  return parameters;
}

VisionNode::VisionNode(ros::NodeHandle node, ros::NodeHandle private_node)
    : parameters_(readParameters(private_node)),
      tracker_(parameters_.tracker),
      readings_(static_cast<std::size_t>(parameters_.measured_images)),
      transport_(node),
      state_(node.advertise<cell_microinjection::VisionState>("vision/state", 1)),
      overlay_(transport_.advertise("vision/image_overlay", 1)),
      measure_(node.advertiseService("vision/measure_cell", &VisionNode::measureCell, this)),
      cell_(node.serviceClient<cell_microinjection::SetCellParameters>(kCellService)),
      reported_(ros::SteadyTime::now()),
      diagnostics_(node, private_node) {
  cv::setNumThreads(1);  // the other cores belong to the nodes at 1 kHz
  diagnostics_.setHardwareID("none");
  diagnostics_.add("images", this, &VisionNode::report);
  images_ = transport_.subscribe(kImageTopic, kQueue, [this](const sensor_msgs::ImageConstPtr& message) {
    runGuarded(kImageTopic, [&] { onImage(*message); });
  });
  timer_ = node.createSteadyTimer(ros::WallDuration(kReportPeriod), [this](const ros::SteadyTimerEvent&) {
    diagnostics_.update();
    endIfOrphaned(master_);
  });
}

void VisionNode::run() { ros::spin(); }

std::string VisionNode::refusalOf(const sensor_msgs::Image& message, const ros::Time& now) const {
  const ros::Time& stamp = message.header.stamp;
  // cv_bridge compares the length in 32 bits, and would read beyond a short one.
  if (message.width > kLargestSide || message.height > kLargestSide ||
      std::uint64_t{message.height} * message.step != message.data.size())
    return "its size or length is wrong";
  if (isAhead(stamp, now)) return "its stamp is ahead of now";
  const double age = secondsBetween(stamp, now);
  if (age > parameters_.image_timeout) return "it is " + std::to_string(age) + " s old";
  // A clock that was set back by more than an image's age begins a new series.
  if (!stamp_.isZero() && stamp <= stamp_ && secondsBetween(stamp, stamp_) <= parameters_.image_timeout)
    return "it is not newer than the last one";
  return "";
}

void VisionNode::onImage(const sensor_msgs::Image& message) {
  refusal_ = refusalOf(message, ros::Time::now());
  if (!refusal_.empty()) {
    MessageRefusals::ofProcess().add(kImageTopic, refusal_);
    return;
  }
  refusal_ = "its format or length is wrong";  // until it was read: cv_bridge throws
  const double start = threadCpuTime();
  const Frame frame(pixelsOf(message));
  refusal_.clear();
  tracker_.next(frame);
  readings_.add(tracker_.view().cell);
  stamp_ = message.header.stamp;
  received_ = ros::SteadyTime::now();
  ++accepted_;
  const double time = threadCpuTime() - start;
  longest_ = std::max(longest_, time);
  publish(message.header, frame, time);
}

void VisionNode::publish(const std_msgs::Header& header, const Frame& frame, double processing_time) {
  cell_microinjection::VisionState state = toMessage(tracker_.view());
  state.header = header;
  state.width = static_cast<std::uint32_t>(frame.width());
  state.height = static_cast<std::uint32_t>(frame.height());
  state.processing_time = processing_time;
  state_.publish(state);
  if (!parameters_.overlay || overlay_.getNumSubscribers() == 0) return;
  const cv::Mat overlay = drawOverlay(frame, tracker_.view().overlay());
  overlay_.publish(cv_bridge::CvImage(header, "bgr8", overlay).toImageMsg());
}

double VisionNode::pixelSize() const {
  if (parameters_.pixel_size > 0) return parameters_.pixel_size;
  const std::string path = calibrationPath(parameters_.calibration);
  if (!std::filesystem::exists(path))
    throw ConfigError("pixel_size = 0: unknown, and there is no calibration " + path +
                      ": calibrate, or set pixel_size");
  return readCalibration(path).value[kPixelSize];
}

void VisionNode::fillSizes(cell_microinjection::MeasureCell::Response& response) const {
  const double scale = pixelSize();
  const double age = received_.isZero() ? -1 : secondsBetween(received_, ros::SteadyTime::now());
  if (age < 0 || age > parameters_.image_timeout)
    throw ConfigError("there is no new image" + (refusal_.empty() ? "" : ": " + refusal_));
  std::string reason;
  const std::optional<CellSizeInImages> size = readings_.measure(kLeastImages, reason);
  if (!size) throw ConfigError(reason);
  response.images = static_cast<std::uint32_t>(size->images);
  response.diameter = scale * size->diameter.value;
  response.diameter_interval = scale * size->diameter.interval;
  response.zona_thickness = response.zona_thickness_interval = std::numeric_limits<double>::quiet_NaN();
  response.message = "diameter " + micrometres(response.diameter, response.diameter_interval);
  if (!size->zona_thickness) {
    response.message += ", no zona";
    return;
  }
  response.zona_thickness = scale * size->zona_thickness->value;
  response.zona_thickness_interval = scale * size->zona_thickness->interval;
  response.message += ", zona " + micrometres(response.zona_thickness, response.zona_thickness_interval);
}

void VisionNode::writeScene(const std::string& path, const cell_microinjection::MeasureCell::Response& size) const {
  if (parameters_.scene.empty()) throw ConfigError("scene: this node has none to write another one from");
  YAML::Emitter text;
  text << withMeasuredSize(loadYamlMap(parameters_.scene), size.diameter, size.zona_thickness);
  writeFileAtomically(path, std::string("# Measured by the vision node: ") + size.message + ". From " +
                                parameters_.scene + "\n" + text.c_str() + "\n");
}

std::string VisionNode::serve(const cell_microinjection::MeasureCell::Response& size) {
  cell_microinjection::SetCellParameters change;
  change.request.name = {"diameter"};
  change.request.value = {size.diameter};
  if (std::isfinite(size.zona_thickness)) {
    if (!parameters_.scene.empty() && layersOf(loadYamlMap(parameters_.scene)) != 2)
      throw ConfigError("the image shows a zona, and the served cell has none: start with a scene of two layers");
    change.request.name.push_back("shell_thickness");
    change.request.value.push_back(size.zona_thickness);
  }
  if (!cell_.call(change)) throw ConfigError("cell_simulator does not answer");
  if (!change.response.success) throw ConfigError(change.response.message);
  return change.response.message;
}

bool VisionNode::measureCell(cell_microinjection::MeasureCell::Request& request,
                             cell_microinjection::MeasureCell::Response& response) {
  try {
    fillSizes(response);
    if (!request.scene.empty()) requireWritableFolder(std::filesystem::absolute(request.scene).parent_path());
    if (request.serve) response.message += "; served: " + serve(response);
    if (!request.scene.empty()) writeScene(request.scene, response);
    response.success = 1;
  } catch (const std::exception& error) {
    response.success = 0;
    response.message += (response.message.empty() ? "" : "; ") + std::string(error.what());
  }
  return true;
}

void VisionNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  const double age = received_.isZero() ? -1 : secondsBetween(received_, now);
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "images are fresh");
  if (age < 0 || age > parameters_.image_timeout)
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR,
                        std::string(kImageTopic) + (age < 0 ? " is silent" : " is stale"));
  const SpecimenView& view = tracker_.view();
  const auto add = [&](const char* name, const Finding& finding) {
    status.add(name, std::string(nameOf(finding.verdict)) + (finding.reason.empty() ? "" : ": " + finding.reason));
  };
  add("cell", view.cell.finding);
  add("injection pipette", view.injection.finding);
  add("holding pipette", view.holding.finding);
  add("indentation", view.indentation.finding);
  MessageRefusals::ofProcess().report(status);
  status.add("rate (Hz)", accepted_ / std::max(1e-9, secondsBetween(reported_, now)));
  status.add("longest image (ms of processor time)", 1e3 * longest_);
  reported_ = now;
  accepted_ = 0;
  longest_ = 0;
}

}  // namespace microinjection

int main(int argc, char** argv) {
  return microinjection::runNode<microinjection::VisionNode>(argc, argv, "vision", microinjection::Priority::kOrdinary);
}
