#include "vision/camera/device_source.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>

#include "base/config_errors.h"

namespace microinjection {
namespace {

constexpr double kAutomaticOff = 1;         // of V4L2's exposure_auto: manual
constexpr double kSettingTolerance = 0.01;  // of the value: devices round to their own steps

constexpr long kReadBackPeriod = 100;  // frames

constexpr char kInPipeline[] = "is a pipeline: its size, format, rate, exposure and gain belong in its text";

const std::vector<std::string> kDeepFormats = {"Y16 ", "Y12 ", "Y10 "};

const Range kAskedSide = Range::closed(0, 16384);  // px

bool isIndex(const std::string& device) {
  return !device.empty() && device.size() < 4 &&
         std::all_of(device.begin(), device.end(), [](unsigned char c) { return std::isdigit(c); });
}

bool isPipeline(const std::string& device) { return device.find('!') != std::string::npos; }

/// V4L2 pads a format's name with blanks.
int fourccOf(std::string format) {
  format.resize(4, ' ');
  return cv::VideoWriter::fourcc(format[0], format[1], format[2], format[3]);
}

std::string formatOf(int fourcc) {
  std::string format;
  for (int shift = 0; shift < 32; shift += 8) {
    const char c = static_cast<char>((fourcc >> shift) & 0xFF);
    format += std::isprint(static_cast<unsigned char>(c)) ? c : '?';
  }
  return format;
}

std::unique_ptr<cv::VideoCapture> openDevice(const DeviceSourceConfig& config) {
  config.validate();
  const std::string& device = config.device;
  auto capture = std::make_unique<cv::VideoCapture>();
  if (isPipeline(device)) {
    capture->open(device, cv::CAP_GSTREAMER);
  } else if (isIndex(device)) {
    capture->open(std::stoi(device));
  } else if (!capture->open(device, cv::CAP_V4L2)) {
    capture->open(device);
  }
  if (!capture->isOpened()) throw ConfigError("device = " + device + ": cannot be opened");
  return capture;
}

}  // namespace

DeviceSourceConfig DeviceSourceConfig::read(ConfigReader& reader) {
  DeviceSourceConfig config;
  reader.text("device", config.device);
  reader.integer("width", config.width, kAskedSide);
  reader.integer("height", config.height, kAskedSide);
  reader.text("format", config.format);
  reader.number("rate", config.rate, Range::nonNegative());
  for (auto [key, value] : {std::pair("exposure", &config.exposure), std::pair("gain", &config.gain)}) {
    if (!reader.has(key)) continue;
    double number = 0;
    reader.number(key, number, Range::nonNegative());
    *value = number;
  }
  if (config.format.size() > 4) reader.error("format", "must have at most 4 characters");
  if ((config.width == 0) != (config.height == 0)) reader.error("width", "must be set together with height");
  if (isPipeline(config.device) && config.changesSettings()) reader.error("device", kInPipeline);
  return config;
}

void DeviceSourceConfig::validate() const {
  ConfigErrors errors("camera device");
  errors.require(!device.empty(), "device", device, "", "an index, a path or a pipeline");
  errors.require(kAskedSide, "width", width, " px");
  errors.require(kAskedSide, "height", height, " px");
  errors.require((width == 0) == (height == 0), "width", width, " px", "set together with height");
  errors.require(format.size() <= 4, "format", format, "", "of at most 4 characters");
  errors.require(Range::nonNegative(), "rate", rate, " 1/s");
  if (exposure) errors.require(Range::nonNegative(), "exposure", *exposure);
  if (gain) errors.require(Range::nonNegative(), "gain", *gain);
  if (isPipeline(device) && changesSettings()) errors.add("device = " + device + ": " + kInPipeline);
  errors.throwAny();
}

bool DeviceSourceConfig::changesSettings() const {
  return width > 0 || height > 0 || !format.empty() || rate > 0 || exposure || gain;
}

DeviceSource::DeviceSource(const DeviceSourceConfig& config) : DeviceSource(config, openDevice(config)) {}

DeviceSource::DeviceSource(const DeviceSourceConfig& config, std::unique_ptr<cv::VideoCapture> capture)
    : config_(config), capture_(std::move(capture)) {
  config_.validate();
  configure();
}

void DeviceSource::configure() {
  // The format comes first, because it decides which sizes and rates the device has.
  if (!config_.format.empty()) {
    const int wanted = fourccOf(config_.format);
    capture_->set(cv::CAP_PROP_FOURCC, wanted);
    const int found = static_cast<int>(capture_->get(cv::CAP_PROP_FOURCC));
    if (found != wanted) report("format = " + config_.format + ": the device has " + formatOf(found));
  }
  // OpenCV makes 8 bit of every format unless it is told not to.
  const std::string format = formatOf(static_cast<int>(capture_->get(cv::CAP_PROP_FOURCC)));
  is_deep_ = std::find(kDeepFormats.begin(), kDeepFormats.end(), format) != kDeepFormats.end();
  if (is_deep_) capture_->set(cv::CAP_PROP_CONVERT_RGB, 0);
  if (config_.width > 0) {
    set(cv::CAP_PROP_FRAME_WIDTH, "width", config_.width, " px");
    set(cv::CAP_PROP_FRAME_HEIGHT, "height", config_.height, " px");
  }
  if (config_.rate > 0) set(cv::CAP_PROP_FPS, "rate", config_.rate, " 1/s");
  if (config_.exposure) {
    set(cv::CAP_PROP_AUTO_EXPOSURE, "automatic exposure", kAutomaticOff, "");
    set(cv::CAP_PROP_EXPOSURE, "exposure", *config_.exposure, "");
  }
  if (config_.gain) set(cv::CAP_PROP_GAIN, "gain", *config_.gain, "");
  readBack();
}

void DeviceSource::set(int property, const std::string& key, double value, const std::string& unit) {
  capture_->set(property, value);
  asked_.push_back({property, key, unit, value, value});
}

/// Reports each setting once for each value that it has in the place of what was asked.
void DeviceSource::readBack() {
  std::ostringstream has;
  if (!size_.empty()) has << size_.width << " x " << size_.height << " px";
  for (Setting& setting : asked_) {
    const double found = capture_->get(setting.property);
    has << (has.tellp() > 0 ? ", " : "") << setting.key << ' ' << found << setting.unit;
    const bool same = std::abs(found - setting.asked) <= kSettingTolerance * std::abs(setting.asked);
    if (!same && found != setting.has) {
      std::ostringstream text;
      text << setting.key << " = " << setting.asked << setting.unit << ": the device has " << found << setting.unit;
      report(text.str());
    }
    setting.has = found;
  }
  settings_ = has.str();
}

void DeviceSource::checkSize(const cv::Size& size) {
  const bool is_new = size != size_;
  size_ = size;
  if (!is_new || config_.width == 0 || size == cv::Size(config_.width, config_.height)) return;
  report("width, height = " + std::to_string(config_.width) + ", " + std::to_string(config_.height) +
         " px: the frames have " + std::to_string(size.width) + " x " + std::to_string(size.height) + " px");
}

std::optional<CameraFrame> DeviceSource::next() {
  cv::Mat image;
  try {
    if (!capture_->read(image) || image.empty()) {
      report("device = " + config_.device + ": delivers no frame");
      return std::nullopt;
    }
  } catch (const cv::Exception& error) {
    report("device = " + config_.device + ": " + error.err);
    return std::nullopt;
  }
  if (is_deep_ && image.depth() == CV_8U) {
    report("format: the device has 16 bit, of which OpenCV leaves 8");
    is_deep_ = false;  // one report is enough
  }
  checkSize(image.size());
  if (count_ % kReadBackPeriod == 0) readBack();
  const double milliseconds = capture_->get(cv::CAP_PROP_POS_MSEC);
  std::optional<double> stamp;
  if (std::isfinite(milliseconds) && milliseconds > 0) stamp = milliseconds * 1e-3;
  // The driver may reuse its buffer for the next frame.
  return CameraFrame{image.clone(), stamp, std::to_string(count_++)};
}

}  // namespace microinjection
