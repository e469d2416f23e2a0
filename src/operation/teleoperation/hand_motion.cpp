#include "operation/teleoperation/hand_motion.h"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/errors.h"
#include "base/separated.h"
#include "operation/teleoperation/generated_motion.h"

namespace microinjection {
namespace {

constexpr char kHeader[] = "time_s,x_m,y_m,z_m,clutch,phase";

double toNumber(const std::string& text, const std::string& where) {
  std::size_t used = 0;
  double value = 0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    used = 0;
  }
  if (used == 0 || used != text.size() || !(std::abs(value) < 1e9)) {
    throw ConfigError(where + ": \"" + text + "\" must be a finite number");
  }
  return value;
}

HandMotion::Sample toSample(const std::string& line, const std::string& where) {
  const std::vector<std::string> cells = separated(line);
  if (cells.size() != 6) throw ConfigError(where + ": must have six cells: " + kHeader);
  if (cells[4] != "0" && cells[4] != "1") throw ConfigError(where + ": clutch = " + cells[4] + ", must be 0 or 1");
  HandMotion::Sample sample;
  sample.time = toNumber(cells[0], where);
  for (int i = 0; i < 3; ++i) sample.position[i] = toNumber(cells[1 + i], where);
  sample.clutch = cells[4] == "1";
  sample.phase = cells[5];
  return sample;
}

}  // namespace

HandMotion HandMotion::load(const std::string& path) {
  const std::string ending = path.substr(std::min(path.find_last_of('.'), path.size()));
  if (ending == ".yaml" || ending == ".yml") {
    return HandMotion(generateMotion(ConfigReader(loadYamlMap(path), path)));
  }
  std::ifstream file(path);
  if (!file) throw ConfigError(path + ": cannot be read");
  std::vector<Sample> samples;
  bool header = false;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (line.empty() || line[0] == '#') continue;
    const std::string where = path + ":" + std::to_string(number);
    if (!header && line != kHeader) throw ConfigError(where + ": header must be " + kHeader);
    if (header) samples.push_back(toSample(line, where));
    header = true;
  }
  try {
    return HandMotion(std::move(samples));
  } catch (const ConfigError& error) {
    throw ConfigError(path + ": " + error.what());
  }
}

HandMotion::HandMotion(std::vector<Sample> samples) : samples_(std::move(samples)) {
  if (samples_.size() < 2) throw ConfigError("hand motion must have at least two samples");
  for (std::size_t i = 1; i < samples_.size(); ++i) {
    if (samples_[i].time <= samples_[i - 1].time) {
      throw ConfigError("hand motion: time_s = " + std::to_string(samples_[i].time) + " must be later than " +
                        std::to_string(samples_[i - 1].time) + " before it");
    }
  }
}

HandMotion::Sample HandMotion::at(double time) const {
  const auto after = std::upper_bound(samples_.begin(), samples_.end(), time,
                                      [](double t, const Sample& sample) { return t < sample.time; });
  if (after == samples_.begin()) return samples_.front();
  if (after == samples_.end()) return samples_.back();
  const Sample& before = *(after - 1);
  Sample result = before;
  const double share = (time - before.time) / (after->time - before.time);
  result.time = time;
  result.position = before.position + share * (after->position - before.position);
  return result;
}

}  // namespace microinjection
