#include "vision/camera/frame_source_config.h"

#include "base/config_errors.h"
#include "vision/camera/folder_source.h"
#include "vision/camera/video_source.h"

namespace microinjection {
namespace {

const std::vector<std::string> kSources = {"device", "folder", "video"};
const Range kAskedRate = Range::closed(0, 1e5);  // 1/s

}  // namespace

FrameSourceConfig FrameSourceConfig::read(ConfigReader& reader) {
  FrameSourceConfig config;
  reader.choice("source", config.source, kSources, ConfigReader::kRequired);
  if (config.source == "device") {
    ConfigReader device = reader.section("device");
    config.device = DeviceSourceConfig::read(device);
    return config;
  }
  reader.path("path", config.path, ConfigReader::kRequired);
  reader.number("rate", config.rate, kAskedRate);
  reader.boolean("loop", config.loop);
  if (config.source == "folder" && config.rate == 0) reader.error("rate", "must be above 0 for a folder");
  return config;
}

void FrameSourceConfig::validate() const {
  ConfigErrors errors("camera");
  errors.requireOneOf(kSources, "source", source);
  errors.require(kAskedRate, "rate", rate, " 1/s");
  errors.require(source != "folder" || rate > 0, "rate", rate, " 1/s", "above 0 for a folder");
  errors.require(source == "device" || !path.empty(), "path", path, "", "set");
  errors.throwAny();
  if (source == "device") device.validate();
}

std::unique_ptr<FrameSource> makeFrameSource(const FrameSourceConfig& config) {
  config.validate();
  if (config.source == "folder") return std::make_unique<FolderSource>(config.path, config.rate, config.loop);
  if (config.source == "video") return std::make_unique<VideoSource>(config.path, config.rate, config.loop);
  return std::make_unique<DeviceSource>(config.device);
}

}  // namespace microinjection
