#include "rig/devices/mp285/mp285_config.h"

namespace microinjection {

Mp285Config Mp285Config::read(ConfigReader& reader) {
  Mp285Config config;
  ConfigReader port = reader.section("port", ConfigReader::kRequired);
  config.port = SerialPortConfig::read(port, 9600);
  config.axes = AxisOrder::read(reader);
  config.joints = JointAxes::read(reader);
  reader.vector("microsteps", config.microsteps, Range::closed(0, 1e-6));
  if (((config.microsteps.array() > 0) && (config.microsteps.array() < 1e-9)).any()) {
    reader.error("microsteps", "each must be 0 (by the device's status) or from 1e-9 to 1e-6 m");
  }
  reader.number("speed", config.speed, {1e-6, 6.55e-3});
  reader.number("segment_time", config.segment_time, {0.01, 1});
  reader.number("answer_time", config.answer_time, Range::nonNegative());
  reader.number("command_pause", config.command_pause, Range::nonNegative());
  reader.number("reply_timeout", config.reply_timeout, Range::positive());
  reader.number("half_command_time", config.half_command_time, Range::positive());
  reader.number("rest_reading_interval", config.rest_reading_interval, Range::nonNegative());
  return config;
}

}  // namespace microinjection
