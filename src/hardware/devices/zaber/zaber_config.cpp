#include "hardware/devices/zaber/zaber_config.h"

namespace microinjection {

double ZaberConfig::exchangeTime(double reply) const {
  return (kZaberCommandBytes + kZaberReplyBytes) * byteTime() + reply;
}

ZaberConfig ZaberConfig::read(ConfigReader& reader) {
  ZaberConfig config;
  ConfigReader port = reader.section("port", ConfigReader::kRequired);
  config.port = SerialPortConfig::read(port, 115200);
  Eigen::Vector3d devices(1, 1, 1), axes(1, 2, 3);
  reader.vector("devices", devices, Range::closed(1, 99));
  reader.vector("axes", axes, Range::closed(1, 9));
  for (int i = 0; i < 3; ++i) {
    config.addresses[i] = {static_cast<int>(devices[i]), static_cast<int>(axes[i])};
    if (config.addresses[i].device != devices[i]) reader.error("devices", "must be whole numbers");
    if (config.addresses[i].axis != axes[i]) reader.error("axes", "must be whole numbers");
    for (int j = 0; j < i; ++j) {
      if (config.addresses[i] == config.addresses[j]) reader.error("axes", "two joints have the same device and axis");
    }
  }
  config.joints = JointAxes::read(reader);
  reader.vector("microsteps_per_metre", config.microsteps_per_metre, Range::positive(), ConfigReader::kRequired);
  reader.number("speed", config.speed, Range::positive());
  reader.number("acceleration", config.acceleration, Range::positive());
  reader.integer("resolution", config.resolution, Range::closed(0, 256));
  reader.number("gain", config.gain, Range::nonNegative());
  reader.number("move_horizon", config.move_horizon, Range::positive());
  reader.boolean("checksum", config.checksum);
  reader.boolean("reply_checksum", config.reply_checksum);
  reader.boolean("numbers", config.numbers);
  reader.boolean("home", config.home);
  reader.number("answer_time", config.answer_time, Range::nonNegative());
  reader.number("reply_timeout", config.reply_timeout, Range::positive());
  reader.number("reading_margin", config.reading_margin, Range::positive());
  const double turn = kZaberTurn * config.exchangeTime(config.answer_time);
  const double least = config.leastHorizon(turn, config.acceleration);
  if (config.move_horizon <= least) {
    reader.error("move_horizon", "must be > " + std::to_string(least) +
                                     " s: two turns of the line at its baud rate and answer_time, and the braking");
  }
  return config;
}

}  // namespace microinjection
