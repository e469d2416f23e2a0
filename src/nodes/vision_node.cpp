#include "nodes/vision_node.h"

#include <cv_bridge/cv_bridge.h>

#include <algorithm>
#include <filesystem>
#include <opencv2/core/utility.hpp>

#include "base/atomic_file.h"
#include "base/cpu_time.h"
#include "base/errors.h"
#include "cell/family/family_cell.h"
#include "cell/model/scene.h"
#include "nodes/imaging/image_input.h"
#include "nodes/imaging/vision_messages.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"
#include "vision/calibration/calibration_file.h"
#include "vision/measurement/measured_scene.h"

namespace microinjection {
namespace {

constexpr double kVisionReportPeriod = 0.2;  // s
constexpr int kVisionQueue = 1;              // an image that waited is of no use

void fill(const std::optional<MeasuredLength>& length, double& value, double& interval) {
  value = length ? length->value : kNotMeasured;
  interval = length ? length->interval : kNotMeasured;
}

}  // namespace

const char* const VisionNode::kHelp =
    "vision: finds cell and pipettes in the microscope's images.\n"
    "In: microscope/image_raw.\n"
    "Out: vision/state vision/image_overlay /needle/interface, service vision/measure_cell.\n";

VisionNode::Parameters VisionNode::Parameters::read(const Bus& bus) {
  Parameters parameters;
  ConfigReader reader = parameterReader(bus);
  reader.path("scene", parameters.scene);
  reader.path("families", parameters.families);
  parameters.vision = VisionConfig::read(reader);
  acceptImageTransport(reader);
  reader.finish();
  return parameters;
}

VisionNode::VisionNode(Bus& bus)
    : bus_(bus),
      parameters_(Parameters::read(bus)),
      tracker_(parameters_.vision.tracker, parameters_.vision.secondEye()),
      served_(bus, parameters_.vision.serve_timeout),
      state_(bus.advertise<cell_microinjection::VisionState>("vision/state", 1)),
      interface_(bus.advertise<cell_microinjection::InterfacePosition>("/needle/interface", 1)),
      overlay_(bus.advertiseImages("vision/image_overlay", 1)),
      readings_(static_cast<std::size_t>(parameters_.vision.measured_images)),
      reported_(bus.steady()),
      diagnostics_(bus) {
  cv::setNumThreads(1);  // the other cores belong to the nodes at 1 kHz
  diagnostics_.add("images", this, &VisionNode::report);
  diagnostics_.add("served cell",
                   [this](diagnostic_updater::DiagnosticStatusWrapper& status) { served_.report(status); });
  images_ =
      subscribeImages(bus, kImageTopic, kVisionQueue, [this](const sensor_msgs::Image& message) { onImage(message); });
  timer_ = bus.timer(kVisionReportPeriod, [this] {
    readPixelSize();
    diagnostics_.update();
  });
  using cell_microinjection::MeasureCell;
  measure_ = bus.advertiseService<MeasureCell>(
      "vision/measure_cell",
      [this](MeasureCell::Request& request, MeasureCell::Response& response) {
        measureCell(request, response);
        return true;
      },
      Serving::kOwnThread);
}

std::string VisionNode::refusalOf(const sensor_msgs::Image& message, const ros::Time& now) {
  const ros::Time& stamp = message.header.stamp;
  if (const std::string defect = imageDefect(message); !defect.empty()) return defect;
  if (isAhead(stamp, now)) return "its stamp is ahead of now";
  if (!stamp_.isZero() && stamp == stamp_) return "its stamp is that of the last one: the driver must stamp each image";
  const double age = secondsBetween(stamp, now);
  if (age > parameters_.vision.image_timeout) return "it is " + std::to_string(age) + " s old";
  if (data_.step(message.data, 1)) return "the camera repeats its last image";
  // A clock that was set back by more than an image's age begins a new series.
  if (!stamp_.isZero() && stamp <= stamp_ && secondsBetween(stamp, stamp_) <= parameters_.vision.image_timeout)
    return "it is not newer than the last one";
  return "";
}

void VisionNode::onImage(const sensor_msgs::Image& message) {
  const auto refuse = [this](const std::string& reason) {
    const std::lock_guard<std::mutex> lock(mutex_);
    refusal_ = reason;
  };
  const std::string refusal = refusalOf(message, bus_.now());
  refuse(refusal);
  if (!refusal.empty()) {
    bus_.refusals().add(kImageTopic, refusal);
    return;
  }
  refuse("its format or length is wrong");  // until it was read: cv_bridge throws
  const double start = processingTime();
  const Frame frame(pixelsOf(message));
  refuse("");
  tracker_.next(frame);
  stamp_ = message.header.stamp;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    image_size_ = {frame.width(), frame.height()};
    const ros::SteadyTime now = bus_.steady();
    // Behind a pause may be another cell, and a needle makes the cell that it presses wider.
    const bool paused = !received_.isZero() && secondsBetween(received_, now) > parameters_.vision.image_timeout;
    if (paused) readings_ = CellReadings(static_cast<std::size_t>(parameters_.vision.measured_images));
    // By the dimple, or by a tip within the outline where the needle hides the dimple.
    const Dimple& indentation = tracker_.view().indentation;
    const BorderDisplacement& beside = indentation.displacement;
    pressed_ = indentation.finding.isFound() || (beside.finding.hasValues() && beside.gap < 0);
    if (!pressed_) readings_.add(tracker_.view());
    received_ = now;
  }
  ++accepted_;
  const double time = processingTime() - start;
  longest_ = std::max(longest_, time);
  publish(message.header, frame, time);
}

