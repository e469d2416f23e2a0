#include "rigs/mp285/mp285_config.h"

namespace microinjection {

Mp285Config Mp285Config::read(ConfigReader& reader) {
  Mp285Config config;
  ConfigReader port = reader.section("port", ConfigReader::kRequired);
  config.port = SerialPortConfig::read(port, 9600);
  Eigen::Vector3d axes(1, 2, 3);
  reader.vector("axes", axes, Range::closed(1, 3));
  for (int i = 0; i < 3; ++i) {
    config.axes[i] = static_cast<int>(axes[i]) - 1;
    if (axes[i] != config.axes[i] + 1) reader.error("axes", "must be whole numbers");
    for (int j = 0; j < i; ++j) {
      if (config.axes[i] == config.axes[j]) reader.error("axes", "two joints have the same axis");
    }
  }
  config.joints = JointAxes::read(reader);
  reader.number("speed", config.speed, {1e-6, 6.55e-3});
  reader.number("segment_time", config.segment_time, {0.01, 1});
  reader.number("answer_time", config.answer_time, Range::nonNegative());
  reader.number("reply_timeout", config.reply_timeout, Range::positive());
  reader.number("half_command_time", config.half_command_time, Range::positive());
  reader.number("rest_reading_interval", config.rest_reading_interval, Range::nonNegative());
  return config;
}

}  // namespace microinjection