double VisionNode::processingTime() const {
  return bus_.isVirtual() ? 1e-9 * static_cast<double>(bus_.steady().toNSec()) : threadCpuTime();
}

std::string VisionNode::refusal() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return refusal_;
}

Eigen::Vector2i VisionNode::imageSize() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return image_size_;
}

/// A calibration may come, or change, while images do.
void VisionNode::readPixelSize() {
  try {
    pixel_size_ = parameters_.vision.pixelSize(imageSize(), calibration_warning_);
  } catch (const std::exception& error) {
    pixel_size_ = 0;
    // Without a calibration nothing is wrong yet: measureCell() says what is missing.
    const bool is_calibrated = std::filesystem::exists(calibrationPath(parameters_.vision.calibration));
    calibration_warning_ = is_calibrated ? error.what() : "";
  }
}

void VisionNode::publish(const std_msgs::Header& header, const Frame& frame, double processing_time) {
  cell_microinjection::VisionState state = toMessage(tracker_.view());
  state.header = header;
  state.width = static_cast<std::uint32_t>(frame.width());
  state.height = static_cast<std::uint32_t>(frame.height());
  state.pixel_size = pixel_size_;
  state.processing_time = processing_time;
  state_.publish(state);
  const BoreBorder& column = tracker_.view().column;
  if (column.finding.isFound() && pixel_size_ > 0) {
    cell_microinjection::InterfacePosition interface;
    interface.header = header;
    interface.position = pixel_size_ * column.length;
    interface_.publish(interface);
  }
  if (!parameters_.vision.overlay || overlay_.subscribers() == 0) return;
  const cv::Mat overlay = drawOverlay(frame, tracker_.view().overlay());
  overlay_.publish(cv_bridge::CvImage(header, "bgr8", overlay).toImageMsg());
}

CellMeasurement VisionNode::measure() const {
  std::string warning;
  const double pixel_size = parameters_.vision.pixelSize(imageSize(), warning);
  const std::lock_guard<std::mutex> lock(mutex_);
  const double age = received_.isZero() ? -1 : secondsBetween(received_, bus_.steady());
  if (age < 0 || age > parameters_.vision.image_timeout)
    throw ConfigError("there is no new image" + (refusal_.empty() ? "" : ": " + refusal_));
  if (pressed_) throw ConfigError("the needle presses the cell, which is wider then: withdraw it");
  std::string reason;
  const auto cell = readings_.measure(VisionConfig::kLeastImages, pixel_size, reason);
  if (!cell) throw ConfigError(reason);
  return *cell;
}

std::string VisionNode::familyOf(const CellMeasurement& cell) const {
  if (parameters_.scene.empty()) return "not known: this node has no scene";
  const YAML::Node scene = loadYamlMap(parameters_.scene);
  if (cell.zona_thickness && layersOf(scene) != 2) return "in no family: the image shows a zona, the scene has none";
  if (hasUnseenZona(scene, cell)) return "in no family: the scene has a zona, the image shows none";
  return describeFamilyOf(parseScene(withMeasuredSize(scene, cell), parameters_.scene), parameters_.families);
}

std::string VisionNode::serve(const CellMeasurement& cell) {
  const bool known = !parameters_.scene.empty();
  if (known) requireSeenZona(loadYamlMap(parameters_.scene), cell);
  if (!cell.zona_thickness) return served_.change({"diameter"}, {cell.diameter.value});
  if (known && layersOf(loadYamlMap(parameters_.scene)) != 2)
    throw ConfigError("the image shows a zona, and the served cell has none: start with a scene of two layers");
  return served_.change({"diameter", "shell_thickness"}, {cell.diameter.value, cell.zona_thickness->value});
}

void VisionNode::measureCell(const cell_microinjection::MeasureCell::Request& request,
                             cell_microinjection::MeasureCell::Response& response) {
  try {
    fill(std::nullopt, response.zona_thickness, response.zona_thickness_interval);
    fill(std::nullopt, response.offset, response.offset_interval);
    const CellMeasurement cell = measure();
    response.images = static_cast<std::uint32_t>(cell.images);
    fill(cell.diameter, response.diameter, response.diameter_interval);
    fill(cell.zona_thickness, response.zona_thickness, response.zona_thickness_interval);
    fill(cell.offset, response.offset, response.offset_interval);
    response.message = cell.describe();
    response.family = familyOf(cell);
    if (!request.scene.empty()) {
      if (parameters_.scene.empty()) throw ConfigError("scene: this node has none to write another one from");
      requireWritableFolder(std::filesystem::absolute(request.scene).parent_path());
    }
    if (request.serve) response.message += "; served: " + serve(cell);
    if (!request.scene.empty()) {
      const YAML::Node scene = withMeasuredSize(loadYamlMap(parameters_.scene), cell);
      writeFileAtomically(request.scene, measuredSceneText(scene, cell.describe(), parameters_.scene));
    }
    response.success = 1;
  } catch (const std::exception& error) {
    response.success = 0;
    response.message += (response.message.empty() ? "" : "; ") + std::string(error.what());
  }
}

void VisionNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) {
  const ros::SteadyTime now = bus_.steady();
  const double age = received_.isZero() ? -1 : secondsBetween(received_, now);
  status.summary(diagnostic_msgs::DiagnosticStatus::OK, "images are fresh");
  if (age < 0 || age > parameters_.vision.image_timeout)
    status.mergeSummary(diagnostic_msgs::DiagnosticStatus::ERROR,
                        std::string(kImageTopic) + (!refusal().empty() ? ": no image is taken: " + refusal()
                                                    : age < 0          ? " is silent"
                                                                       : " is stale"));
  if (!calibration_warning_.empty()) status.mergeSummary(diagnostic_msgs::DiagnosticStatus::WARN, calibration_warning_);
  const SpecimenView& view = tracker_.view();
  const auto add = [&](const char* name, const Finding& finding) {
    status.add(name, std::string(nameOf(finding.verdict)) + (finding.reason.empty() ? "" : ": " + finding.reason));
  };
  add("cell", view.cell.finding);
  add("injection pipette", view.injection.finding);
  add("holding pipette", view.holding.finding);
  add("indentation", view.indentation.finding);
  add("in the needle", view.column.finding);
  add("tongue in the holding pipette", view.tongue.finding);
  add(view.hold.held ? "cell at the mouth" : "cell away from the mouth", view.hold.finding);
  bus_.refusals().report(status);
  status.add("rate (Hz)", accepted_ / std::max(1e-9, secondsBetween(reported_, now)));
  status.add("longest image (ms of processor time)", 1e3 * longest_);
  reported_ = now;
  accepted_ = 0;
  longest_ = 0;
}

}  // namespace microinjection
